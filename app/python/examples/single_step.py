"""One implicit step by hand: a mesh, a fabric, forces, a body, an integrator."""

import drape

shirt = drape.grid(31, 31, 1.0, 1.0)  # m; or drape.read_obj("shirt.obj")
shirt.positions[:, 1] = 0.31
fabric = drape.Fabric(area_density=0.15, stretch=500, bend=1e-5)  # kg/m^2, N/m, N m

system = drape.System(drape.masses(shirt, fabric))
system.add(drape.noh_jung(shirt, fabric))
system.add(drape.gravity([0, -9.81, 0]))

constraints = drape.Constraints()
constraints.add(drape.Obstacle(drape.Sphere([0, 0, 0], radius=0.3), friction=0.3))

stepper = drape.ImplicitEuler(system, constraints, "mpcg")
state = drape.at_rest(shirt)
report = stepper.advance(state, 0.01)  # s
print(report)
print(f"lowest vertex: {state.x[:, 1].min():.4f} m, energy: {system.energy(state):.4f} J")
