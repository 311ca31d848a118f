"""Runs: callbacks, what ends them, and what is in the folder then."""

import csv
import gc
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
from workshop import Workshop

import drape

FILES = ["run.json", "sheet.obj", "sheet.pc2", "steps.csv"]


class Runs(Workshop):
    def simulation(self, duration=0.2):
        return drape.read_scene(self.folder / "scene.toml", {"simulation.duration": duration})

    def rows(self, out):
        with open(self.folder / out / "steps.csv", newline="") as file:
            return list(csv.DictReader(file))

    def complete(self, out):
        """The files of a run that ended early are whole; how many steps it has."""
        names = {p.name for p in (self.folder / out).iterdir()}
        self.assertTrue(set(FILES) <= names, names)
        self.assertFalse([n for n in names if "~" in n or n.endswith((".part", ".tmp"))], names)
        record = self.record(out)
        size = (self.folder / out / "sheet.pc2").stat().st_size
        frames = len(record["frame_times"])
        self.assertEqual(size, 32 + frames * 169 * 12)
        self.assertEqual(len(self.rows(out)), record["steps"])
        drape.read_obj(self.folder / out / "sheet.obj")
        return record


class Callbacks(Runs):
    def test_every_step_is_told(self):
        simulation, told = self.simulation(), []
        record = simulation.run(out=self.folder / "o", callback=told.append)
        rows = self.rows("o")
        self.assertEqual([s.step for s in told], list(range(1, 21)))
        self.assertEqual([int(r["step"]) for r in rows], list(range(1, 21)))
        for step, row in zip(told, rows):
            for key in ("time", "kinetic_energy", "elastic_energy", "max_speed", "residual"):
                self.assertTrue(math.isclose(getattr(step, key), float(row[key]), rel_tol=1e-3), key)  # as rounded there
            self.assertEqual(step.linear_iterations, int(row["linear_iterations"]))
        self.assertIsInstance(told[0], drape.StepReport)
        self.assertFalse(record.get("interrupted", False))

    def test_the_state_is_there_in_a_callback(self):
        simulation, heights = self.simulation(), []
        simulation.run(callback=lambda step: heights.append(simulation.state.x[:, 1].min()))
        self.assertEqual(len(heights), 20)
        self.assertLess(heights[-1], heights[0])

    def test_false_ends_the_run(self):
        simulation = self.simulation()
        simulation.run(out=self.folder / "o", callback=lambda step: step.step < 7)
        self.assertEqual(self.complete("o")["steps"], 7)
        self.assertEqual(simulation.time, 0.07)

    def test_what_is_false_and_what_is_not(self):
        for result, steps in ((False, 1), (np.bool_(False), 1), (np.False_, 1), (np.bool_(True), 20), (None, 20), (0, 20), ("", 20)):
            with self.subTest(result=result, kind=type(result)):
                self.assertEqual(self.simulation().run(callback=lambda step: result)["steps"], steps)

    def test_a_run_inside_a_run_is_refused_and_spoils_nothing(self):
        for out in (None, self.folder / "o"):
            for inner in (lambda s: s.run(), lambda s: s.view(), lambda s: s.advance(), lambda s: list(s)):
                simulation, refused = self.simulation(), []

                def nest(step):
                    with self.assertRaisesRegex(RuntimeError, "is under way"):
                        inner(simulation)
                    refused.append(step.step)

                record = simulation.run(out=out, callback=nest)
                self.assertEqual((len(refused), record["steps"], record["frame_times"][-1]), (20, 20, 0.2))
                self.assertEqual(self.complete(simulation.folder), record)

    def test_a_run_that_is_refused_leaves_the_one_before(self):
        self.addCleanup(setattr, tempfile, "tempdir", tempfile.tempdir)
        tempfile.tempdir = str(self.folder)
        simulation = self.simulation()
        simulation.run(0.1)
        folder = simulation.folder
        self.assertEqual(folder.parent, self.folder)
        with self.assertRaises(ValueError):
            simulation.run(duration=-1)
        with self.assertRaises(ValueError):
            simulation.run(frames="pc3")
        self.assertEqual(simulation.folder, folder)
        self.assertTrue((folder / "run.json").is_file())
        self.assertEqual(list(self.folder.glob("drape-*")), [folder])
        if drape.has_viewer():
            self.assertIn("<html", simulation.view().page)
        simulation.run(0.05)
        self.assertEqual(list(self.folder.glob("drape-*")), [simulation.folder])
        self.assertTrue((simulation.folder / "run.json").is_file())

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    def test_a_fork_leaves_the_folder_of_the_process_it_came_from(self):
        simulation = self.simulation()
        simulation.run(0.02)
        child = os.fork()
        if child == 0:
            try:
                del simulation
                gc.collect()
            finally:
                os._exit(0)
        os.waitpid(child, 0)
        self.assertTrue((simulation.folder / "run.json").is_file())

    def test_what_ended_a_run_comes_before_what_its_files_say_then(self):
        class Mine(Exception):
            pass

        simulation = self.simulation()

        def spoil(step):
            shutil.rmtree(self.folder / "o")
            (self.folder / "o").write_text("")
            raise Mine("because")

        with self.assertRaisesRegex(Mine, "because") as caught:
            simulation.run(out=self.folder / "o", callback=spoil)
        self.assertIsInstance(caught.exception.__context__, ValueError)
        self.assertIsNone(simulation.folder)
        simulation.advance()  # it is free again

    def test_a_state_that_is_no_number_any_more(self):
        simulation = self.simulation()

        def spoil(step):
            simulation.state.x[:] = np.nan

        with self.assertRaisesRegex(drape.StepError, "^step 2 "):
            simulation.run(out=self.folder / "o", callback=spoil)

    def test_an_exception_ends_the_run_cleanly_and_goes_on(self):
        class Mine(Exception):
            pass

        def fail(step):
            if step.step == 5:
                raise Mine("because")

        simulation = self.simulation()
        with self.assertRaisesRegex(Mine, "because"):
            simulation.run(out=self.folder / "o", callback=fail)
        record = self.complete("o")
        self.assertEqual(record["steps"], 5)
        self.assertEqual(record["state_hash"], simulation.state_hash)
        with self.assertRaisesRegex(ValueError, "would replace; run into another folder"):
            simulation.run(out=self.folder / "x" / ".." / "o")
        self.assertEqual(self.complete("o"), record)
        simulation.run(out=self.folder / "further")  # and it can go on
        self.assertEqual(self.complete("further")["steps"], 15)

    def test_a_callback_cannot_step(self):
        simulation = self.simulation()
        with self.assertRaisesRegex(RuntimeError, "around this callback"):
            simulation.run(callback=lambda step: simulation.advance())
        simulation.advance()

    def test_a_loop_left_early_lets_go(self):
        simulation = self.simulation()
        for step in simulation:
            if step.step == 3:
                break
        del step
        simulation.run()
        self.assertEqual(simulation.time, 0.2)

    def test_a_loop_left_open_does_not_bar_a_run(self):
        for leave in (lambda s: s.run(0.05), lambda s: s.advance(), lambda s: next(iter(s))):
            simulation = self.simulation()
            steps = iter(simulation)
            next(steps)
            leave(simulation)
            with self.assertRaisesRegex(RuntimeError, "another run of the simulation has begun"):
                next(steps)
            left = round((0.2 - simulation.time) / 0.01)
            self.assertEqual(len(list(simulation)), left)

    def test_a_run_that_cannot_be_is_refused(self):
        simulation = self.simulation()
        for duration in (1e300, 1e-9):
            with self.assertRaisesRegex(ValueError, "check the units"):
                simulation.run(duration)
        self.assertEqual(simulation.run(0)["steps"], 0)
        for time in (math.nan, -1.0):
            simulation.state.time = time
            with self.assertRaisesRegex(ValueError, "time of the state"):
                simulation.run()

    def test_what_would_change_nothing_is_refused(self):
        simulation = self.simulation()
        with self.assertRaisesRegex(AttributeError, "simulation.gravity"):
            simulation.gravity = (0, 0, 0)
        with self.assertRaisesRegex(ValueError, "out: expected the name of a folder"):
            simulation.run(out="")
        with self.assertRaisesRegex(TypeError, "callback: expected a function"):
            simulation.run(callback=3)
        self.assertEqual(simulation.time, 0)

    def test_a_step_that_fails(self):
        simulation = self.simulation()

        def spoil(step):
            if step.step == 4:
                simulation.state.v[7] = np.nan

        with self.assertRaises(drape.StepError) as caught:
            simulation.run(out=self.folder / "o", callback=spoil)
        self.assertIn("step 5 (from 0.04 s) failed: ", str(caught.exception))
        self.assertIn("worst at vertex 7 of sheet (at ", str(caught.exception))
        self.assertEqual(self.complete("o")["steps"], 4)
        self.assertEqual(self.record("o")["state"], "failed")

    def test_only_the_piece_that_cannot_be_kept_apart_stands_still(self):
        sheet = str(self.folder / "sheet.obj")
        fine = drape.grid(31, 31, 1, 1)
        drape.write_obj(self.folder / "fine.obj", fine)
        simulation = drape.read_scene({
            "simulation": {"duration": 0.15, "tolerance": 1e-4},
            "cloth": [{"mesh": str(self.folder / "fine.obj"), "name": "stretched", "self_contact": True,
                       "fabric": "cotton-poplin", "model": "noh-jung"},
                      {"mesh": sheet, "name": "far", "self_contact": True, "translate": [20, 0, 0]}],
            "obstacle": [{"shape": "plane", "point": [0, -30, 0]}]})
        simulation.cloths[0].positions[:] *= 5
        far, stood = simulation.cloths[1], []

        def look(step):
            stood.append(step.stood_still)
            self.assertFalse(step.stood_still > 0 and step.converged)
            self.assertAlmostEqual(far.velocities[:, 1].mean(), -9.81 * step.time, places=3)

        record = simulation.run(callback=look)
        self.assertEqual(set(stood), {0, 961})
        self.assertTrue([w for w in record["warnings"] if "left 961 particles of cloth where they were" in w])
        self.assertGreaterEqual(record["steps_not_converged"], sum(n > 0 for n in stood))

    def test_the_end_is_a_frame_that_crossings_are_counted_in(self):
        sheet = str(self.folder / "sheet.obj")
        for rate in (0, 25):
            simulation = drape.read_scene({
                "simulation": {"duration": 0.11, "frame_rate": rate, "gravity": [0, -98.1, 0]},
                "cloth": [{"mesh": sheet, "name": "above"},
                          {"mesh": sheet, "name": "below", "translate": [0.01, -0.5, 0.02], "pins": [
                              {"vertices": list(range(169))}], "rotate": {"axis": [1, 0, 0], "angle": "30 deg"}}]})
            record = simulation.run(out=self.folder / "o")
            crossings = record["crossings"]
            self.assertGreater(crossings["end"], 0)
            last = self.rows("o")[-1]["crossings"]
            self.assertEqual(int(last), crossings["end"])
            self.assertGreaterEqual(crossings["max"], crossings["end"])

    def test_a_folder_that_cannot_be(self):
        (self.folder / "file").write_text("")
        simulation = self.simulation()
        with self.assertRaisesRegex(ValueError, "cannot be made an output folder"):
            simulation.run(out=self.folder / "file")
        with self.assertRaisesRegex(ValueError, "frames: there is no 'pc3'; did you mean 'pc2'"):
            simulation.run(frames="pc3")
        with self.assertRaisesRegex(ValueError, "duration = -1 s"):
            simulation.run(-1)
        with self.assertRaisesRegex(ValueError, "time step = 0 s"):
            simulation.advance(0)
        simulation.run()

    def test_a_folder_stays_the_same_when_the_current_one_changes(self):
        before = os.getcwd()
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        try:
            os.chdir(self.folder)
            simulation = self.simulation()
            simulation.run(0.05, out="o", callback=lambda step: os.chdir(elsewhere))
            self.assertEqual(self.complete("o"), self.complete(simulation.folder))
            self.assertIn("<html", simulation.view().page)
            self.assertEqual(list(elsewhere.iterdir()), [])
        finally:
            os.chdir(before)

    def test_without_out_the_frames_are_gone_with_the_simulation(self):
        simulation = self.simulation()
        simulation.run()
        folder = simulation.folder
        self.assertTrue((folder / "sheet.pc2").is_file())
        del simulation
        self.assertFalse(folder.exists())

    def test_other_threads_go_on_during_a_run(self):
        simulation = self.simulation(1)
        counted, over = [0], threading.Event()

        def count():
            while not over.is_set():
                counted[0] += 1
                time.sleep(0)

        thread = threading.Thread(target=count)
        thread.start()
        simulation.run()
        over.set()
        thread.join()
        self.assertGreater(counted[0], 200)


# A sheet that is large enough for two threads.
LEFT_RUNNING = """
import threading, time, drape
drape.set_threads(2)
drape.write_obj("large.obj", drape.grid(61, 61, 1, 1))
simulation = drape.read_scene({"simulation": {"duration": 1000}, "cloth": [{"mesh": "large.obj", "pins": [{"vertices": [0]}]}]})
begun = threading.Event()
threading.Thread(target=simulation.run, kwargs={"callback": lambda step: begun.set()}, daemon=True).start()
begun.wait()
time.sleep(0.05)
"""

INTERRUPTED = """
import sys, drape
simulation = drape.read_scene("scene.toml", {"simulation.duration": 1000})
try:
    # One text with its end of line: an interrupt may come between any two writes.
    simulation.run(out="o", callback=lambda step: print(f"{step.step}\\n", end="", flush=True))
except KeyboardInterrupt:
    print("interrupted", simulation.state_hash, flush=True)
"""


class Interrupts(Runs):
    def test_ctrl_c(self):
        run = subprocess.Popen([sys.executable, "-c", INTERRUPTED], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        self.addCleanup(run.stdout.close)
        for line in run.stdout:
            if int(line) == 10:
                break
        run.send_signal(signal.SIGINT)
        said, steps = "", 10
        for line in run.stdout:
            if line.startswith("interrupted"):
                said = line
            else:
                steps = int(line)
        self.assertEqual(run.wait(), 0)
        self.assertTrue(said, "KeyboardInterrupt did not come")
        record = self.complete("o")
        self.assertLessEqual(steps, record["steps"])
        self.assertLess(record["steps"], 50_000)
        self.assertEqual(record["state_hash"], said.split()[1])

    def test_a_program_may_end_during_a_step(self):
        for _ in range(3):
            run = subprocess.run(
                [sys.executable, "-c", LEFT_RUNNING], cwd=self.folder, capture_output=True, text=True, timeout=60
            )
            self.assertEqual((run.returncode, run.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
