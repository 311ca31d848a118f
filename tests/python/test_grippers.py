"""Pins that are led, let go and taken again, and bodies that carry them, by hand."""

import unittest

import numpy as np
import drape


class Grippers(unittest.TestCase):
    def free_sheet(self):
        sheet, fabric = drape.grid(5, 5, 0.2, 0.2), drape.Fabric()
        system = drape.System(drape.masses(sheet, fabric))
        system.add(drape.noh_jung(sheet, fabric))
        return system, drape.Constraints(), drape.at_rest(sheet)

    def test_what_is_held_is_led_let_go_and_taken_again(self):
        system, constraints, state = self.free_sheet()
        corners = [0, 4]
        constraints.pin(corners)
        stepper = drape.ImplicitEuler(system, constraints, "mpcg")
        stepper.advance(state, 0.01)
        for velocity in ([0.0, 0.1, 0.0], [0.2, 0.0, 0.0]):
            start = state.x[corners].copy()
            constraints.unpin(corners)
            constraints.pin_along(corners, drape.Motion.constant(velocity, start=state.time), state)
            for _ in range(10):
                stepper.advance(state, 0.01)
            np.testing.assert_allclose(state.x[corners], start + 0.1 * np.array(velocity), atol=1e-12)
        constraints.unpin(4)
        np.testing.assert_array_equal(constraints.pinned, [0])
        constraints.unpin([0, 7])  # 7 is free already
        before = (system.masses[:, None] * state.v).sum(0)
        for _ in range(10):
            stepper.advance(state, 0.01)
        np.testing.assert_allclose((system.masses[:, None] * state.v).sum(0), before, atol=1e-6)  # nothing holds it

    def test_a_second_pin_of_a_particle_is_refused(self):
        _, constraints, state = self.free_sheet()
        still = drape.Motion()
        constraints.add(drape.Obstacle(drape.Sphere([0, -1, 0], 0.1)))
        constraints.pin_along(3, still, state)
        for again in (
            lambda: constraints.pin(3),
            lambda: constraints.pin_along([2, 3], still, state),
            lambda: constraints.pin_to_body(3, 0, state),
        ):
            with self.assertRaisesRegex(ValueError, r"particle 3 is pinned already; unpin\(\) it first"):
                again()
        constraints.pin([5])
        constraints.pin([5])  # again the same
        np.testing.assert_array_equal(constraints.pinned, [3, 5])

    def test_a_body_carries_from_where_it_is_at_the_time_of_the_state(self):
        way = np.array([0.5, 0, 0])
        for time in (0.0, 1.0, 0.0):  # the third one is another run by the same constraints
            with self.subTest(time=time):
                system, constraints, state = self.free_sheet()
                constraints.add(drape.Obstacle(drape.Sphere([0, 0, 0], 0.05), motion=drape.Motion.constant(way)))
                state.time = time
                state.x[0] = time * way  # the centre of the ball then
                self.assertAlmostEqual(constraints.penetration(state)[0], 0.05)
                constraints.pin_to_body(0, 0, state)
                drape.ImplicitEuler(system, constraints, "mpcg").advance(state, 0.01)
                np.testing.assert_allclose(state.x[0], (time + 0.01) * way, atol=1e-12)
                np.testing.assert_allclose(constraints.pose(0)[1], (time + 0.01) * way, atol=1e-12)

    def test_what_grippers_pull_is_what_the_momentum_of_the_cloth_gains_and_its_weight(self):
        step = 0.005
        for size in (4, 7, 11):
            with self.subTest(size=size):
                sheet, fabric = drape.grid(size, size, 0.2, 0.2), drape.Fabric()
                system, constraints, state = drape.System(drape.masses(sheet, fabric)), drape.Constraints(), drape.at_rest(sheet)
                for force in (drape.woven(sheet, fabric), drape.gravity([0, -9.81, 0])):
                    system.add(force)
                constraints.pin(0)
                constraints.pin_along([size - 1], drape.Motion.constant([0, 0.3, 0.1]), state)
                options = drape.StepOptions(tolerance=1e-9, newton_iterations=8, newton_tolerance=1e-9)
                stepper, mass = drape.ImplicitEuler(system, constraints, "eigen-ldlt", options), system.masses[:, None]
                weight = 9.81 * system.masses.sum()
                for _ in range(12):
                    before = state.v.copy()
                    self.assertTrue(stepper.advance(state, step).converged)
                    held = constraints.pinned
                    pull = mass[held] * (state.v - before)[held] / step - system.force(state)[held]
                    gained = (mass * (state.v - before)).sum(0) / step + [0, weight, 0]
                    np.testing.assert_allclose(pull.sum(0), gained, rtol=0, atol=1e-4 * weight)

    def test_bodies_tell_how_they_move(self):
        system, constraints, state = self.free_sheet()
        rigid = drape.RigidBody(mass=2, inertia=0.1 * np.eye(3), centre=[0, -1, 0], velocity=[1, 0, 0], spin=[0, 0, 3])
        constraints.add(drape.Obstacle(drape.Sphere([0, -1, 0], 0.1), rigid=rigid))
        constraints.add(drape.Obstacle(drape.Plane([0, -5, 0])))
        drape.ImplicitEuler(system, constraints, "mpcg").advance(state, 0.01)
        velocity, spin = constraints.velocity(0)
        np.testing.assert_allclose(velocity, [1, -0.0981, 0], atol=1e-12)
        np.testing.assert_allclose(spin, [0, 0, 3], atol=1e-12)
        rotation, translation = constraints.pose(0)
        np.testing.assert_allclose(rotation @ [0, -1, 0] + translation, [0.01, -1.000981, 0], atol=1e-12)
        with self.assertRaisesRegex(ValueError, "has no mass"):
            constraints.velocity(1)
        with self.assertRaisesRegex(ValueError, "there is no body 2"):
            constraints.pose(2)


if __name__ == "__main__":
    unittest.main()
