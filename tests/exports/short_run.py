#!/usr/bin/env python3
"""A short run of the real program and all its exports, for the checks in this folder; and what its files hold, read by numpy.

    python3 short_run.py DRAPE FOLDER      makes FOLDER/run, FOLDER/mdd, FOLDER/obj, ... and FOLDER/expected.json

Two cloths of quads fall: one has a vertex column with two uv each and a name with blanks, quotes and signs of XML. Under them are a
ball that moves and turns, a box that stands, and a mesh that deforms.
"""
import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys

try:
    import numpy as np
except ImportError:
    print("skipped: python3-numpy is not there; ./build.sh test installs it on Debian")
    sys.exit(77)

formats = ["mdd", "obj", "ply", "vtk", "gltf", "usda", "csv"]
name = 'sheet & "two" <uv> é'

scene = """
[simulation]
duration = "0.4 s"
time_step = "10 ms"
frame_rate = "25 Hz"
[[cloth]]
name = '%s'
mesh = "seam.obj"
fabric = "cotton-poplin"
[[cloth]]
name = "plain"
mesh = "plain.obj"
fabric = "cotton-poplin"
[[obstacle]]
name = "ball"
shape = "sphere"
centre = [0, 0, 0]
radius = 0.2
friction = 0.3
[obstacle.motion]
keyframes = [{ time = 0 }, { time = "0.4 s", translate = [0.1, 0.05, 0], rotate = { axis = [1, 2, 0], angle = "200 deg" } }]
[[obstacle]]
name = "stand"
shape = "box"
centre = [1, -0.1, 0]
size = [0.2, 0.2, 0.2]
[[obstacle]]
name = "blob"
shape = "mesh"
mesh = "blob_0001.obj"
frames = "blob_%%04d.obj"
frame_rate = "25 Hz"
""" % name


def grid_obj(sides, width, at, seam):
    """Quads; `seam`: the right half has uv of its own, so that the middle column has two."""
    lines = []
    for j in range(sides + 1):
        for i in range(sides + 1):
            x, z = (i / sides - 0.5) * width + at[0], (j / sides - 0.5) * width + at[2]
            lines.append("v %.9g %.9g %.9g" % (x, at[1], z))
    shifts = [0, 0.25] if seam else [0]
    for shift in shifts:
        for j in range(sides + 1):
            for i in range(sides + 1):
                lines.append("vt %.9g %.9g" % (0.75 * i / sides + shift, j / sides))
    count = (sides + 1) ** 2
    for j in range(sides):
        for i in range(sides):
            corners = [j * (sides + 1) + i, (j + 1) * (sides + 1) + i, (j + 1) * (sides + 1) + i + 1, j * (sides + 1) + i + 1]
            second = count if seam and i >= sides // 2 else 0
            lines.append("f " + " ".join("%d/%d" % (v + 1, v + 1 + second) for v in corners))
    return "\n".join(lines) + "\n"


def blob_obj(centre, radius, height):
    """An octahedron, its sides cut in four: closed, triangles."""
    points = [np.array(p, float) for p in [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]]
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    middle = {}

    def between(a, b):
        key = (min(a, b), max(a, b))
        if key not in middle:
            p = points[a] + points[b]
            points.append(p / np.linalg.norm(p))
            middle[key] = len(points) - 1
        return middle[key]

    cut = []
    for a, b, c in faces:
        ab, bc, ca = between(a, b), between(b, c), between(c, a)
        cut += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    lines = ["v %.9g %.9g %.9g" % tuple(p * [radius, height, radius] + centre) for p in points]
    return "\n".join(lines + ["f %d %d %d" % (a + 1, b + 1, c + 1) for a, b, c in cut]) + "\n"


def read_pc2(path):
    data = path.read_bytes()
    points, samples = np.frombuffer(data, "<i4", 1, 16)[0], np.frombuffer(data, "<i4", 1, 28)[0]
    return np.frombuffer(data, "<f4", offset=32).reshape(samples, points, 3).astype(float)


def read_obj(path):
    points, faces, texcoords, uv = [], [], [], []
    for words in map(str.split, path.read_text().splitlines()):
        if words and words[0] == "v":
            points.append([float(w) for w in words[1:4]])
        elif words and words[0] == "vt":
            texcoords.append([float(w) for w in words[1:3]])
        elif words and words[0] == "f":
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
            uv.append([texcoords[int(w.split("/")[1]) - 1] for w in words[1:] if "/" in w])
    return np.array(points), faces, uv if texcoords else None


def turn(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def moved(last, poses):
    """bodies/NAME.obj is the last place of the body; its frames by the rows of bodies.csv: x = R X + t."""
    places = [(turn(*(float(row[q]) for q in ("qw", "qx", "qy", "qz"))), np.array([float(row[a]) for a in "xyz"])) for row in poses]
    drawn = (last - places[-1][1]) @ places[-1][0]
    return np.array([drawn @ turned.T + shift for turned, shift in places])


class Shape:
    """name, body, moves; positions[frame, vertex]; faces; uv of their corners or None; of a cloth velocity, strain, contact."""


def shapes(folder):
    """What the run in this folder wrote, cloths first."""
    record = json.loads((folder / "run.json").read_text())
    times = record["frame_times"]
    with open(folder / "bodies.csv") as file:
        rows = list(csv.DictReader(file))
    found = []
    for entry in record["cloths"] + record["bodies"]:
        shape = Shape()
        shape.name, shape.body = entry["name"], "file" in entry
        points, shape.faces, shape.uv = read_obj(folder / ("bodies" if shape.body else ".") / (shape.name + ".obj"))
        cache = folder / ("bodies" if shape.body else ".") / (shape.name + ".pc2")
        poses = [row for row in rows if row["body"] == shape.name]
        shape.moves = cache.exists() or bool(poses)
        if cache.exists():
            shape.positions = read_pc2(cache)
        elif poses:
            shape.positions = moved(points, poses)
        else:
            shape.positions = np.array([points] * len(times))
        assert shape.positions.shape == (len(times), len(points), 3), shape.name
        if not shape.body:
            shape.velocity, shape.strain, shape.contact = (
                np.load(folder / "fields" / f"{shape.name}.{what}.npy") for what in ("velocity", "strain", "contact"))
        found.append(shape)
    return times, found


def main(program, folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "scene.toml").write_text(scene)
    (folder / "seam.obj").write_text(grid_obj(10, 0.6, (0, 0.21, 0), True))
    (folder / "plain.obj").write_text(grid_obj(6, 0.3, (1, 0.05, 0), False))
    for frame in range(11):
        height = 0.15 + 0.03 * math.sin(frame)
        (folder / f"blob_{frame + 1:04d}.obj").write_text(blob_obj(np.array([-1, 0, 0]), 0.15, height))
    run = folder / "run"
    subprocess.run([program, "simulate", folder / "scene.toml", "--out", run, "--quiet"], check=True)
    for to in formats:
        subprocess.run([program, "export", run, "--to", to, "-o", folder / to], check=True)
    times, found = shapes(run)
    expected = [{"name": s.name, "body": s.body, "moves": s.moves, "faces": s.faces, "uv": s.uv,
                 "positions": [frame.ravel().tolist() for frame in s.positions],
                 "velocities": None if s.body else [frame.ravel().tolist() for frame in s.velocity]} for s in found]
    (folder / "expected.json").write_text(json.dumps({"times": times, "shapes": expected}))


if __name__ == "__main__":
    main(*sys.argv[1:])
