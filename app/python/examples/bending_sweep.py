"""How far a strip that sticks out droops, for fabrics of growing bending stiffness: a table and a plot."""

import argparse
import csv
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import drape

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--values", type=int, default=7, help="how many stiffnesses")
parser.add_argument("--duration", type=float, default=2.0, help="s")
parser.add_argument("--out", type=Path, default=Path("out/python"))
words = parser.parse_args()
words.out.mkdir(parents=True, exist_ok=True)

LENGTH, WIDTH, NX, NZ = 0.12, 0.03, 25, 7  # m: a strip along x, held along its first centimetre
strip = drape.grid(NX, NZ, LENGTH, WIDTH)
drape.write_obj(words.out / "strip.obj", strip)
held = np.flatnonzero(strip.positions[:, 0] < -LENGTH / 2 + 0.0101).tolist()
scene = {
    "simulation": {"duration": words.duration, "time_step": "5 ms", "stop_when_settled": True},
    "cloth": [{"mesh": words.out / "strip.obj", "area_density": "150 g/m^2", "stretch": "500 N/m",
               "damping": "1e-4 N.s/m", "pins": [{"vertices": held}]}],
}

rows = []
for bend in np.geomspace(1e-6, 1e-3, words.values):  # N m
    simulation = drape.read_scene(scene, {"cloth.0.bend": bend})
    simulation.run(frames="none")
    rows.append((bend, -simulation.cloths[0].positions[:, 1].min()))
    print(f"{1e6 * rows[-1][0]:8.2f} uN.m  droops by {100 * rows[-1][1]:5.2f} cm")

with open(words.out / "droop.csv", "w", newline="") as file:
    csv.writer(file).writerows([("bend [N m]", "droop [m]"), *rows])
figure, axes = plt.subplots()
axes.semilogx(*np.transpose(rows), "o-")
axes.set(xlabel="bending rigidity [N m]", ylabel="droop of the tip [m]", title="A strip of 11 cm, 150 g/m²")
figure.savefig(words.out / "droop.png", dpi=150)
print(f"wrote {words.out / 'droop.csv'} and {words.out / 'droop.png'}")
