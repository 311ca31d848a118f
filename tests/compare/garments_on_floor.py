#!/usr/bin/env python3
"""Which share of its area a garment keeps that is dropped on the floor, with springs and woven.

    python3 garments_on_floor.py [--program build/release/drape] [--duration 1.5]

The tee, the vest (the tee without its sleeves) and the dress of data/meshes fall on a plane, as
`drape drop MESH --onto plane` lets them. Prints a table in Markdown: the area at the end over the area at rest, and the
smallest area of a triangle over its area at rest.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
armhole = 0.2  # m, from the middle of the tee


def vest(tee):
    """The text of an OBJ file without the faces that lie on the sleeves, and without the vertices that only they use."""
    lines = tee.splitlines()
    points = [[float(number) for number in line.split()[1:4]] for line in lines if line.startswith("v ")]
    faces = [[int(corner.split("/")[0]) - 1 for corner in line.split()[1:]] for line in lines if line.startswith("f ")]
    faces = [face for face in faces if sum(abs(points[k][0]) for k in face) / len(face) < armhole]
    used = {k: n for n, k in enumerate(sorted({k for face in faces for k in face}))}
    return "".join("v %.6f %.6f %.6f\n" % tuple(points[k]) for k in used) + "".join(
        "f " + " ".join(str(used[k] + 1) for k in face) + "\n" for face in faces)


def stop(what):
    print(f"error: {what}", file=sys.stderr)
    sys.exit(2)


def dropped(program, mesh, duration, model, folder):
    command = [program, "drop", mesh, "--onto", "plane", "--duration", str(duration), "--frames", "none", "--quiet",
               "--out", folder / "out", "--set", f"cloth.0.model={model}"]
    try:
        subprocess.run(command, check=True)
    except OSError as error:
        stop(f"cannot run {program}: {error.strerror}; build it by ./build.sh build, or name another with --program")
    except subprocess.CalledProcessError as error:
        stop(f"{program} drop ended with exit code {error.returncode}")
    return json.loads((folder / "out" / "run.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(root / "build/release/drape"), help="the program (build/release/drape)")
    parser.add_argument("--duration", type=float, default=1.5, help="how long a garment falls and lies [s] (1.5)")
    options = parser.parse_args()
    print("| garment | particles | `noh-jung`: area kept, of the worst triangle [%] | `woven` |\n| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        meshes = {garment: root / "data/meshes" / f"{garment}.obj" for garment in ("tee", "dress")}
        meshes["vest"] = folder / "vest.obj"
        meshes["vest"].write_text(vest(meshes["tee"].read_text()))
        for garment, mesh in meshes.items():
            runs = [dropped(options.program, mesh, options.duration, model, folder) for model in ("noh-jung", "woven")]
            cells = " | ".join(f"{100 * run['area_kept']:.1f}, {100 * run['area_min']:.1f}" for run in runs)
            print(f"| {garment} | {sum(cloth['particles'] for cloth in runs[0]['cloths'])} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
