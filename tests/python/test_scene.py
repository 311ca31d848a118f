"""Scenes from TOML and dicts: the same bits and the same files as the program's, the same errors."""

import collections
import os
import types
import unittest
from pathlib import Path

import numpy as np
from workshop import (SCENE_TOML, SEWN_QUICKLY, SOURCE, Workshop, in_another_thread, refusal, scene_dict,
                      steps_until_over)

import drape


class SameAsTheProgram(Workshop):
    def test_toml_dict_and_program_give_the_same_bits_and_files(self):
        self.program("simulate", "scene.toml", "--out", "program", "--quiet")
        toml = drape.read_scene(self.folder / "scene.toml")
        record = toml.run(out=self.folder / "toml")
        data = drape.read_scene(scene_dict(self.folder))
        data.run(out=self.folder / "dict")
        expected = self.record("program")
        self.assertEqual(record["state_hash"], expected["state_hash"])
        self.assertEqual(toml.state_hash, expected["state_hash"])
        self.assertEqual(data.state_hash, expected["state_hash"])
        self.assertEqual(record, self.record("toml"))
        for other in ("toml", "dict"):
            self.assertEqual(self.files(other), self.files("program"))
            self.assertEqual(set(self.record(other)), set(expected))
            for name in self.files("program"):
                if name not in ("run.json", "steps.csv"):  # these have times of the clock
                    self.assertEqual((self.folder / other / name).read_bytes(),
                                     (self.folder / "program" / name).read_bytes(), name)
        timed = {"wall_seconds", "ms_per_step", "phases_ms", "scene"}
        for key in set(expected) - timed:
            self.assertEqual(record[key], expected[key], key)

    def files(self, out):
        root = self.folder / out
        return sorted(str(p.relative_to(root)) for p in root.rglob("*") if p.is_file())

    def test_settings_are_those_of_the_command_line(self):
        self.program("simulate", "scene.toml", "--out", "o", "--quiet", "--set", "cloth.sheet.bend=40 uN.m",
                     "--set", "simulation.gravity=[1, -5, 0]", "--duration", "0.1", "--linear-solver", "ppcg")
        settings = {"cloth.sheet.bend": "40 uN.m", "simulation.gravity": np.array([1, -5, 0]),
                    "simulation.duration": 0.1, "simulation.linear_solver": "ppcg"}
        for scene in (self.folder / "scene.toml", scene_dict(self.folder)):
            simulation = drape.read_scene(scene, settings)
            record = simulation.run()
            self.assertEqual(record["state_hash"], self.record("o")["state_hash"])
            self.assertEqual(record["linear_solver"], "ppcg")

    def test_scenes_of_the_gallery(self):
        for name in ("noh-jung-200", "soft-sphere", "tablecloth-pull"):
            scene = SOURCE / "data/scenes" / f"{name}.toml"
            self.program("simulate", scene, "--out", name, "--quiet", "--frames", "none", "--duration", "0.03")
            simulation = drape.read_scene(scene, {"simulation.duration": 0.03})
            for _ in simulation:
                pass
            self.assertEqual(simulation.state_hash, self.record(name)["state_hash"], name)

    def test_every_linear_solver(self):
        for solver in drape.linear_solvers():
            self.program("simulate", "scene.toml", "--out", "o", "--quiet", "--linear-solver", solver)
            simulation = drape.read_scene(self.folder / "scene.toml", {"simulation.linear_solver": solver})
            simulation.run()
            self.assertEqual(simulation.state_hash, self.record("o")["state_hash"], solver)

    def test_parts_of_a_run_are_the_whole(self):
        whole = drape.read_scene(self.folder / "scene.toml")
        whole.run()
        parts = drape.read_scene(self.folder / "scene.toml")
        parts.run(0.05)
        parts.advance()
        self.assertEqual(parts.time, 0.06)
        steps = list(parts)
        self.assertEqual([s.step for s in steps], list(range(7, 21)))
        self.assertEqual((parts.time, parts.state_hash), (whole.time, whole.state_hash))
        self.assertEqual(list(parts), [])


    def test_any_mapping_is_a_dict(self):
        def frozen(value):
            if isinstance(value, dict):
                return types.MappingProxyType({key: frozen(member) for key, member in value.items()})
            return tuple(map(frozen, value)) if isinstance(value, list) else value

        hashes = set()
        for make in (dict, frozen, collections.ChainMap, collections.UserDict):
            scene = make(scene_dict(self.folder))
            simulation = drape.read_scene(scene, types.MappingProxyType({"simulation.duration": 0.03}))
            simulation.run()
            hashes.add(simulation.state_hash)
        self.assertEqual(len(hashes), 1)


class Folders(Workshop):
    def test_paths_of_a_dict_are_relative_to_the_current_folder_or_to_the_one_given(self):
        scene = scene_dict("")
        with self.assertRaisesRegex(ValueError, "sheet.obj: "):
            drape.read_scene(scene)
        drape.read_scene(scene, folder=self.folder)
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.folder)
        drape.read_scene(scene)


class Refusals(Workshop):
    def refused(self, scene, settings=None):
        with self.assertRaises(ValueError) as caught:
            drape.read_scene(scene, settings)
        return str(caught.exception)

    def test_a_file_gets_the_words_of_the_program(self):
        wrong = {
            "unknown.toml": SCENE_TOML.replace("bend", "bned"),
            "unit.toml": SCENE_TOML.replace("8 uN.m", "8 kg"),
            "negative.toml": SCENE_TOML.replace("8 uN.m", "-8 uN.m"),
            "fabric.toml": SCENE_TOML.replace("cotton-poplin", "cotton-popline"),
            "no.toml": "[cloth",
            "mesh.toml": SCENE_TOML.replace("sheet.obj", "shet.obj"),
        }
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.folder)
        for name, text in wrong.items():
            Path(name).write_text(text)
            said = self.program("simulate", name, "--out", "o", code=2)
            self.assertEqual(said, f"error: {self.refused(name)}\n")
        self.assertEqual(self.program("simulate", "none.toml", code=2), f"error: {self.refused('none.toml')}\n")

    def test_a_dict_says_where(self):
        scene = scene_dict(self.folder)
        scene["cloth"][0]["bend"] = "8 kg"
        self.assertTrue(self.refused(scene).startswith("scene['cloth'][0]['bend']: "), self.refused(scene))
        scene["cloth"][0]["bend"] = None
        self.assertIn("scene['cloth'][0]['bend']: expected a number, a text", self.refused(scene))
        scene = scene_dict(self.folder)
        scene["simulation"]["gravity"] = [0, -9.81]
        self.assertTrue(self.refused(scene).startswith("scene['simulation']['gravity']"), self.refused(scene))
        scene["cloth"].append(scene)
        self.assertIn("nested too deep", self.refused(scene))
        self.assertIn("a key is a text, but here is 3", self.refused({3: 4}))
        self.assertIn("the integer is out of range", self.refused({"simulation": {"threads": 2**70}}))

    def test_what_is_no_scene_at_all(self):
        for wrong, kind in ((3, "int"), (None, "NoneType"), ([], "list"), (1.5, "float")):
            with self.subTest(wrong), self.assertRaises(TypeError) as caught:
                drape.read_scene(wrong)
            self.assertEqual(str(caught.exception), f"scene: expected a path or a dict, but got a {kind}")
        for path in ("\ud800.toml", "a\0b.toml"):
            self.assertEqual(self.refused(path), f"scene: {path!r} cannot be a path")

    def test_texts_that_no_file_can_hold(self):
        scene = scene_dict(self.folder)
        scene["cloth"][0]["name"] = "a\udc80"
        self.assertEqual(self.refused(scene),
                         "scene['cloth'][0]['name']: 'a\\udc80' has a lone surrogate, which no file can hold")
        self.assertIn("lone surrogate", self.refused({"\ud800": 1}))
        self.assertIn("lone surrogate", self.refused(scene_dict(self.folder), {"cloth.0.name": "\ud800"}))
        self.refused(scene_dict(self.folder), {"\ud800": 1})

    def test_a_setting_says_which(self):
        scene = self.folder / "scene.toml"
        self.assertIn("settings['cloth.0.bend']: ", self.refused(scene, {"cloth.0.bend": "8 kg"}))
        self.assertIn("settings['cloth.7.bend']: there is no '7'", self.refused(scene, {"cloth.7.bend": 1}))

    def test_fabrics(self):
        self.assertIn("cotton-poplin", drape.fabric_names())
        named = drape.load_fabric("cotton-poplin")
        self.assertGreater(named.fabric.area_density, 0.05)
        self.assertTrue(named.source)
        twill = drape.load_fabric("polyester-twill")
        self.assertAlmostEqual(twill.measured_drape_coefficient, 0.223)
        self.assertIsNone(twill.measured_drape_nodes)
        self.assertIn("bend", twill.converted)
        self.assertIn("area_density", twill.measured)
        self.assertIn("shear=41 N/m, compression=0.1, bend_weft=6.1e-07 N m", repr(twill))
        self.assertNotIn("weft", repr(named))
        (self.folder / "mine.toml").write_text('area_density = 0.1\nbending_length = "2 cm"\n')
        self.assertAlmostEqual(drape.load_fabric(str(self.folder / "mine.toml")).fabric.bend, 9.80665 * 0.1 * 8e-6)
        with self.assertRaisesRegex(ValueError, "did you mean 'cotton-poplin'"):
            drape.load_fabric("cotton-popline")
        with self.assertRaisesRegex(ValueError, "bend"):
            drape.Fabric(bend=-1)
        with self.assertRaisesRegex(ValueError, "did you mean 'axial'"):
            drape.Fabric(damping_kind="axal")


class Cloths(Workshop):
    def test_a_cloth_is_a_view_of_the_state(self):
        simulation = drape.read_scene(self.folder / "scene.toml")
        (sheet,) = simulation.cloths
        self.assertEqual((sheet.name, sheet.soft, sheet.mesh.vertex_count), ("sheet", False, 169))
        self.assertTrue(np.shares_memory(sheet.positions, simulation.state.x))
        np.testing.assert_array_equal(sheet.positions, simulation.state.x[sheet.particles])
        before = simulation.state_hash
        sheet.velocities[:] = [0, 1, 0]
        self.assertNotEqual(simulation.state_hash, before)
        simulation.advance(0.01)
        self.assertGreater(sheet.positions[:, 1].min(), 0.305)

    def test_seams_that_close_leave_old_arrays_readable(self):
        simulation = drape.read_scene(SOURCE / "data/scenes/skirt-sewn.toml", SEWN_QUICKLY)
        old = simulation.state.x
        for step in simulation:
            if len(simulation.state.x) < len(old):
                break
        self.assertLess(len(simulation.state.x), len(old), "no seam has closed")
        _ = [np.full(old.shape, np.nan) for _ in range(20)]
        self.assertTrue(np.isfinite(old).all())
        (skirt,) = simulation.cloths
        self.assertEqual(len(skirt.positions), skirt.mesh.vertex_count)
        self.assertFalse(skirt.positions.flags.writeable)  # a copy
        simulation.advance()

    def test_what_a_step_replaces_is_not_read_meanwhile(self):
        open_long = {"cloth.0.edge": "8 cm", "cloth.0.seams": [{"close": "1 h", "stiffness": 2000}]}
        simulation = drape.read_scene(SOURCE / "data/scenes/skirt-sewn.toml", open_long)
        self.refused_during_steps(simulation, x=lambda: simulation.state.x, v=lambda: simulation.state.v)
        self.assertEqual(len(simulation.state.x), simulation.cloths[0].mesh.positions.shape[0], "a seam has closed")

    def test_what_is_copied_is_not_read_during_a_step(self):
        simulation = drape.read_scene(SOURCE / "data/scenes/skirt-sewn.toml", SEWN_QUICKLY)
        before = len(simulation.state.x)
        for _ in range(40):
            simulation.advance()
        self.assertLess(len(simulation.state.x), before, "no seam has closed")
        self.refused_during_steps(simulation)

    def refused_during_steps(self, simulation, **others):
        simulation.record_systems = True
        (skirt,) = simulation.cloths
        reads = {"positions": lambda: skirt.positions, "velocities": lambda: skirt.velocities,
                 "hash": lambda: simulation.state_hash, "masses": lambda: simulation.masses,
                 "last_system": lambda: simulation.last_system, **others}
        for name, read in reads.items():
            with self.subTest(name), in_another_thread(steps_until_over(simulation.advance)) as thread:
                self.assertIn("is under way", refusal(read, thread))
            read()

    def test_arrays_of_a_cloth_without_seams_can_be_read_during_a_step(self):
        simulation = drape.read_scene(self.folder / "scene.toml")
        (sheet,) = simulation.cloths

        def run(over):
            simulation.run(1, frames="none")

        with in_another_thread(run) as thread:
            self.assertEqual(refusal(lambda: (sheet.positions, simulation.state.x), thread), "")
        self.assertEqual(simulation.time, 1)


if __name__ == "__main__":
    unittest.main()
