#!/usr/bin/env python3
"""Draws the pictures of this folder from runs of the scenes: ./build.sh pictures does both.

    python3 make_pictures.py --scenes                 the scenes that are drawn, a line each
    python3 make_pictures.py RUNS [PICTURE ...]       RUNS/SCENE is the output folder of a run with --frames obj
    python3 make_pictures.py RUNS --into FOLDER ...   elsewhere than here

Orthographic, y up, one light, two samples a pixel each way. Needs numpy and Pillow (Debian: python3-numpy, python3-pil).
"""
import pathlib
import sys

import numpy as np
from PIL import Image

here = pathlib.Path(__file__).resolve().parent
cloth_colour, cloth_back, body_colour, mark_colour = (np.array(c, float) for c in (
    (70, 125, 220), (120, 165, 240), (205, 180, 150), (150, 95, 75)))
light = np.array([0.35, 0.60, 0.72]) / np.linalg.norm([0.35, 0.60, 0.72])
samples = 2

# Of each picture: panels (scene, frame; 0: the last shape), width and height of a panel, azimuth and elevation [deg]; fit: what must be
# within the panels, times zoom; follow: each panel is centred on what must be within it, or on the body; marked: the body has sectors, so that it is seen to turn.
pictures = {
    "poncho": dict(panels=[("poncho", 0)], size=(700, 640), view=(25, 12), fit="cloth", zoom=1.5),
    "tee": dict(panels=[("tee", 0)], size=(700, 640), view=(25, 8), fit="cloth", zoom=1.2),
    "noh-jung": dict(panels=[("noh-jung-200", 0), ("noh-jung-100", 0)], size=(480, 420), view=(25, 15)),
    "choi-ko": dict(panels=[("choi-ko-200", 0), ("choi-ko-100", 0)], size=(480, 420), view=(25, 15)),
    "poncho-sewn": dict(panels=[("poncho-sewn", k) for k in (1, 6, 13, 0)], size=(330, 400), view=(25, 14), fit="all"),
    "skirt-sewn": dict(panels=[("skirt-sewn", k) for k in (1, 6, 13, 0)], size=(330, 330), view=(25, 20), fit="cloth"),
    "soft": dict(panels=[("soft-sphere", 12), ("soft-sphere", 24), ("soft-bowl", 12), ("soft-bowl", 0)], size=(330, 330), view=(25, 18),
                 fit="cloth", follow=True),
    "net": dict(panels=[("net", k) for k in (1, 18, 25, 151)], size=(330, 330), view=(20, 12), marked=True),
    "rotating-ball": dict(panels=[("rotating-ball", k) for k in (76, 101, 114, 201)], size=(330, 300), view=(20, 8), marked=True),
    "tablecloth-pull": dict(panels=[("tablecloth-pull", k) for k in (50, 80, 90, 101)], size=(400, 270), view=(20, 12)),
    "dressed-turn": dict(panels=[("dressed-turn", k) for k in (1, 41, 59, 97)], size=(300, 520), view=(30, 8), fit="all", follow=True),
    "ls-ball": dict(panels=[("ls-ball-0", 14), ("ls-ball-09", 14), ("ls-ball-0", 20), ("ls-ball-09", 0)], size=(330, 330), view=(20, 12),
                    follow="body"),
}


def load(path):
    points, triangles = [], []
    for line in path.read_text().splitlines():
        word = line.split()
        if word[:1] == ["v"]:
            points.append([float(w) for w in word[1:4]])
        elif word[:1] == ["f"]:
            corner = [int(w.split("/")[0]) - 1 for w in word[1:]]
            triangles += [(corner[0], corner[k], corner[k + 1]) for k in range(1, len(corner) - 1)]
    return np.array(points), np.array(triangles)


def meshes(run, frame):
    """(is a cloth, points, triangles, points at first) of everything in a run at a frame; bodies that stand still have no frames."""
    bodies = sorted(p.stem for p in (run / "bodies").glob("*.obj"))
    cloths = sorted(p.stem for p in run.glob("*.obj"))
    for name in cloths + bodies:
        last = run / f"{name}.obj" if name in cloths else run / "bodies" / f"{name}.obj"
        at, first = (run / "frames" / f"{name}_{k:04d}.obj" for k in (frame, 1))
        points, triangles = load(at if frame and at.exists() else last)
        yield name in cloths, points, triangles, load(first)[0] if first.exists() else points


def rotation(azimuth, elevation):
    (ca, sa), (ce, se) = ((np.cos(a), np.sin(a)) for a in np.radians([azimuth, elevation]))
    return np.array([[1, 0, 0], [0, ce, -se], [0, se, ce]]) @ np.array([[ca, 0, sa], [0, 1, 0], [-sa, 0, ca]])


def corner_normals(points, triangles, is_cloth):
    """Smooth, but for corners of a body whose face leans away by more than 30 degrees: a box keeps its edges."""
    p = points[triangles]
    area = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    smooth = np.zeros_like(points)
    for k in range(3):
        np.add.at(smooth, triangles[:, k], area)
    flat = (area / np.maximum(np.linalg.norm(area, axis=1, keepdims=True), 1e-30))[:, None, :].repeat(3, 1)
    smooth = (smooth / np.maximum(np.linalg.norm(smooth, axis=1, keepdims=True), 1e-30))[triangles]
    return smooth if is_cloth else np.where(((flat * smooth).sum(2) < np.cos(np.radians(30)))[:, :, None], flat, smooth)


def draw(image, depth, points, triangles, colours, is_cloth):
    """points: x, y in pixels, z towards the eye; a colour for each triangle. A cloth has another one behind."""
    height, width = depth.shape
    normals = corner_normals(points * [1, -1, 1], triangles, is_cloth)
    for t, corners in enumerate(triangles):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = points[corners]
        x0, x1 = max(0, int(min(ax, bx, cx))), min(width - 1, int(max(ax, bx, cx)) + 1)
        y0, y1 = max(0, int(min(ay, by, cy))), min(height - 1, int(max(ay, by, cy)) + 1)
        twice = (by - cy) * (ax - cx) + (cx - bx) * (ay - cy)
        if x1 < x0 or y1 < y0 or abs(twice) < 1e-12:
            continue
        x, y = np.arange(x0, x1 + 1)[None, :], np.arange(y0, y1 + 1)[:, None]
        a = ((by - cy) * (x - cx) + (cx - bx) * (y - cy)) / twice
        b = ((cy - ay) * (x - cx) + (ax - cx) * (y - cy)) / twice
        c = 1 - a - b
        z, there = a * az + b * bz + c * cz, depth[y0:y1 + 1, x0:x1 + 1]
        seen = (a >= -1e-3) & (b >= -1e-3) & (c >= -1e-3) & (z > there)
        if not seen.any():
            continue
        there[seen] = z[seen]
        n = np.stack([a[seen], b[seen], c[seen]], 1) @ normals[t]
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-30)
        away = twice > 0  # in pixels y goes down
        shade = 0.3 + 0.7 * np.maximum(0, (-n if away else n) @ light)
        colour = cloth_back if away and is_cloth else colours[t]
        image[y0:y1 + 1, x0:x1 + 1][seen] = np.clip(shade[:, None] * colour, 0, 255)


def picture(runs, panels, size, view, fit="all", zoom=1.0, follow=None, marked=False):
    turn, (width, height) = rotation(*view), np.array(size) * samples
    scenes = [[(is_cloth, p @ turn.T, t, first) for is_cloth, p, t, first in meshes(runs / scene, k)] for scene, k in panels]

    def extent(of):  # lowest and highest x, y of each panel
        shown = [np.vstack([p[:, :2] for is_cloth, p, _, _ in s if of in ("all", "cloth" if is_cloth else "body")]) for s in scenes]
        return np.array([p.min(0) for p in shown]), np.array([p.max(0) for p in shown])

    low, high = extent(fit)
    centres = (low + high) / 2
    if follow == "body":
        centres = sum(extent("body")) / 2
    if not follow:
        low, high = low.min(0, keepdims=True), high.max(0, keepdims=True)
        centres = np.repeat((low + high) / 2, len(scenes), 0)
    reach = 2 * np.maximum(high - centres, centres - low).max(0) * zoom
    scale = 0.94 * min(width / reach[0], height / reach[1])
    image = np.full((height, width * len(scenes), 3), 255, np.uint8)
    for k, scene in enumerate(scenes):
        depth = np.full((height, width), -np.inf)
        for is_cloth, points, triangles, first in scene:
            pixels = np.c_[(points[:, :2] - centres[k]) * [scale, -scale] + [width / 2, height / 2], points[:, 2] * scale]
            colours = np.tile(cloth_colour if is_cloth else body_colour, (len(triangles), 1))
            if marked and not is_cloth:
                from_middle = (first - first.mean(0))[triangles].mean(1)
                sector = np.floor(np.arctan2(from_middle[:, 2], from_middle[:, 0]) / (np.pi / 4))
                colours[sector % 2 == 0] = mark_colour
            draw(image[:, k * width:(k + 1) * width], depth, pixels, triangles, colours, is_cloth)
    return Image.fromarray(image).resize((image.shape[1] // samples, height // samples), Image.LANCZOS)


def main():
    words = sys.argv[1:]
    if words == ["--scenes"]:
        print("\n".join(sorted({scene for p in pictures.values() for scene, _ in p["panels"]})))
        return
    into = here
    if "--into" in words:
        into = pathlib.Path(words.pop(words.index("--into") + 1))
        words.remove("--into")
    unknown = sorted(set(words[1:]) - set(pictures))
    if not words or unknown:
        raise SystemExit(__doc__ + (f"\nno such picture: {' '.join(unknown)}" if unknown else ""))
    for name in words[1:] or pictures:
        path = into / f"{name}.png"
        picture(pathlib.Path(words[0]), **pictures[name]).quantize(128, dither=Image.Dither.NONE).save(path, optimize=True)
        print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
