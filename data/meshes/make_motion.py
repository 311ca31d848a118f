#!/usr/bin/env python3
"""Makes the motion of the scenes dressed-turn.toml and dressed-sits.toml: the body of body.obj stands, takes two steps while it turns, stands
again, takes its arms down to its sides and up again, and sits down.

    python3 make_motion.py [BODY.obj] [OUT.pc2]      default: body.obj, ../motions/man.pc2

30 frames a second, 7.6 s, as a point cache (POINTCACHE2, float32, little endian) of 37 MB. The bones are those of a puppet: legs
that swing about the hips and bend at the knees, arms that swing a little against them, a pelvis that goes, turns and bobs. A bone
takes hold of a vertex by a weight that is harmonic on the mesh between where it is 0 and where it is 1.
Needs numpy and scipy (Debian: python3-scipy).
"""
import pathlib
import struct
import sys

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import spsolve

from make_meshes import read

here = pathlib.Path(__file__).resolve().parent
rate = 30.0                             # Hz
begin, end, duration = 0.7, 2.7, 7.6    # s: it stands before and after
down, up, sit = (3.6, 4.4), (4.8, 5.6), (5.8, 7.0)  # s, from and to
lowered, seated = np.radians([36, 80])  # of arms, and of hips and knees
swing, knee, arm = np.radians([18, 35, 10])
turn = np.radians(60)                   # in all, to its left
hip = np.array([0.095, 0.92, 0.03])     # m, of its left side, as the other joints
knee_joint = np.array([0.17, 0.51, 0.02])
shoulder = np.array([0.175, 1.42, 0.0])
leg = hip[1]                            # m, long
mirrored = np.array([-1.0, 1, 1])


def smooth(x):
    x = np.clip(x, 0, 1)
    return x * x * x * (10 - 15 * x + 6 * x * x)


def harmonic(faces, zero, one):
    """0 and 1 where these hold, elsewhere the mean of the neighbours; then smoothed at both ends."""
    n = len(zero)
    i = np.array([v for f in faces for v in f])
    j = np.array([v for f in faces for v in f[1:] + f[:1]])
    joined = coo_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(n, n)).tocsr()
    joined.data[:] = 1
    laplacian = csr_matrix(diags(np.asarray(joined.sum(1)).ravel()) - joined)
    free = ~(zero | one)
    weight = one.astype(float)
    weight[free] = spsolve(laplacian[free][:, free].tocsc(), -laplacian[free] @ weight)
    return weight * weight * (3 - 2 * weight)


def weights(points, faces):
    """Of the left side: leg, shin, arm."""
    x, y = points[:, 0], points[:, 1]
    torso = np.abs(x) < 0.14
    return (harmonic(faces, (y > 1.02) | ((x < -0.02) & (y < 0.9)), (y < 0.76) & (x > 0.02)),
            harmonic(faces, (y > 0.60) | (x < 0), (y < 0.44) & (x > 0)),
            harmonic(faces, torso | (x < 0) | ((y < 1.2) & (x < 0.26)), (x > 0.29) & (y > 0.3)))


def swung(points, joint, angle, weight):
    """Each point is turned by its share of the angle, so that nothing shrinks where the weight is between."""
    c, s = np.cos(weight * angle), np.sin(weight * angle)
    y, z = points[:, 1] - joint[1], points[:, 2] - joint[2]
    return np.c_[points[:, 0], joint[1] + c * y + s * z, joint[2] - s * y + c * z]


def taken_down(points, joint, angle, weight):
    """As swung, about z: a positive angle takes the arm at x > 0 down."""
    c, s = np.cos(weight * angle), np.sin(weight * angle)
    x, y = points[:, 0] - joint[0], points[:, 1] - joint[1]
    return np.c_[joint[0] + c * x + s * y, joint[1] - s * x + c * y, points[:, 2]]


def pose(rest, of_side, phase, strength, lowering, sitting):
    """About the pelvis; strength fades the gait in and out, lowering and sitting go from 0 to 1."""
    points = rest
    for side, (leg_weight, shin_weight, arm_weight) in zip((1, -1), of_side):
        at = 1.0 if side == 1 else mirrored
        forwards = side * strength * np.sin(phase)
        bent = strength * max(0.0, side * np.cos(phase)) ** 2  # the leg that comes forward
        points = swung(points, knee_joint * at, -knee * bent - seated * sitting, shin_weight)
        points = swung(points, hip * at, swing * forwards + 0.4 * knee * bent + seated * sitting, leg_weight)
        points = swung(points, shoulder * at, -arm * forwards, arm_weight)
        points = taken_down(points, shoulder * at, side * lowered * lowering, arm_weight)
    return points


def frames(rest, faces):
    left = weights(rest, faces)
    mirror = rest * mirrored
    right = weights(mirror, faces)  # by place: the mesh itself need not be symmetric
    fine = 20                       # times of the path for each frame
    count = int(round(duration * rate)) + 1
    t = np.arange((count - 1) * fine + 1) / (fine * rate)
    s = smooth((t - begin) / (end - begin))
    phase, strength = 2 * np.pi * s, smooth((t - begin) / 0.3) * smooth((end - t) / 0.3)
    angle = swing * strength * np.sin(phase)
    # The standing foot stays nearly where it is: the pelvis goes as fast as that foot goes backwards.
    speed = leg * np.sqrt(np.gradient(angle, t) ** 2 + 0.01) * smooth((t - begin) / 0.3) * smooth((end - t) / 0.3)
    heading = turn * s
    step = np.diff(t, prepend=0.0) * speed
    place = np.cumsum(np.c_[step * np.sin(heading), 0 * step, step * np.cos(heading)], 0)
    lowering = smooth((t - down[0]) / (down[1] - down[0])) - smooth((t - up[0]) / (up[1] - up[0]))
    sitting = smooth((t - sit[0]) / (sit[1] - sit[0]))
    poses = [pose(rest, (left, right), phase[k], strength[k], lowering[k], sitting[k]) for k in range(0, len(t), fine)]
    feet = rest[:, 1] < 0.1
    for k, points in zip(range(0, len(t), fine), poses):  # both feet stay where they are while it sits down
        if sitting[k] > 0:
            back = rest[feet].mean(0)[2] - points[feet].mean(0)[2]
            place[k] += back * np.array([np.sin(heading[k]), 0, np.cos(heading[k])])
    # The lower foot is on the ground, nearly: the bob is smoothed.
    lowest = np.convolve(np.pad([p[:, 1].min() for p in poses], 2, "edge"), np.array([1, 2, 3, 2, 1]) / 9, "valid")
    place[::fine, 1] = lowest[0] - lowest
    for k, points in zip(range(0, len(t), fine), poses):
        cosine, sine = np.cos(heading[k]), np.sin(heading[k])
        about_y = np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])
        yield points @ about_y.T + place[k]


def main():
    body = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here / "body.obj"
    out = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else here.parent / "motions" / "man.pc2"
    rest, faces = read(body)
    all_frames = list(frames(rest, faces))
    out.parent.mkdir(parents=True, exist_ok=True)
    beside = out.with_name(out.name + ".part")
    with beside.open("wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(rest), 0.0, 1.0, len(all_frames)))
        for points in all_frames:
            file.write(points.astype("<f4").tobytes())
    beside.replace(out)
    print(f"{out}: {len(all_frames)} frames of {len(rest)} vertices, {rate:g} Hz")


if __name__ == "__main__":
    main()
