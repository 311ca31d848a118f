#!/usr/bin/env python3
"""How far apart the same fabric settles on a ball when only its mesh differs.

    python3 two_meshes.py [--program build/release/drape] [--edges 15,10] [--model woven] [--side 300] [--starts 2]

A square sheet (0.15 kg/m^2, Y 500 N/m, B 10 uN m, side in mm) falls on a ball whose radius is 0.3 of its side and comes to rest, on a grid with alternating
diagonals and on irregular triangles, with the edges given [mm]. Every other start is pushed aside by 0.1 mm. Compared are the
places of 61 x 61 points of the fabric: the root of their mean squared distance, as the sheets lie, and for the best of the eight
turns and reflections of a square, under which fabric and ball are the same. Shapes nearer than 4 mm in the latter are one
pattern of folds. Prints tables in Markdown. Needs numpy and scipy (Debian: python3-scipy).
"""
import argparse
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.interpolate import LinearNDInterpolator

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "data/meshes"))
import make_meshes  # noqa: E402

one_pattern = 4e-3  # m


def grid(side, edge):
    """Points (x, z) of squares whose diagonals alternate."""
    n = round(side / edge)
    x, z = np.meshgrid(*2 * [np.linspace(-side / 2, side / 2, n + 1)], indexing="ij")
    at = lambda i, k: i * (n + 1) + k
    faces = []
    for i, k in itertools.product(range(n), range(n)):
        a, b, c, d = at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)
        faces += [(a, b, c), (a, c, d)] if (i + k) % 2 else [(a, b, d), (b, c, d)]
    return np.c_[x.ravel(), z.ravel()], faces


def irregular(side, edge):
    per_side = round(side / edge)
    count = round(1.12 * per_side**2) + 2 * per_side  # as dense as triangles with this edge are
    return make_meshes.square(np.random.default_rng(1), side, per_side, count)


meshes = {"grid": grid, "irregular": irregular}


def settled(options, folder, kind, edge, start):
    """Places [m] of the 61 x 61 points at rest, and what run.json says."""
    side = options.side / 1000
    radius = 0.3 * side
    points, faces = meshes[kind](side, edge / 1000)
    (folder / "sheet.obj").write_text("".join(f"v {x:.9f} 0 {z:.9f}\n" for x, z in points)
                                      + "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces))
    push = 1e-4 * start
    (folder / "s.toml").write_text(f"""
[simulation]
duration = "{options.duration} s"
time_step = "10 ms"
tolerance = 1e-4
frame_rate = 0
stop_when_settled = true
settle_speed = "2 mm/s"
[[cloth]]
mesh = "sheet.obj"
translate = [{push}, {radius + 0.004}, {-0.6 * push}]
model = "{options.model}"
{'viscosity = { bend = "20 ms" }' if options.model == "woven" else 'damping = "0.01 N.s/m"'}
area_density = 0.15
stretch = 500
bend = "10 uN.m"
[[obstacle]]
shape = "sphere"
centre = [0, 0, 0]
radius = {radius}
friction = 0.3
margin = "2 mm"
""")
    out = folder / "out"
    subprocess.run([options.program, "simulate", str(folder / "s.toml"), "--out", str(out), "--quiet", "--frames", "none"], check=True,
                   stderr=subprocess.DEVNULL)
    rest = np.array([line.split()[1:4] for line in (out / "sheet.obj").read_text().splitlines() if line.startswith("v ")], float)
    line = np.linspace(-side / 2, side / 2, 61) * (1 - 1e-9)
    return LinearNDInterpolator(points, rest)(*np.meshgrid(line, line, indexing="ij")), json.loads((out / "run.json").read_text())


def turned(shape):
    """The shape x(p) under the eight symmetries T of the square, T x(T^-1 p): of the fabric's points p and of the space together."""
    half = len(shape) // 2
    p = np.stack(np.meshgrid(*2 * [np.arange(-half, half + 1)], indexing="ij"), -1)
    for swap, a, b in itertools.product((False, True), (1, -1), (1, -1)):
        T = np.array([[0, a], [b, 0]] if swap else [[a, 0], [0, b]])
        from_point = p @ T + half  # T^-1 = T^t
        moved = shape[from_point[..., 0], from_point[..., 1]].copy()
        moved[..., [0, 2]] = moved[..., [0, 2]] @ T.T
        yield moved


def apart(a, b):
    rms = lambda c: np.sqrt(np.nanmean(((a - c) ** 2).sum(-1)))
    return rms(b), min(rms(c) for c in turned(b))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(root / "build/release/drape"))
    parser.add_argument("--edges", default="15,10")
    parser.add_argument("--model", default="woven")
    parser.add_argument("--side", type=float, default=300)
    parser.add_argument("--starts", type=int, default=2)
    parser.add_argument("--duration", type=float, default=6)
    options = parser.parse_args()
    shapes = {}
    print("| mesh | edge [mm] | start | state | fastest vertex [mm/s] | area kept [%] |\n| --- | --- | --- | --- | --- | --- |")
    for edge, kind, start in itertools.product([float(e) for e in options.edges.split(",")], meshes, range(options.starts)):
        with tempfile.TemporaryDirectory() as folder:
            shape, run = settled(options, pathlib.Path(folder), kind, edge, start)
        shapes[f"{kind} {edge:g}, {start + 1}"] = shape
        print(f"| {kind} | {edge:g} | {start + 1} | {run['state']} | {1000 * run['max_speed']:.1f} | {100 * run['area_kept']:.1f} |", flush=True)
    print("\n| pair | RMS as it lies [mm] | RMS, best of the symmetries [mm] |\n| --- | --- | --- |")
    patterns = []
    for name, shape in shapes.items():
        if not any(apart(first, shape)[1] < one_pattern for first in patterns):
            patterns.append(shape)
    for one, two in itertools.combinations(shapes, 2):
        here, best = apart(shapes[one], shapes[two])
        print(f"| {one} / {two} | {1000 * here:.1f} | {1000 * best:.1f} |")
    print(f"\n{len(patterns)} patterns of folds among {len(shapes)} sheets")


if __name__ == "__main__":
    main()
