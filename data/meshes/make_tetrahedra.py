#!/usr/bin/env python3
"""Makes rabbit.msh, a soft body of tetrahedra, beside this file:  python3 make_tetrahedra.py

The shape is a smooth union of balls, ellipsoids and capsules. A body-centred lattice is laid over it; corners near the surface are moved onto it, and
the tetrahedra that the surface still goes through are cut there [after Labelle & Shewchuk 2007, isosurface stuffing]. Needs numpy; makes the same file
every time.
"""
import itertools
import pathlib

import numpy as np

here = pathlib.Path(__file__).resolve().parent
cell = 0.021  # m, edge of the lattice's cubes
near_long, near_short = 0.25, 0.41  # of an edge: a corner this near to the surface is moved onto it

# Centre, half axes [m]; the rabbit looks along +z, its feet stand on y = 0.
ellipsoids = [((0, 0.075, -0.01), (0.062, 0.068, 0.085)), ((0, 0.155, 0.065), (0.043, 0.043, 0.048)), ((0, 0.07, -0.105), (0.024, 0.024, 0.024)),
              ((0.042, 0.021, 0.045), (0.024, 0.021, 0.048)), ((-0.042, 0.021, 0.045), (0.024, 0.021, 0.048)),
              ((0.05, 0.024, -0.05), (0.027, 0.024, 0.05)), ((-0.05, 0.024, -0.05), (0.027, 0.024, 0.05))]
# Ends, radius [m]: the ears.
capsules = [((0.02, 0.18, 0.055), (0.038, 0.262, 0.035), 0.0155), ((-0.02, 0.18, 0.055), (-0.038, 0.262, 0.035), 0.0155)]
round_off = 0.02  # m: over which the parts flow into each other


def smooth_min(a, b):
    h = np.maximum(round_off - np.abs(a - b), 0) / round_off
    return np.minimum(a, b) - h * h * round_off / 4


def height(p):
    """Negative inside; about the distance near the surface."""
    value = np.full(len(p), np.inf)
    for centre, axes in ellipsoids:
        q = (p - centre) / axes
        size = np.linalg.norm(q, axis=1)
        value = smooth_min(value, size * (size - 1) / np.maximum(np.linalg.norm(q / axes, axis=1), 1e-9))
    for a, b, radius in capsules:
        a, b = np.array(a), np.array(b)
        along = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        value = smooth_min(value, np.linalg.norm(p - a - along[:, None] * (b - a), axis=1) - radius)
    return value


def lattice(low, high):
    """Corners and tetrahedra of a body-centred lattice: two corners of an edge of a cube and the middles of two cubes side by side there."""
    count = np.ceil((high - low) / cell).astype(int)
    corner = lambda i, j, k: (i * (count[1] + 1) + j) * (count[2] + 1) + k
    corners = np.array(list(itertools.product(*(range(n + 1) for n in count)))) * cell + low
    middles = (np.array(list(itertools.product(*(range(n) for n in count)))) + 0.5) * cell + low
    middle = lambda i, j, k: len(corners) + (i * count[1] + j) * count[2] + k
    tetrahedra = []
    for cube in itertools.product(*(range(n) for n in count)):
        for axis in range(3):
            beside = list(cube)
            beside[axis] += 1
            if beside[axis] == count[axis]:
                continue
            b, c = (axis + 1) % 3, (axis + 2) % 3
            ring = []
            for db, dc in ((0, 0), (1, 0), (1, 1), (0, 1)):
                at = list(beside)
                at[b] += db
                at[c] += dc
                ring.append(corner(*at))
            tetrahedra += [(middle(*cube), middle(*beside), ring[k], ring[(k + 1) % 4]) for k in range(4)]
    return np.vstack([corners, middles]), np.array(tetrahedra), len(corners)


def root(a, b):
    """Where the surface crosses the way from a (inside) to b (outside), as shares of the way."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    for _ in range(40):
        t = (low + high) / 2
        inside = height(a + t[:, None] * (b - a)) < 0
        low, high = np.where(inside, t, low), np.where(inside, high, t)
    return (low + high) / 2


def edges_of(tetrahedra):
    pairs = np.vstack([tetrahedra[:, [a, b]] for a, b in itertools.combinations(range(4), 2)])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def warp(points, sign, edges, corners):
    """Moves corners that are near to a crossing of one of their edges onto the nearest such crossing; they then have the sign 0."""
    crossed = edges[sign[edges[:, 0]] * sign[edges[:, 1]] < 0]
    inside = np.where(sign[crossed[:, 0]] < 0, crossed[:, 0], crossed[:, 1])
    outside = crossed.sum(1) - inside
    t = root(points[inside], points[outside])
    place = points[inside] + t[:, None] * (points[outside] - points[inside])
    long = (crossed < corners).all(1) | (crossed >= corners).all(1)
    limit = np.where(long, near_long, near_short)
    best = {}
    for i, o, share, x, most in zip(inside, outside, t, place, limit):
        for v, distance in ((i, share), (o, 1 - share)):
            if distance < most and (v not in best or distance < best[v][0]):
                best[v] = (distance, x)
    for v, (_, x) in best.items():
        points[v], sign[v] = x, 0


def cut(points, sign, tetrahedra):
    """The part of every tetrahedron that lies inside, as tetrahedra. A face of four corners is divided from its first corner in the order of the
    numbers, so that both sides of it divide it alike."""
    points, between, result = list(points), {}, []

    def crossing(i, o):
        if (i, o) not in between:
            a, b = points[i][None], points[o][None]
            between[i, o] = len(points)
            points.append((a + root(a, b)[:, None] * (b - a))[0])
        return between[i, o]

    for tetrahedron in tetrahedra:
        if not (sign[tetrahedron] < 0).any():
            continue
        polygons = []
        for skip in range(4):
            polygon = []
            face = [v for k, v in enumerate(tetrahedron) if k != skip]
            for a, b in zip(face, face[1:] + face[:1]):
                if sign[a] <= 0:
                    polygon.append(a)
                if sign[a] * sign[b] < 0:
                    polygon.append(crossing(*((a, b) if sign[a] < 0 else (b, a))))
            polygons.append(polygon)
        # The crossings and what lies on the surface close the solid.
        rim = sorted({v for p in polygons for v in p if v >= len(sign) or sign[v] == 0})
        if (sign[tetrahedron] > 0).any() and len(rim) >= 3:
            polygons.append(in_order(rim, polygons))
        first = min(v for p in polygons for v in p)
        for polygon in polygons:
            if len(polygon) < 3 or first in polygon:
                continue
            start = polygon.index(min(polygon))
            p = polygon[start:] + polygon[:start]
            result += [(first, p[0], p[k], p[k + 1]) for k in range(1, len(p) - 1)]
    return np.array(points), np.array(result)


def in_order(rim, polygons):
    """The corners of the cut, each beside those with which it shares a side of another face."""
    sides = {frozenset(s) for p in polygons for s in zip(p, p[1:] + p[:1])}
    order = rim[:1]
    while len(order) < len(rim):
        order.append(next(v for v in rim if v not in order and frozenset((v, order[-1])) in sides))
    return order


def tidy(points, tetrahedra):
    """Every tetrahedron with a positive volume, the corners that are used, numbered anew."""
    x = points[tetrahedra]
    volume = np.einsum("ij,ij->i", np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), x[:, 3] - x[:, 0]) / 6
    tetrahedra = tetrahedra.copy()
    tetrahedra[volume < 0] = tetrahedra[volume < 0][:, [0, 2, 1, 3]]
    assert np.abs(volume).min() > 1e-12
    used, numbers = np.unique(tetrahedra, return_inverse=True)
    return points[used], numbers.reshape(tetrahedra.shape)


def surface(tetrahedra):
    faces = np.vstack([tetrahedra[:, f] for f in ([0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3])])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]


def smallest_angle(points, tetrahedra):
    """Of all angles between two faces, in degrees."""
    least = 180.0
    for a, b, c, d in itertools.permutations(range(4)):
        if a > b or c > d:
            continue
        p = points[tetrahedra]
        edge = p[:, b] - p[:, a]
        u, v = np.cross(edge, p[:, c] - p[:, a]), np.cross(edge, p[:, d] - p[:, a])
        cosine = np.einsum("ij,ij->i", u, v) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        least = min(least, np.degrees(np.arccos(np.clip(cosine, -1, 1))).min())
    return least


def number(value):
    text = f"{value:.5f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write(name, points, tetrahedra, groups):
    """Gmsh 2.2, as text. groups: a name and its triangles."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Comments", "A rabbit, 27 cm high, in metres, y up. Made by make_tetrahedra.py; CC0 1.0.", "$EndComments",
             "$PhysicalNames", str(1 + len(groups)), '3 1 "body"']
    lines += [f'2 {k + 2} "{name}"' for k, (name, _) in enumerate(groups)] + ["$EndPhysicalNames", "$Nodes", str(len(points))]
    lines += [f"{k + 1} " + " ".join(number(x) for x in p) for k, p in enumerate(points)]
    elements = [(4, 1, t) for t in tetrahedra] + [(2, k + 2, t) for k, (_, triangles) in enumerate(groups) for t in triangles]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k + 1} {kind} 2 {group} {group} " + " ".join(str(v + 1) for v in corners) for k, (kind, group, corners) in enumerate(elements)]
    (here / name).write_text("\n".join(lines + ["$EndElements"]) + "\n")
    print(f"{name}: {len(points)} vertices, {len(tetrahedra)} tetrahedra, smallest angle {smallest_angle(points, tetrahedra):.1f} degrees")


def is_manifold(tetrahedra):
    """Whether two triangles of the surface meet at each of its edges."""
    faces = surface(tetrahedra)
    pairs = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return (np.unique(pairs, axis=0, return_counts=True)[1] == 2).all()


def main():
    for shift in np.arange(0, 1, 0.1) * cell:  # of the lattice, until its cut touches itself nowhere
        low = np.array([-0.09, -0.031, -0.16]) - 1e-4 - shift
        points, tetrahedra, corners = lattice(low, np.array([0.09, 0.3, 0.14]))
        sign = np.sign(height(points)).astype(int)
        warp(points, sign, edges_of(tetrahedra), corners)
        points, tetrahedra = tidy(*cut(points, sign, tetrahedra))
        if is_manifold(tetrahedra):
            break
    else:
        raise SystemExit("no place of the lattice makes a surface that is good everywhere")
    points = np.round(points, 5)
    faces = surface(tetrahedra)
    middle = points[faces].mean(1)
    write("rabbit.msh", points, tetrahedra, [("ears", faces[middle[:, 1] > 0.2]), ("feet", faces[middle[:, 1] < 0.012])])


if __name__ == "__main__":
    main()
