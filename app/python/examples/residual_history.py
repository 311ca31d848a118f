"""The linear system of one step, given to every linear solver: how the residual falls."""

import argparse
from pathlib import Path

import matplotlib.pyplot as plt

import drape

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("scene", type=Path, nargs="?", default=Path("data/scenes/sheet-on-ball.toml"))
parser.add_argument("--at", type=int, default=30, help="the step")
parser.add_argument("--tolerance", type=float, default=1e-8)
parser.add_argument("--out", type=Path, default=Path("out/python"))
words = parser.parse_args()
words.out.mkdir(parents=True, exist_ok=True)

simulation = drape.read_scene(words.scene)
for step in range(1, words.at + 1):
    simulation.record_systems = step == words.at
    simulation.advance()
system = simulation.last_system
assert system is not None, "this integrator solves no linear system"

figure, axes = plt.subplots(figsize=(8, 5))
for name in drape.linear_solvers():
    report = drape.make_linear_solver(name).solve(system, tolerance=words.tolerance)
    took = report.setup_ms + report.solve_ms
    print(f"{name:16} {report.iterations:5} iterations  residual {report.residual:.1e}  {took:8.2f} ms  {report.reason}")
    if len(report.history) > 1:  # a direct solver has none
        axes.semilogy(report.history, label=name)
axes.set(xlabel="iteration", ylabel="relative residual", title=f"{words.scene.stem}, step {words.at}: {system}")
axes.legend()
figure.savefig(words.out / "residuals.png", dpi=150)
print(f"wrote {words.out / 'residuals.png'}")
