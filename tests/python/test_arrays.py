"""Meshes and states as arrays: without copies where promised, with errors that name the shape."""

import copy
import pickle
import unittest

import numpy as np
from workshop import Workshop, falling_sheet

import drape


class Views(unittest.TestCase):
    def test_positions_are_the_mesh(self):
        mesh = drape.grid(4, 5, 1, 1)
        self.assertEqual((mesh.positions.shape, mesh.positions.dtype), ((20, 3), np.float64))
        self.assertEqual((mesh.triangles.shape, mesh.triangles.dtype), ((24, 3), np.int32))
        self.assertTrue(np.shares_memory(mesh.positions, mesh.positions))
        self.assertTrue(np.shares_memory(mesh.triangles, mesh.triangles))
        mesh.positions[7, 1] = 0.5
        self.assertEqual(drape.at_rest(mesh).x[7, 1], 0.5)

    def test_positions_are_finite(self):
        mesh = drape.grid(4, 5, 1, 1)
        before = mesh.positions.copy()
        with self.assertRaisesRegex(ValueError, "finite"):
            mesh.positions = np.where(before > 0.4, np.nan, before + 1)
        self.assertTrue(np.array_equal(mesh.positions, before))

    def test_vertex_numbers_cannot_be_written(self):
        triangles = drape.grid(4, 5, 1, 1).triangles
        with self.assertRaises(ValueError):
            triangles[0, 0] = 99
        with self.assertRaises(ValueError):
            triangles.setflags(write=True)

    def test_a_state_is_its_arrays(self):
        state = drape.State(np.zeros((3, 3)))
        x, v = state.x, state.v
        x[1] = [1, 2, 3]
        state.v = np.ones((3, 3))
        np.testing.assert_array_equal(state.x[1], [1, 2, 3])
        np.testing.assert_array_equal(v, np.ones((3, 3)))
        self.assertTrue(np.shares_memory(x, state.x) and np.shares_memory(v, state.v))
        self.assertFalse(np.shares_memory(x, v))

    def test_what_is_given_is_copied(self):
        given = np.zeros((3, 3))
        state = drape.State(given)
        given[0, 0] = 1
        self.assertEqual(state.x[0, 0], 0)

    def test_arrays_outlive_their_owner(self):
        x, expected = drape.at_rest(drape.grid(40, 40, 1, 1)).x, drape.grid(40, 40, 1, 1).positions.copy()
        del_positions = drape.grid(40, 40, 1, 1).positions
        _ = [np.full((1600, 3), np.nan) for _ in range(50)]  # takes memory that was freed
        np.testing.assert_array_equal(x, expected)
        np.testing.assert_array_equal(del_positions, expected)

    def test_every_integrator_leaves_the_arrays_where_they_are(self):
        for name in drape.integrators():
            with self.subTest(name):
                system, constraints, state = falling_sheet(5)
                x, v, at = state.x, state.v, state.x.ctypes.data
                stepper = drape.make_integrator(name, system, constraints)
                for _ in range(3):
                    stepper.advance(state, 1e-4)
                self.assertEqual(state.x.ctypes.data, at)
                np.testing.assert_array_equal(x, state.x)
                np.testing.assert_array_equal(v, state.v)
                self.assertTrue((v[:, 1] < 0).any())

    def test_vectors_are_read_only_copies(self):
        sphere = drape.Sphere(centre=[1, 2, 3], radius=1)
        with self.assertRaises(ValueError):
            sphere.centre[0] = 5
        box = drape.Box(rotation=[[0, -1, 0], [1, 0, 0], [0, 0, 1]])
        np.testing.assert_array_equal(box.rotation, [[0, -1, 0], [1, 0, 0], [0, 0, 1]])

    def test_shapes_are_made_of_their_members(self):
        plate = drape.Plate(radius=0.09, height=0.02, rim=0.005, axis=[0, 0, 2])
        self.assertEqual(repr(plate), "Plate(centre=(0, 0, 0) m, radius=0.09 m, height=0.02 m, rim=0.005 m, "
                                      "axis=(0, 0, 2))")
        distance, normal = drape.closest(plate, [[0.01, 0.02, 0.03], [0.2, 0, 0]])
        np.testing.assert_allclose(distance, [0.02, 0.11])
        np.testing.assert_allclose(normal, [[0, 0, 1], [1, 0, 0]], atol=1e-15)
        with self.assertRaisesRegex(ValueError, "rim must be"):
            drape.Plate(radius=0.09, height=0.02, rim=0.011)
        capsule = drape.Capsule([0, 0, 0], [1, 0, 0], 0.5)
        self.assertEqual((capsule.radius, list(capsule.b)), (0.5, [1, 0, 0]))
        with self.assertRaisesRegex(TypeError, "Capsule, Plate, MeshBody or LevelSetBody, but got a str"):
            drape.closest("plate", [[0, 0, 0]])


class Copies(unittest.TestCase):
    def state(self):
        numbers = np.random.default_rng(1)
        return drape.State(numbers.normal(size=(9, 3)), numbers.normal(size=(9, 3)), time=0.1 + 0.2)

    def test_to_the_last_bit(self):
        state = self.state()
        pickled = [lambda s, p=p: pickle.loads(pickle.dumps(s, p)) for p in range(pickle.HIGHEST_PROTOCOL + 1)]
        ways = [*pickled, copy.copy, copy.deepcopy, drape.State.copy]
        for way in ways:
            other = way(state)
            self.assertEqual(other.hash, state.hash)
            self.assertEqual(other.time, state.time)
            self.assertEqual(other.x.tobytes() + other.v.tobytes(), state.x.tobytes() + state.v.tobytes())
            other.x[0, 0] += 1
            self.assertNotEqual(other.hash, state.hash)

    def test_a_pickled_state_goes_on_as_the_first(self):
        system, constraints, state = falling_sheet()
        other = pickle.loads(pickle.dumps(state))
        for s in (state, other):
            drape.make_integrator("symplectic-euler", *falling_sheet()[:2]).advance(s, 1e-4)
        self.assertEqual(state.hash, other.hash)


class Refusals(Workshop):
    def refuses(self, text, call, *given, **named):
        with self.assertRaises(ValueError) as caught:
            call(*given, **named)
        self.assertIn(text, str(caught.exception))

    def test_shapes_and_kinds(self):
        sheet = drape.grid(3, 3, 1, 1)
        self.refuses("x: expected an array of shape (n, 3), but got (4, 2)", drape.State, np.zeros((4, 2)))
        self.refuses("x: expected an array of shape (n, 3), but got (6,)", drape.State, np.zeros(6))
        self.refuses("v: expected an array of shape (4, 3) as x has it, but got (2, 3)", drape.State, np.zeros((4, 3)),
                     np.zeros((2, 3)))
        self.refuses("x: expected numbers, but got an array of <U1", drape.State, [["a", "b", "c"]])
        self.refuses("x: expected numbers, but got an array of complex128", drape.State, np.zeros((4, 3), complex))
        self.refuses("x: expected an array of numbers, but got a NoneType", drape.State, None)
        self.refuses("triangles: expected integers, but got an array of float64", drape.TriangleMesh, np.zeros((3, 3)),
                     [[0.0, 1.0, 2.0]])
        self.refuses("triangles: an integer is out of range", drape.TriangleMesh, np.zeros((3, 3)), [[0, 1, 2**40]])
        self.refuses("triangle 1 names vertex 3, but there are 3", drape.TriangleMesh, np.eye(3), [[0, 1, 2], [0, 1, 3]])
        self.refuses("a coordinate is not a finite number", drape.TriangleMesh, np.full((3, 3), np.nan), [[0, 1, 2]])
        self.refuses("'hem' names vertex 7", drape.TriangleMesh, np.eye(3), [[0, 1, 2]], {"hem": [7]})
        self.refuses("positions: expected an array of shape (9, 3), but got (8, 3)", setattr, sheet, "positions",
                     np.zeros((8, 3)))
        self.refuses("a vector: expected an array of shape (3,), but got (2,)", drape.Sphere, [0, 0])
        self.refuses("masses: expected an array of shape (n,), but got (2, 2)", drape.System, np.eye(2))
        self.refuses("gravity: an acceleration is three finite numbers", drape.System([1]).add,
                     drape.gravity([0, np.nan, 0]))
        hollow = drape.sphere(1, 0.1)
        hollow.positions[5] = np.nan
        for body in (drape.MeshBody, drape.LevelSetBody):
            self.refuses("vertex 5 of the surface has no finite position", body, hollow)
        for voxel in (np.nan, -0.01, np.inf):
            self.refuses("voxel = ", drape.LevelSetBody, drape.sphere(1, 0.1), voxel)
        self.refuses("nx: expected 2 or more, but got 1", drape.grid, 1, 3, 1, 1)

    def test_what_no_particle_is(self):
        system, constraints, state = falling_sheet(5)
        self.refuses("state: 9 particles, but the system has 25",
                     drape.ImplicitEuler(system, constraints).advance, drape.State(np.zeros((9, 3))), 0.01)
        self.refuses("they name particle", system.add,
                     drape.noh_jung(drape.grid(5, 5, 1, 1), drape.Fabric(), first_particle=10))
        self.refuses("there is no particle -1", constraints.pin, -1)
        constraints.pin([3, 25])
        self.refuses("they pin particle 25, but the system has 25", drape.ImplicitEuler(system, constraints).advance,
                     state, 0.01)
        self.refuses("there is no body 1", constraints.pin_to_body, 0, 1, state)

    def test_forces_belong_to_one_system(self):
        sheet, fabric = drape.grid(3, 3, 1, 1), drape.Fabric()
        forces = drape.noh_jung(sheet, fabric)
        drape.System(drape.masses(sheet, fabric)).add(forces)
        self.refuses("they belong to a system already", drape.System(drape.masses(sheet, fabric)).add, forces)

    def test_what_is_a_copy_cannot_be_written(self):
        masses = drape.read_scene(self.folder / "scene.toml").masses
        with self.assertRaisesRegex(ValueError, "read-only"):
            masses[:] = 1

    def test_objs(self):
        path = self.folder / "bad.obj"
        path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
        self.refuses(f"{path}:4: ", drape.read_obj, path)
        said = self.program("check", path, code=2)
        with self.assertRaises(ValueError) as caught:
            drape.read_obj(path)
        self.assertEqual(said, f"error: {caught.exception}\n")
        self.refuses("<text>:4: ", drape.parse_obj, path.read_text())

    def test_an_obj_round_trip_keeps_what_was_there(self):
        text = "g hem\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nf 1/1 2/1 3/1 4/1\n"
        mesh = drape.parse_obj(text)
        self.assertEqual(mesh.triangle_count, 2)
        np.testing.assert_array_equal(mesh.groups["hem"], [0, 1, 2, 3])
        drape.write_obj(self.folder / "again.obj", mesh, mesh.positions + [0, 2, 0])
        written = (self.folder / "again.obj").read_text()
        self.assertIn("f 1/1 2/1 3/1 4/1", written)
        np.testing.assert_array_equal(drape.read_obj(self.folder / "again.obj").positions, mesh.positions + [0, 2, 0])


if __name__ == "__main__":
    unittest.main()
