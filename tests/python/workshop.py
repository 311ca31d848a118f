"""What the tests of the Python module share: a folder to work in, a scene, the program to compare with."""

import contextlib
import json
import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import drape

SOURCE = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("DRAPE_PROGRAM", str(SOURCE / "build/release/drape"))

SCENE_TOML = """
[simulation]
duration = "0.2 s"
gravity = [0, -9.81, 0]

[[cloth]]
name = "sheet"
mesh = "sheet.obj"
fabric = "cotton-poplin"
bend = "8 uN.m"

[[obstacle]]
shape = "sphere"
radius = 0.3
"""

# data/scenes/skirt-sewn.toml with seams that close after ten steps: particles become fewer then.
SEWN_QUICKLY = {"cloth.0.edge": "8 cm", "cloth.0.seams": [{"close": "0.05 s", "stiffness": 2000}]}


def scene_dict(folder):
    """The same as SCENE_TOML."""
    return {
        "simulation": {"duration": "0.2 s", "gravity": [0, -9.81, 0]},
        "cloth": [{"name": "sheet", "mesh": Path(folder) / "sheet.obj", "fabric": "cotton-poplin", "bend": "8 uN.m"}],
        "obstacle": [{"shape": "sphere", "radius": 0.3}],
    }


class Workshop(unittest.TestCase):
    """A folder with a sheet of 13 x 13 vertices just above a ball."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="drape-test-")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        sheet = drape.grid(13, 13, 1, 1)
        sheet.positions[:, 1] = 0.305
        drape.write_obj(self.folder / "sheet.obj", sheet)
        (self.folder / "scene.toml").write_text(SCENE_TOML)

    def program(self, *words, code=0):
        """Runs the drape program in the folder; what it wrote to stderr."""
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def record(self, out):
        return json.loads((self.folder / out / "run.json").read_text())


@contextlib.contextmanager
def in_another_thread(work):
    """work(over) in a thread; `over`, an Event, is set at the end of the block."""
    over = threading.Event()
    thread = threading.Thread(target=work, args=(over,))
    thread.start()
    try:
        yield thread
    finally:
        over.set()
        thread.join()


def steps_until_over(step, most=3000):
    """Work for in_another_thread: steps until the reader has seen enough, however long that takes on a busy machine.

    Without an end of its own a test whose read is never refused would not come to its failure: hence `most`.
    """

    def work(over):
        for _ in range(most):
            if over.is_set():
                return
            step()

    return work


def refusal(read, thread):
    """What the RuntimeError says that read() comes to, tried as long as the thread works; empty without one."""
    while thread.is_alive():
        try:
            read()
        except RuntimeError as error:
            return str(error)
        time.sleep(0)
    return ""


def falling_sheet(n=11, height=0.31):
    """System, constraints and state of a sheet that is about to fall on a ball."""
    sheet = drape.grid(n, n, 1.0, 1.0)
    sheet.positions[:, 1] = height
    fabric = drape.Fabric(area_density=0.15, stretch=500, bend=1e-5)
    system = drape.System(drape.masses(sheet, fabric))
    system.add(drape.noh_jung(sheet, fabric))
    system.add(drape.gravity([0, -9.81, 0]))
    constraints = drape.Constraints()
    constraints.add(drape.Obstacle(drape.Sphere([0, 0, 0], 0.3), friction=0.3))
    return system, constraints, drape.at_rest(sheet)
