"""The examples run as they stand, in small."""

import csv
import os
import subprocess
import sys
import unittest

from workshop import SOURCE, Workshop

import drape

EXAMPLES = SOURCE / "app/python/examples"
QUICK = {
    "single_step.py": [],
    "drape_and_plot.py": ["--duration", "0.3", "--side", "15"],
    "bending_sweep.py": ["--duration", "2", "--values", "3"],
    "residual_history.py": [str(SOURCE / "data/scenes/sheet-on-ball.toml"), "--at", "5"],
}


class Examples(Workshop):
    def run_example(self, name):
        words = [sys.executable, str(EXAMPLES / name), *QUICK[name]]
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "MPLBACKEND": "Agg"})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def picture(self, name):
        self.assertTrue((self.folder / "out/python" / name).read_bytes().startswith(b"\x89PNG"))

    def test_none_is_forgotten(self):
        self.assertEqual({p.name for p in EXAMPLES.glob("*.py")}, set(QUICK))

    def test_single_step(self):
        self.assertIn("StepReport(", self.run_example("single_step.py"))

    def test_drape_and_plot(self):
        self.assertIn("30 steps", self.run_example("drape_and_plot.py"))
        self.picture("drape.png")

    def test_bending_sweep(self):
        self.run_example("bending_sweep.py")
        self.picture("droop.png")
        with open(self.folder / "out/python/droop.csv", newline="") as file:
            droops = [float(row["droop [m]"]) for row in csv.DictReader(file)]
        self.assertEqual(len(droops), 3)
        self.assertEqual(droops, sorted(droops, reverse=True))  # the stiffer, the less

    def test_residual_history(self):
        said = self.run_example("residual_history.py")
        for solver in drape.linear_solvers():
            self.assertIn(solver, said)
        self.picture("residuals.png")


if __name__ == "__main__":
    unittest.main()
