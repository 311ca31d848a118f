"""A sheet falls on a ball; its shape and its energies over time as a picture."""

import argparse
from pathlib import Path

import matplotlib.pyplot as plt

import drape

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--duration", type=float, default=1.5, help="s")
parser.add_argument("--side", type=int, default=41, help="vertices along a side")
parser.add_argument("--out", type=Path, default=Path("out/python"))
words = parser.parse_args()
words.out.mkdir(parents=True, exist_ok=True)

sheet = drape.grid(words.side, words.side, 1.0, 1.0)
sheet.positions[:, 1] = 0.32
drape.write_obj(words.out / "start.obj", sheet)
simulation = drape.read_scene(
    {
        "simulation": {"duration": words.duration},
        "cloth": [{"name": "sheet", "mesh": words.out / "start.obj", "fabric": "cotton-poplin"}],
        "obstacle": [{"shape": "sphere", "radius": "30 cm", "friction": 0.3}],
    }
)
steps = list(simulation)  # every step's report

x = simulation.cloths[0].positions
figure = plt.figure(figsize=(10, 4))
shape = figure.add_subplot(1, 2, 1, projection="3d")
shape.plot_trisurf(x[:, 0], x[:, 2], x[:, 1], triangles=sheet.triangles, color="lightsteelblue")
shape.set(xlabel="x [m]", ylabel="z [m]", zlabel="y [m]", title=f"after {simulation.time:g} s")
energies = figure.add_subplot(1, 2, 2)
for name in ("kinetic", "elastic", "gravity"):
    energies.plot([s.time for s in steps], [getattr(s, f"{name}_energy") for s in steps], label=name)
energies.set(xlabel="time [s]", ylabel="energy [J]")
energies.legend()
figure.savefig(words.out / "drape.png", dpi=150)
print(f"{len(steps)} steps, wrote {words.out / 'drape.png'}")
