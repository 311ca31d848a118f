"""A step by hand: the same bits as C++, laws of mechanics, linear systems to take out."""

import itertools
import multiprocessing
import os
import subprocess
import threading
import time
import unittest

import numpy as np
from workshop import falling_sheet, in_another_thread, refusal, steps_until_over

import drape


class Step(unittest.TestCase):
    def test_the_same_bits_as_in_c_plus_plus(self):
        program = os.environ.get("DRAPE_SINGLE_STEP")
        if not program:
            self.skipTest("DRAPE_SINGLE_STEP does not name the C++ program to compare with")
        expected = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
        for name, hash_after in zip(expected[0::2], expected[1::2]):
            with self.subTest(name):
                system, constraints, state = falling_sheet(height=0.3021)
                state.x[:, 1] += 0.05 * state.x[:, 0] * state.x[:, 2]
                stepper = drape.make_integrator(name, system, constraints, "mpcg")
                for _ in range(12):
                    report = stepper.advance(state, 5e-4)
                self.assertEqual(state.hash, hash_after)
                self.assertGreater(report.contacts, 0)
        self.assertEqual(len(set(expected[1::2])), 3)

    def test_a_woven_sheet_hangs_as_stiff_as_it_was_said_to_be(self):
        sheet = drape.grid(3, 11, 0.1, 1)  # hung by an edge, it is longer by density g L^2 / (2 Y)
        fabric = drape.Fabric(area_density=0.2, stretch=300, stretch_weft=80, shear=20, poisson=0)
        self.assertEqual(fabric.stretch_weft, 80)
        self.assertIsNone(drape.Fabric().shear)
        for warp, stiffness in (([0, 0, 1], 300), ([1, 0, 0], 80)):
            system = drape.System(drape.masses(sheet, fabric))
            system.add(drape.woven(sheet, fabric, warp))
            system.add(drape.gravity([0, 0, 9.81]))
            constraints = drape.Constraints()
            constraints.pin([0, 1, 2])
            state = drape.at_rest(sheet)
            stepper = drape.ImplicitEuler(system, constraints)
            for _ in range(400):
                stepper.advance(state, 0.05)
            longer = state.x[:, 2].max() - sheet.positions[:, 2].max()
            self.assertAlmostEqual(longer / (0.2 * 9.81 / (2 * stiffness)), 1, delta=2e-3)
        with self.assertRaisesRegex(ValueError, "direction"):
            drape.woven(sheet, fabric)
        with self.assertRaisesRegex(ValueError, "poisson = 2"):
            drape.Fabric(poisson=2)

    def test_a_woven_fold_rests_as_its_mesh_or_flat(self):
        fold = drape.parse_obj("v 0 0 0\nv 0 0 1\nv 1 0.5 0\nv -1 0.5 1\nf 1 2 3\nf 2 1 4\n")
        state = drape.at_rest(fold)
        for bending, rest_angle in itertools.product(("plate", "hinges"), (0, 0.5, 1)):
            fabric = drape.Fabric(bend=1, rest_angle=rest_angle, bending=bending)
            self.assertEqual(fabric.rest_angle, rest_angle)
            self.assertEqual(fabric.bending, bending)
            system = drape.System(drape.masses(fold, fabric))
            system.add(drape.woven(fold, fabric))
            system.add(drape.gravity([0, 0, 0]))
            energy = system.elastic_energy(state)
            if rest_angle == 0:
                flat = energy
                self.assertGreater(flat, 0.1)
            self.assertAlmostEqual(energy / flat, (1 - rest_angle) ** 2, delta=1e-12)
        with self.assertRaisesRegex(ValueError, "rest_angle = 2"):
            drape.Fabric(rest_angle=2)
        with self.assertRaisesRegex(ValueError, "quadratic hinges rest flat"):
            drape.Fabric(rest_angle=1, bending="quadratic-hinges")
        with self.assertRaisesRegex(ValueError, "bending: there is no 'hinge'"):
            drape.Fabric(bending="hinge")

    def test_a_woven_sheet_whose_threads_rub_stays_higher(self):
        sheet = drape.grid(13, 5, 0.06, 0.02)

        def droop(friction, onset=0.5):
            fabric = drape.Fabric(area_density=0.15, bend=1e-4, bend_time=0.05, bend_friction=friction,
                                  bend_friction_onset=onset)
            self.assertEqual(fabric.bend_friction, friction)
            system = drape.System(drape.masses(sheet, fabric))
            system.add(drape.woven(sheet, fabric))
            system.add(drape.gravity([0, -9.81, 0]))
            self.assertEqual("bend friction" in system.forces, friction > 0)
            state, held = drape.at_rest(sheet), drape.Constraints()
            held.pin([i for i in range(65) if i % 13 < 2])
            stepper = drape.ImplicitEuler(system, held)
            for _ in range(40):
                self.assertTrue(stepper.advance(state, 0.03).done)
            return -state.x[:, 1].min()

        self.assertLess(droop(5e-4), 0.9 * droop(0))
        self.assertEqual(drape.Fabric().bend_friction_onset, 50)
        self.assertLess(droop(5e-4), 0.95 * droop(5e-4, 50))
        with self.assertRaisesRegex(ValueError, "bend_friction_onset = 0"):
            drape.Fabric(bend_friction_onset=0)
        self.assertIn("bend_friction=0.0005 N", repr(drape.Fabric(bend_friction=5e-4)))
        with self.assertRaisesRegex(ValueError, "bend_friction = -1"):
            drape.Fabric(bend_friction=-1)

    def test_a_sheet_in_the_air_comes_to_its_terminal_velocity(self):
        sheet, fabric = drape.grid(4, 4, 0.1, 0.1), drape.Fabric(area_density=0.2)
        system = drape.System(drape.masses(sheet, fabric))
        system.add(drape.woven(sheet, fabric))
        system.add(drape.gravity([0, -9.81, 0]))
        system.add(drape.air_drag(sheet, wind=[0, 1, 0], density=1.2, drag=1.2))
        self.assertIn("air", system.forces)
        state = drape.at_rest(sheet)
        stepper = drape.ImplicitEuler(system, drape.Constraints())
        for _ in range(60):
            stepper.advance(state, 0.02)
        terminal = np.sqrt(2 * 0.2 * 9.81 / (1.2 * 1.2)) - 1
        self.assertAlmostEqual(-state.v[:, 1].mean() / terminal, 1, delta=1e-2)
        with self.assertRaisesRegex(ValueError, "drag = -1"):
            drape.air_drag(sheet, drag=-1)

    def test_free_fall(self):
        sheet = drape.grid(5, 5, 1, 1)
        fabric = drape.Fabric()
        system = drape.System(drape.masses(sheet, fabric))
        system.add(drape.noh_jung(sheet, fabric))
        system.add(drape.gravity([0, -9.81, 0]))
        state = drape.at_rest(sheet)
        report = drape.ImplicitEuler(system, drape.Constraints()).advance(state, 0.01)
        np.testing.assert_allclose(state.x[:, 1], -9.81 * 0.01**2, rtol=1e-9)
        self.assertTrue(report.done and report.converged)
        self.assertEqual(report.contacts, 0)
        self.assertIn("linear iteration", repr(report))
        self.assertAlmostEqual(system.masses.sum(), 0.15)
        np.testing.assert_allclose(system.force(state).sum(axis=0), [0, -9.81 * 0.15, 0], atol=1e-9)

    def test_pins_hold_and_others_do_not(self):
        system, constraints, state = falling_sheet(7, height=3)
        constraints.pin([0, 6])
        before = state.x.copy()
        stepper = drape.Bdf2(system, constraints, "cholmod" if "cholmod" in drape.linear_solvers() else "mpcg")
        for _ in range(5):
            stepper.advance(state, 0.01)
        moved = np.linalg.norm(state.x - before, axis=1)
        np.testing.assert_array_equal(moved[[0, 6]], 0)
        self.assertGreater(moved.max(), 0.005)
        np.testing.assert_array_equal(constraints.pinned, [0, 6])

    def test_each_plane_of_a_corner_tells_its_own_impulse(self):
        system = drape.System([1.0])
        system.add(drape.gravity([-1, -9.81, -2]))
        constraints = drape.Constraints()
        for normal in np.eye(3):
            constraints.add(drape.Obstacle(drape.Plane([0, 0, 0], normal), friction=0.0, margin=0.0))
        integrator = drape.ImplicitEuler(system, constraints, "eigen-ldlt")
        state = drape.State([[0.01, 0.05, 0.01]])
        for _ in range(60):
            integrator.advance(state, 0.01)
        told = sorted((contact.body, contact.impulse / 0.01) for contact in constraints.contacts)
        self.assertEqual([body for body, _ in told], [0, 1, 2])
        np.testing.assert_allclose([force for _, force in told], [1, 9.81, 2], rtol=1e-6)

    def test_contacts_are_told(self):
        system, constraints, state = falling_sheet()
        stepper = drape.ImplicitEuler(system, constraints)
        while not constraints.contacts:
            report = stepper.advance(state, 0.01)
        self.assertEqual(len(constraints.contacts), report.contacts)
        contact = constraints.contacts[0]
        distance, normal = drape.closest(drape.Sphere([0, 0, 0], 0.3), state.x[[contact.particle]])
        np.testing.assert_allclose(contact.normal, normal[0], atol=1e-3)
        self.assertAlmostEqual(distance[0], 2e-3, places=4)
        self.assertEqual(constraints.penetration(state).max(), 0)

    def test_what_is_written_into_a_state_counts(self):
        system, constraints, state = falling_sheet(5, height=9)
        stepper = drape.ImplicitEuler(system, constraints)
        stepper.advance(state, 0.01)
        state.v[:] = [3, 0, 0]
        x = state.x.copy()
        stepper.advance(state, 0.01)
        np.testing.assert_allclose((state.x - x)[:, 0], 0.03, rtol=1e-6)

    def test_a_failed_step_raises_and_leaves_the_state(self):
        system, constraints, state = falling_sheet(5)
        state.v[3] = 1e300
        before = state.x.copy()
        with self.assertRaises(drape.StepError) as caught:
            drape.ImplicitEuler(system, constraints).advance(state, 0.01)
        self.assertIsInstance(caught.exception, RuntimeError)
        self.assertFalse(caught.exception.report.done)
        self.assertIn(caught.exception.report.failure, str(caught.exception))
        np.testing.assert_array_equal(state.x, before)
        self.assertEqual(state.time, 0)

    def test_an_integrator_keeps_what_it_needs(self):
        stepper, state = (lambda s, c, x: (drape.ImplicitEuler(s, c), x))(*falling_sheet())
        _ = [np.full(3000, np.nan) for _ in range(50)]
        stepper.advance(state, 0.01)
        self.assertEqual(stepper.system.particles, 121)
        self.assertEqual(stepper.constraints.bodies, 1)

    def test_none_is_no_system_and_no_constraints(self):
        system, constraints, _ = falling_sheet(5)
        for make in (drape.ImplicitEuler, drape.Bdf2, lambda *given: drape.make_integrator("bdf2", *given)):
            for given in ((None, constraints), (system, None), (None, None)):
                with self.subTest(make=make, given=given), self.assertRaises(TypeError):
                    make(*given)
        with self.assertRaises(TypeError):
            drape._drape.Run(None, None, "none")

    def test_one_particle_is_any_integer(self):
        for one in (3, np.int64(3), np.uint8(3), np.array(3)):
            with self.subTest(type(one)):
                constraints = drape.Constraints()
                constraints.pin(one)
                np.testing.assert_array_equal(constraints.pinned, [3])
        for wrong in (3.0, True, np.bool_(True), np.float64(3), np.array(3.0), None, "3", [[3]], np.int64(-1)):
            with self.subTest(wrong=wrong), self.assertRaisesRegex(ValueError, "^particles: "):
                drape.Constraints().pin(wrong)

    def test_friction_is_any_number_or_a_pair(self):
        for friction in (1, np.int64(1), np.float32(1), np.array(1.0), (1, 1)):
            with self.subTest(type(friction)):
                self.assertEqual(drape.Obstacle(drape.Plane(), friction).friction, (1, 1))
        for wrong in (None, "1", [1], [1, 1, 1], 10**400):
            with self.subTest(wrong=wrong), self.assertRaisesRegex(ValueError, "^friction: "):
                drape.Obstacle(drape.Plane(), wrong)

    def test_soft_bodies(self):
        lattice = drape.box_lattice([4, 4, 4], [0.1, 0.1, 0.1])
        material = drape.SoftMaterial(young=2e4, density=300)
        system = drape.System(drape.masses(lattice, material))
        system.add(drape.soft_body(lattice, material))
        self.assertAlmostEqual(system.masses.sum(), 300 * 0.3**3)
        state = drape.State(lattice.positions * 1.01)
        self.assertGreater(system.elastic_energy(state), 0)
        drape.ImplicitEuler(system, drape.Constraints()).advance(state, 0.001)


class LinearSystems(unittest.TestCase):
    def recorded(self):
        system, constraints, state = falling_sheet(9)
        constraints.pin(0)
        stepper = drape.ImplicitEuler(system, constraints)
        for _ in range(4):
            stepper.advance(state, 0.01)
        self.assertIsNone(stepper.last_system)
        stepper.record_systems = True
        stepper.advance(state, 0.01)
        return stepper.last_system

    def test_every_solver_solves_it(self):
        system = self.recorded()
        reference = None
        for name in drape.linear_solvers():
            with self.subTest(name):
                report = drape.make_linear_solver(name).solve(system, tolerance=1e-9)
                self.assertTrue(report.converged, report)
                self.assertLess(system.residual(report.solution), 2e-9)
                reference = report.solution if reference is None else reference
                np.testing.assert_allclose(report.solution, reference, atol=1e-6)
                if len(report.history):
                    self.assertLessEqual(report.history[-1], 1e-9)
                    self.assertGreater(report.history[0], report.history[-1])
                    self.assertEqual(len(report.history), report.iterations + 1)

    def in_contact(self):
        """Of a step in which two particles are pinned and others slide on a ball."""
        system, constraints, state = falling_sheet(15)
        constraints.pin([0, 14])
        stepper = drape.ImplicitEuler(system, constraints, "eigen-ldlt")
        stepper.record_systems = True
        for _ in range(30):
            stepper.advance(state, 0.01)
        S, _ = stepper.last_system.filter
        locked = np.count_nonzero(np.abs(S).max(axis=(1, 2)) == 0)
        free = np.count_nonzero((S == np.eye(3)).all(axis=(1, 2)))
        self.assertGreaterEqual(locked, 2)
        self.assertLess(locked + free, system.particles)  # the others slide
        return stepper.last_system

    def test_a_pin_that_begins_in_mid_run_goes_on_from_where_the_particle_is(self):
        for start in (0.0, 0.5):
            mesh = drape.grid(3, 3, 0.2, 0.2)
            fabric = drape.Fabric(area_density=0.2, stretch=100.0, bend=1e-5)
            system = drape.System(drape.masses(mesh, fabric))
            system.add(drape.noh_jung(mesh, fabric))
            constraints = drape.Constraints()
            state = drape.State(mesh.positions)
            state.time = start
            constraints.pin_along([0], drape.Motion.constant([1, 0, 0]), state)
            before = state.x[0].copy()
            drape.ImplicitEuler(system, constraints, "mpcg").advance(state, 0.01)
            np.testing.assert_allclose(state.x[0] - before, [0.01, 0, 0], atol=1e-12)

    def test_the_filter_is_what_pins_and_contacts_allow(self):
        system = self.in_contact()
        S, z = system.filter
        self.assertEqual(S.shape, (225, 3, 3))
        np.testing.assert_allclose(S, S.transpose(0, 2, 1), atol=1e-15)
        np.testing.assert_allclose(S @ S, S, atol=1e-14)  # projections
        np.testing.assert_array_equal(S[[0, 14]], 0)
        self.assertGreater(np.abs(z).max(), 0)
        locked = system.solution - np.einsum("ijk,ik->ij", S, system.solution)
        np.testing.assert_allclose(locked, z, atol=1e-15)
        self.assertEqual(system.constrained, np.count_nonzero((S != np.eye(3)).any(axis=(1, 2))))

    def test_the_projected_system_is_what_its_formula_says(self):
        system = self.in_contact()
        n = system.particles
        blocks, z = system.filter
        S = np.zeros((3 * n, 3 * n))
        for i in range(n):
            S[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = blocks[i]
        A, b = self.dense(*system.bsr()), system.b.ravel()
        (data, indices, indptr), right, back = system.projected()
        projected = np.zeros_like(A)
        for column in range(3 * n):
            part = slice(indptr[column], indptr[column + 1])
            self.assertTrue((np.diff(indices[part]) > 0).all())
            projected[indices[part], column] = data[part]
        scale = np.abs(A).max()
        np.testing.assert_allclose(projected, S @ A @ S + np.eye(3 * n) - S, atol=1e-14 * scale)
        np.testing.assert_array_equal(projected, projected.T)
        np.testing.assert_allclose(right, S @ (b - A @ z.ravel()), atol=1e-14 * np.abs(b).max())
        y = np.linspace(-1, 1, 3 * n)
        np.testing.assert_allclose(back(y).ravel(), S @ y + z.ravel(), atol=1e-14)
        np.testing.assert_array_equal(back(y), back(y.reshape(n, 3)))
        for wrong in (y[1:], np.zeros((n + 1, 3)), None, "y", [[1], [2, 3]]):
            with self.assertRaisesRegex(ValueError, "^y: expected "):
                back(wrong)

    def test_scipy_solves_a_step_with_pins_and_contacts(self):
        try:
            from scipy import sparse
            from scipy.sparse.linalg import cg, spsolve
        except ImportError:
            self.skipTest("scipy is not installed (Debian package python3-scipy)")
        system = self.in_contact()
        A, b, back = system.projected()
        A = sparse.csc_matrix(A)
        for y in (spsolve(A, b), cg(A, b, tol=1e-13, atol=0)[0]):
            dv = back(y)
            np.testing.assert_allclose(dv, system.solution, atol=1e-8)
            self.assertLess(system.constraint_violation(dv), 1e-15)
            self.assertLess(system.residual(dv), 1e-11)
        # Without the constraints it solves another system, and is told so.
        free = spsolve(sparse.bsr_matrix(system.bsr()).tocsc(), system.b.ravel()).reshape(-1, 3)
        self.assertGreater(np.abs(free - system.solution).max(), 0.01)
        self.assertGreater(system.constraint_violation(free), 0.01)
        self.assertGreater(system.residual(free), 0.01)

    def test_the_residual_is_of_both_equations(self):
        system = self.in_contact()
        S, z = system.filter
        self.assertLess(system.residual(system.solution), 1e-12)
        free = int(np.flatnonzero((S == np.eye(3)).all(axis=(1, 2)))[0])
        for particle in (0, free):  # a pinned one, and one that is free
            moved = system.solution.copy()
            moved[particle] += [0, 0.5, 0]
            self.assertEqual(system.constraint_violation(moved) > 0.4999, particle == 0)
            self.assertGreater(system.residual(moved), 1e-3)
        A, b = self.dense(*system.bsr()), system.b.ravel()
        moved = system.solution + np.linspace(-0.1, 0.1, 675).reshape(225, 3)
        first = np.einsum("ijk,ik->ij", S, (A @ moved.ravel() - b).reshape(225, 3))
        missed = moved - np.einsum("ijk,ik->ij", S, moved) - z
        own = np.stack([A[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] @ missed[i] for i in range(225)])
        own -= np.einsum("ijk,ik->ij", S, own)
        self.assertAlmostEqual(system.constraint_violation(moved), np.linalg.norm(missed, axis=1).max())
        ratio = system.residual(moved) / np.sqrt((first**2).sum() + (own**2).sum())
        only_first = moved - missed
        first = np.einsum("ijk,ik->ij", S, (A @ only_first.ravel() - b).reshape(225, 3))
        self.assertAlmostEqual(system.residual(only_first) / np.linalg.norm(first) / ratio, 1)
        for function in (system.residual, system.constraint_violation):
            with self.assertRaisesRegex(ValueError, r"^dv: expected an array of shape \(225, 3\)"):
                function(moved[1:])

    @staticmethod
    def dense(data, indices, indptr):
        n = len(indptr) - 1
        dense = np.zeros((n, 3, n, 3))
        for i in range(n):
            for k in range(indptr[i], indptr[i + 1]):
                dense[i, :, indices[k], :] = data[k]
        return dense.reshape(3 * n, 3 * n)

    def test_the_matrix_is_the_one_of_the_step(self):
        system = self.recorded()
        n = system.particles
        dense = self.dense(*system.bsr())
        np.testing.assert_allclose(dense, dense.T, atol=1e-12)
        self.assertGreater(np.linalg.eigvalsh(dense).min(), 0)
        self.assertGreater(system.constrained, 0)
        # Where a particle is free, A dv = b.
        residual = (dense @ system.solution.ravel() - system.b.ravel()).reshape(n, 3)
        free = np.sort(np.linalg.norm(residual, axis=1))[: n - system.constrained]
        self.assertLess(free.max(), 1e-4 * np.abs(system.b).max())


class Threads(unittest.TestCase):
    def test_other_threads_go_on_during_a_step(self):
        system, constraints, state = falling_sheet(61)
        stepper = drape.ImplicitEuler(system, constraints)
        counted, over = [0], threading.Event()

        def count():
            while not over.is_set():
                counted[0] += 1
                time.sleep(0)

        thread = threading.Thread(target=count)
        thread.start()
        during = []
        for _ in range(5):
            before = counted[0]
            stepper.advance(state, 0.01)
            during.append(counted[0] - before)
        over.set()
        thread.join()
        # With the lock held the thread would get a turn between steps at most.
        self.assertGreater(max(during), 20)

    def test_two_steps_of_one_state_at_once_are_refused(self):
        system, constraints, state = falling_sheet(61)
        steppers = [drape.ImplicitEuler(system, constraints) for _ in range(2)]
        refused, done = [], []

        def steps(stepper):
            for _ in range(10):
                try:
                    stepper.advance(state, 0.001)
                    done.append(1)
                except RuntimeError as error:
                    refused.append(str(error))

        threads = [threading.Thread(target=steps, args=(s,)) for s in steppers]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(len(refused) + len(done), 20)
        self.assertTrue(refused)
        self.assertIn("is under way", refused[0])
        self.assertTrue(np.isfinite(state.x).all())

    def test_what_a_step_replaces_is_not_read_meanwhile(self):
        system, constraints, state = falling_sheet(61)
        stepper = drape.ImplicitEuler(system, constraints)
        stepper.record_systems = True
        stepper.advance(state, 0.001)
        reads = {
            "last_system": lambda: stepper.last_system,
            "contacts": lambda: constraints.contacts,
            "penetration": lambda: constraints.penetration(state),
            "hash": lambda: state.hash,
            "copy": state.copy,
            "force": lambda: system.force(state),
        }

        for name, read in reads.items():
            steps = steps_until_over(lambda: stepper.advance(state, 0.001))
            with self.subTest(name), in_another_thread(steps) as thread:
                self.assertIn("is under way", refusal(read, thread))
            read()

    def test_a_forked_child_steps(self):
        def child(send):
            drape.set_threads(3)  # other threads than its parent has
            send.send(self.three_steps())

        before, here = drape.threads(), self.three_steps()
        drape.set_threads(2)
        self.three_steps()
        receive, send = multiprocessing.Pipe(duplex=False)
        process = multiprocessing.get_context("fork").Process(target=child, args=(send,))
        process.start()
        self.assertTrue(receive.poll(60), "the child does not answer")
        self.assertEqual(receive.recv(), here)
        process.join()
        drape.set_threads(before)

    def three_steps(self):
        system, constraints, state = falling_sheet(31)
        stepper = drape.ImplicitEuler(system, constraints, "mpcg+block-ic0")
        for _ in range(3):
            stepper.advance(state, 0.01)
        return state.hash

    def test_the_number_of_threads_changes_no_bit(self):
        before = drape.threads()
        hashes = set()
        for count in (1, 2, 3):
            drape.set_threads(count)
            self.assertEqual(drape.threads(), count)
            hashes.add(self.three_steps())
        drape.set_threads(before)
        self.assertEqual(len(hashes), 1)
        with self.assertRaisesRegex(ValueError, "0 is not a number of threads"):
            drape.set_threads(0)


if __name__ == "__main__":
    unittest.main()
