#!/usr/bin/env python3
"""Makes the meshes of this folder again: sheet-958.obj, sheet-2500.obj, tablecloth.obj, poncho.obj, flag.obj, net.obj, sheet-625.obj, dress.obj, nails.obj,
needle.obj, sleeve.obj, funnel.obj, reef-knot.obj, fifty-sheets.obj, pocket.obj. Not run by the build.

    python3 make_meshes.py                       the generated meshes
    python3 make_meshes.py BODY.obj TEE.obj      body.obj and tee.obj, too, from files in metres (see ../README.md)

Needs numpy and scipy (Debian: python3-scipy). The seeds are fixed: it makes the same files every time.
"""
import pathlib
import sys

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.spatial import Delaunay

here = pathlib.Path(__file__).resolve().parent
rounds_of_relaxation = 60
smallest_angle = 25  # degrees, of the irregular meshes


def triangulate(points, hole):
    """Delaunay triangles of points (x, z), turned so that their normals point up (y), without those in the hole."""
    t = Delaunay(points).simplices
    a, b, c = (points[t[:, k]] for k in range(3))
    twice = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    t[twice > 0] = t[twice > 0][:, [0, 2, 1]]
    keep = np.abs(twice) > 1e-7  # what lies between points of one straight side has no area
    if hole is not None:
        # A triangle that only has vertices of the hole's rim lies in the hole.
        keep &= ~hole[t].all(axis=1)
    return t[keep]


def area_and_middle(points, t):
    a, b, c = (points[t[:, k]] for k in range(3))
    area = 0.5 * np.abs((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))
    return area, (a + b + c) / 3


def relaxed(rim, inside, hole=None):
    """Lloyd relaxation of the inner points: each goes to the middle of the triangles around it. The rim stays."""
    points = np.vstack([rim, inside])
    for _ in range(rounds_of_relaxation):
        t = triangulate(points, hole)
        area, middle = area_and_middle(points, t)
        weight = np.zeros(len(points))
        moment = np.zeros_like(points)
        for k in range(3):
            np.add.at(weight, t[:, k], area)
            np.add.at(moment, t[:, k], area[:, None] * middle)
        points[len(rim):] = (moment / weight[:, None])[len(rim):]
    points = np.round(points, 5)
    return points, triangulate(points, hole)


def spread(rng, count, low, high, inside, distance):
    """`count` random points where `inside` holds, none nearer than `distance` to another."""
    points = np.empty((0, 2))
    while len(points) < count:
        p = rng.uniform(low, high, 2)
        if inside(p) and (len(points) == 0 or np.min(np.sum((points - p) ** 2, axis=1)) > distance**2):
            points = np.vstack([points, p])
    return points


def square(rng, side, per_side, count):
    """A square of `count` vertices, `per_side` edges on each side, centred."""
    s = np.arange(per_side) / per_side * side - side / 2
    e = np.full(per_side, side / 2)
    rim = np.vstack([np.c_[s, -e], np.c_[e, s], np.c_[-s, e], np.c_[-e, -s]])
    edge = side / per_side
    half = side / 2 - 0.6 * edge
    return relaxed(rim, spread(rng, count - len(rim), -half, half, lambda p: True, 0.72 * edge))


def ring(rng, inner, outer, around_inner, around_outer, count):
    def circle(radius, n):
        a = 2 * np.pi * np.arange(n) / n
        return radius * np.c_[np.cos(a), np.sin(a)]

    rim = np.vstack([circle(inner, around_inner), circle(outer, around_outer)])
    edge = 2 * np.pi * outer / around_outer
    between = lambda p: inner + 0.6 * edge < np.hypot(*p) < outer - 0.6 * edge
    hole = np.zeros(count, bool)
    hole[:around_inner] = True
    return relaxed(rim, spread(rng, count - len(rim), -outer, outer, between, 0.72 * edge), hole)


def angles(points, t):
    p = points[t]
    smallest = 180.0
    for k in range(3):
        u, v = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        cosine = (u * v).sum(1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        smallest = min(smallest, np.degrees(np.arccos(cosine)).min())
    return smallest


def number(value, digits):
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write(name, comments, points, faces, uv=None, digits=5, groups=None):
    lines = [f"# {c}" for c in comments]
    lines += ["v " + " ".join(number(x, digits) for x in p) for p in points]
    if uv is not None:
        lines += ["vt " + " ".join(number(x, digits) for x in p) for p in uv]
    for k, face in enumerate(faces):
        if groups is not None and (k == 0 or groups[k] != groups[k - 1]):
            lines.append(f"g {groups[k]}")
        lines.append("f " + " ".join(f"{i + 1}/{i + 1}" if uv is not None else f"{i + 1}" for i in face))
    (here / name).write_text("\n".join(lines) + "\n")
    print(f"{name}: {len(points)} vertices, {len(faces)} faces")


def first_good(make):
    """make(rng) of the first seed whose triangles all have good angles."""
    for seed in range(100):
        plane, triangles = make(np.random.default_rng(seed))
        if angles(plane, triangles) >= smallest_angle:
            return plane, triangles
    raise SystemExit("no seed gives good angles")


def write_flat(name, comments, plane, triangles):
    """Points (x, z) as a cloth in the plane y = 0; uv is the place in the plane in metres, from the lower left corner."""
    found = angles(plane, triangles)
    points = np.c_[plane[:, 0], np.zeros(len(plane)), plane[:, 1]]
    uv = np.c_[plane[:, 0] - plane[:, 0].min(), plane[:, 1].max() - plane[:, 1]]
    write(name, comments + [f"Metres, y up. Smallest angle {found:.0f} degrees. Made by make_meshes.py; CC0 1.0."], points, triangles, uv)


def read(path):
    points, faces = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        word = line.split()
        if word[:1] == ["v"]:
            points.append([float(w) for w in word[1:4]])
        elif word[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) - 1 for w in word[1:]])
    return np.array(points), faces


def flag(columns, rows, width, height):
    """Upright, the hoist at x = 0, the upper edge at y = 0. Vertices row by row from the upper hoist corner; quads."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, -height, rows + 1))
    points = np.c_[x.ravel(), y.ravel(), np.zeros(x.size)]
    across = columns + 1
    faces = [[r * across + c, (r + 1) * across + c, (r + 1) * across + c + 1, r * across + c + 1]
             for r in range(rows) for c in range(columns)]
    return points, faces, np.c_[points[:, 0], points[:, 1] + height]


def dress(around, rows, length):
    """A dress without straps, standing, its hem at y = 0: ellipses from the hem over the waist to the bust. Rows from above; quads."""
    height = [0, 0.55, 0.7, 1.0]  # of the length: hem, hips, waist, bust
    half_width, half_depth = [0.30, 0.185, 0.145, 0.18], [0.27, 0.135, 0.105, 0.125]  # m
    smooth = lambda values: PchipInterpolator(height, values)(1 - np.arange(rows + 1) / rows)
    angle = 2 * np.pi * np.arange(around) / around
    a, b = smooth(half_width)[:, None], smooth(half_depth)[:, None]
    y = length * (1 - np.arange(rows + 1) / rows)[:, None] + 0 * angle
    points = np.stack([a * np.sin(angle), y, b * np.cos(angle)], -1).reshape(-1, 3)
    faces = [[r * around + c, (r + 1) * around + c, (r + 1) * around + (c + 1) % around, r * around + (c + 1) % around]
             for r in range(rows) for c in range(around)]
    return points, faces


def sleeve(around, rows, radius, length):
    """A tube along x, its middle at the origin. Rings from low to high x; quads, normals out."""
    turn = 2 * np.pi * np.arange(around) / around
    points = [(length * (r / rows - 0.5), radius * np.cos(a), radius * np.sin(a)) for r in range(rows + 1) for a in turn]
    faces = [(r * around + c, r * around + (c + 1) % around, (r + 1) * around + (c + 1) % around, (r + 1) * around + c)
             for r in range(rows) for c in range(around)]
    return np.array(points), faces


def revolved(profile, edge, around):
    """The closed profile of (radius, y), turned about the y axis; its sides are cut into edges of at most `edge`."""
    rings = []
    for p, q in zip(np.array(profile), np.roll(profile, -1, axis=0)):
        pieces = int(np.ceil(np.linalg.norm(q - p) / edge))
        rings += [p + (q - p) * k / pieces for k in range(pieces)]
    turn, n = 2 * np.pi * np.arange(around) / around, len(rings)
    points = [(r * np.sin(a), y, r * np.cos(a)) for r, y in rings for a in turn]
    faces = [(k * around + c, k * around + (c + 1) % around, (k + 1) % n * around + (c + 1) % around, (k + 1) % n * around + c)
             for k in range(n) for c in range(around)]
    return np.array(points), faces


def nails(places, radius, around, size, thickness):
    """A square board, its top at y = 0, and a nail of each (x, z, height) on it."""
    s, t = size / 2, thickness
    points = [(x, y, z) for y in (-t, 0) for z in (-s, s) for x in (-s, s)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    for x, z, height in places:
        first, turns = len(points), 2 * np.pi * np.arange(around) / around
        points += [(x + radius * np.cos(a), 0.001, z + radius * np.sin(a)) for a in turns] + [(x, height, z), (x, 0.001, z)]
        for k in range(around):
            rim = (first + k, first + (k + 1) % around)
            faces += [(rim[0], first + around, rim[1]), (rim[1], first + around + 1, rim[0])]
    return np.array(points), faces


def reef_knot(cells, across, width):
    """Two bands in a loose reef knot, upright on their edges: the ends of the first at low x, those of the second at high x. uv is the flat band,
    v along it. Quads, row after row of each band."""
    narrow, wide, middle, end = 0.04, 0.12, 0.1, 0.9  # m: half distances of the legs, where the bight begins, where the band ends
    x = np.linspace(-end, middle, 2001)
    t = np.clip((x + middle) / (2 * middle), 0, 1)
    arc = np.linspace(np.pi / 2, 0, 1001)[1:]
    leg = np.r_[np.c_[x, narrow + (wide - narrow) * t * t * (3 - 2 * t)], np.c_[middle + wide * np.cos(arc), wide * np.sin(arc)]]
    plan = np.r_[leg, leg[-2::-1] * [1, -1]]
    along = np.r_[0, np.cumsum(np.linalg.norm(np.diff(plan, axis=0), axis=1))]
    # Over the other bight, under its legs, and with its own bight over both of them. The bands stand above each other there.
    crossing = middle + np.sqrt(wide**2 - narrow**2)
    half = along[len(leg) - 1]
    places = np.r_[along[np.searchsorted(x, [-end, -0.5, -crossing, 0])], half - wide * np.arcsin(narrow / wide), half]
    height = 0.64 * width * np.array([0, 0, 1, -1, 1, 1])
    z = PchipInterpolator(np.r_[places, 2 * half - places[-2::-1]], np.r_[height, height[-2::-1]])(along)
    path = np.c_[plan, z]
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    rows = np.linspace(0, length[-1], cells + 1)
    path = np.stack([np.interp(rows, length, c) for c in path.T], 1)
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    up = np.array([0, 0, 1]) - tangent[:, 2:] * tangent
    up /= np.linalg.norm(up, axis=1)[:, None]
    v = np.linspace(-width / 2, width / 2, across + 1)
    first = (path[:, None] + v[:, None] * up[:, None]).reshape(-1, 3)
    uv = np.stack(np.broadcast_arrays(v + width / 2, rows[:, None]), -1).reshape(-1, 2)
    points = np.r_[first, first * [-1, 1, -1]]
    n, a = len(first), across + 1
    faces = [[b + r * a + c, b + r * a + c + 1, b + (r + 1) * a + c + 1, b + (r + 1) * a + c] for b in (0, n) for r in range(cells) for c in range(across)]
    return points, faces, np.r_[uv, uv + [2 * width, 0]]


def pile(count, cells, side, distance, turn):
    """`count` square sheets of `cells` x `cells` quads, one over the other, each turned by `turn` against the one below. Normals up."""
    s = np.linspace(-side / 2, side / 2, cells + 1)
    z, x = (c.ravel() for c in np.meshgrid(s, s, indexing="ij"))
    a = cells + 1
    of_one = [[r * a + c, (r + 1) * a + c, (r + 1) * a + c + 1, r * a + c + 1] for r in range(cells) for c in range(cells)]
    points, faces = [], []
    for k in range(count):
        cosine, sine = np.cos(k * turn), np.sin(k * turn)
        points += list(zip(cosine * x + sine * z, 0 * x + k * distance, cosine * z - sine * x))
        faces += [[k * a * a + i for i in f] for f in of_one]
    return np.array(points), faces


def pocket(cell):
    """A panel that stands, 40 x 40 quads, with a pocket of 16 x 16 sewn on by three sides and a flap of 16 x 6 by its upper one, in front (+z). Pocket and
    flap go in waves through what is behind them. Also the faces' groups."""
    n = 40
    points = [(cell * (c - n / 2), -cell * r, 0) for r in range(n + 1) for c in range(n + 1)]
    on_panel = lambda r, c: r * (n + 1) + c
    faces, groups = [], []

    def piece(name, top, left, rows, columns, sewn, depth):
        at = {}
        for r in range(rows + 1):
            for c in range(columns + 1):
                if sewn(r, c):
                    at[r, c] = on_panel(top + r, left + c)
                else:
                    at[r, c] = len(points)
                    x, y, _ = points[on_panel(top + r, left + c)]
                    points.append((x, y, depth(r, c)))
        for r in range(rows):
            for c in range(columns):
                quad = [at[r, c], at[r + 1, c], at[r + 1, c + 1], at[r, c + 1]]
                free = [k for k in range(4) if quad[k] >= (n + 1) ** 2]
                if name != "panel" and len(free) == 1:  # a corner: no triangle of three sewn vertices, which would lie in the panel
                    k = free[0]
                    faces.extend([quad[k], quad[(k + 1 + i) % 4], quad[(k + 2 + i) % 4]] for i in (0, 1))
                    groups.extend([name, name])
                else:
                    faces.append(quad)
                    groups.append(name)

    smooth = lambda t: np.clip(t, 0, 1) ** 2 * (3 - 2 * np.clip(t, 0, 1))
    piece("panel", 0, 0, n, n, lambda r, c: True, None)
    # In front of the panel for two cells from each seam; beyond, waves of 6 mm.
    from_seam = lambda r, c: min(c, 16 - c, 16 - r)
    piece("pocket", 14, 12, 16, 16, lambda r, c: c in (0, 16) or r == 16,
          lambda r, c: 0.003 + 0.006 * smooth((from_seam(r, c) - 2) / 3) * np.sin(0.9 * c) * np.cos(0.7 * r))
    piece("flap", 12, 12, 6, 16, lambda r, c: r == 0, lambda r, c: 0.003 + 0.007 * smooth((r - 1) / 3) * np.sin(0.6 * c + 1))
    return np.array(points), faces, groups


def write_nails():
    heights = [(-0.11, -0.1, 0.15), (0.1, -0.115, 0.11), (-0.09, 0.105, 0.13), (0.115, 0.09, 0.16), (0.01, -0.005, 0.2)]
    points, faces = nails(heights, 0.006, 12, 0.34, 0.02)
    write("nails.obj", ["A board of 34 cm with five nails, 11 to 20 cm long, the top of the board at y = 0.",
                        "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces)


def write_line(name, comments, points):
    lines = [f"# {c}" for c in comments] + ["v " + " ".join(number(x, 5) for x in p) for p in points]
    lines += ["o " + pathlib.Path(name).stem, "l " + " ".join(str(k + 1) for k in range(len(points)))]
    (here / name).write_text("\n".join(lines) + "\n")
    print(f"{name}: {len(points)} vertices")


def over_drum(radius, height, left, right, parts):
    """A line that goes up on the left, half round a drum along z at this height, and down on the right."""
    angles = np.linspace(np.pi, 0, parts + 1)
    arc = [(radius * np.cos(a), height + radius * np.sin(a), 0) for a in angles]
    return [(-radius, height - left, 0), *arc, (radius, height - right, 0)]


def main():
    write_flat("sheet-958.obj", ["Square sheet, 1 m x 1 m, 958 vertices, irregular triangles."],
               *first_good(lambda rng: square(rng, 1.0, 28, 958)))
    write_flat("sheet-2500.obj", ["Square sheet, 1 m x 1 m, 2500 vertices, irregular triangles."],
               *first_good(lambda rng: square(rng, 1.0, 46, 2500)))
    write_flat("tablecloth.obj", ["Square cloth, 1.2 m x 1.2 m, 1600 vertices, irregular triangles."],
               *first_good(lambda rng: square(rng, 1.2, 36, 1600)))
    write_flat("poncho.obj", ["Ring, inner radius 0.115 m, outer radius 0.55 m, 1500 vertices, irregular triangles."],
               *first_good(lambda rng: ring(rng, 0.115, 0.55, 27, 127, 1500)))
    points, faces, uv = flag(30, 20, 1.5, 1.0)
    write("flag.obj", ["Flag, 1.5 m x 1 m, 30 x 20 quads. Vertex 0: upper hoist corner, vertex 620: lower hoist corner.",
                       "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces, uv)
    points, faces, uv = flag(30, 30, 1.0, 1.0)  # laid flat, its upper edge at the back
    write("net.obj", ["Net, 1 m x 1 m, 30 x 30 quads in the plane y = 0, normals up. Corners: vertices 0, 30, 930, 960.",
                      "Metres, y up. Made by make_meshes.py; CC0 1.0."], np.c_[points[:, 0] - 0.5, points[:, 2], -0.5 - points[:, 1]], faces, uv)
    points, faces, uv = flag(24, 24, 1.0, 1.0)
    write("sheet-625.obj", ["Square sheet, 1 m x 1 m, 25 x 25 vertices, quads, in the plane y = 0, normals up.",
                            "Metres, y up. Made by make_meshes.py; CC0 1.0."], np.c_[points[:, 0] - 0.5, points[:, 2], -0.5 - points[:, 1]], faces, uv)
    points, faces = dress(80, 45, 0.95)
    write("dress.obj", ["A dress without straps, 95 cm long, 80 x 45 quads, standing, its hem at y = 0.",
                        "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces)
    write_nails()
    write_line("rope-over-drum.obj", ["A line over a drum along z, whose axis is 1.5 m high: half round it at 157.5 mm, 80 cm down on the left, 50 cm on the right.",
                                      "Metres, y up. Made by make_meshes.py; CC0 1.0."], over_drum(0.1575, 1.5, 0.8, 0.5, 48))
    points, faces = nails([(0, 0, 0.4)], 0.003, 12, 0.03, 0.02)
    write("needle.obj", ["A needle, 40 cm long and 6 mm thick where it stands on a block of 3 cm, whose top is at y = 0.",
                         "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces)
    points, faces = sleeve(72, 48, 0.2, 0.8)
    write("sleeve.obj", ["A sleeve along x, 80 cm long, 40 cm across, 48 x 72 quads, its middle at the origin, normals out.",
                         "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces)
    points, faces = revolved([(0.70, 0.50), (0.17, 0.0), (0.17, -0.30), (0.20, -0.30), (0.20, -0.02), (0.73, 0.48)], 0.06, 60)
    write("funnel.obj", ["A funnel, closed: its opening is 1.4 m across, its neck 34 cm, which begins at y = 0.",
                         "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces)
    points, faces, uv = reef_knot(160, 6, 0.03)
    write("reef-knot.obj", ["Two bands, 3 cm wide, 160 x 6 quads each, in a loose reef knot along x; uv is what they are flat, in metres.",
                            "Made by make_meshes.py; CC0 1.0."], points, faces, uv)
    points, faces = pile(50, 10, 0.3, 0.005, np.radians(7))
    write("fifty-sheets.obj", ["Fifty sheets, 30 cm x 30 cm, 10 x 10 quads each, one over the other, 5 mm apart, each turned by 7 degrees.",
                               "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces)
    points, faces, groups = pocket(0.01)
    write("pocket.obj", ["A panel, 40 cm x 40 cm, with a pocket and its flap in front (+z), which go through each other and through the panel.",
                         "Metres, y up. Made by make_meshes.py; CC0 1.0."], points, faces, groups=groups)
    if len(sys.argv) == 3:
        points, faces = read(sys.argv[1])
        write("body.obj", ["CC0 1.0. The base mesh hm08 of MakeHuman (makehumancommunity/makehuman, makehuman/data/3dobjs/base.obj), group",
                           '"body", with the targets caucasian-male-young and universal-male-young-averagemuscle-averageweight.',
                           "Metres, y up, feet at y = 0; rounded to 0.1 mm, texture coordinates dropped, quads kept."], points, faces, digits=4)
        points, faces = read(sys.argv[2])
        write("tee.obj", ["CC0 1.0. The tee of MakeHuman's clothes male_casualsuit04 (makehumancommunity/makehuman-assets,",
                          "base/clothes/male_casualsuit04), fitted to body.obj with its .mhclo, at least 3 mm from it.",
                          "Metres, y up; rounded to 0.01 mm, texture coordinates dropped."], points, faces, digits=5)


if __name__ == "__main__":
    main()
