"""Arrays whose owners are gone, read under the address sanitizer.

Run with libasan preloaded and PYTHONMALLOC=malloc: copying an array out (tobytes) is then checked byte by byte, because memcpy
is the sanitizer's. Without a sanitizer this says so and fails.
"""

import ctypes
import gc
import sys

import drape
from workshop import SEWN_QUICKLY, SOURCE


def sanitized():
    return hasattr(ctypes.CDLL(None), "__asan_init")


def sheet():
    return drape.grid(40, 40, 1, 1)


def stepper():
    mesh, fabric = sheet(), drape.Fabric()
    system = drape.System(drape.masses(mesh, fabric))
    system.add(drape.noh_jung(mesh, fabric))
    constraints = drape.Constraints()
    constraints.add(drape.Obstacle(drape.MeshBody(drape.sphere(2, 0.3))))
    return drape.ImplicitEuler(system, constraints, drape.make_linear_solver("mpcg"))


def simulation():
    mesh = sheet()
    drape.write_obj(sys.argv[1] + "/sheet.obj", mesh)
    return drape.read_scene({"cloth": [{"mesh": sys.argv[1] + "/sheet.obj"}]})


def taken_out():
    """Arrays, and nothing else that would keep their owners."""
    yield "positions of a mesh", sheet().positions
    yield "triangles of a mesh", sheet().triangles
    yield "x of a state", drape.at_rest(sheet()).x
    yield "v of a state", drape.at_rest(sheet()).v
    yield "part of x", drape.at_rest(sheet()).x[5:, 1]
    yield "masses of a system", stepper().system.masses
    yield "x of a simulation", simulation().state.x
    yield "positions of its cloth", simulation().cloths[0].positions
    yield "velocities of its cloth", simulation().cloths[0].velocities


def read_all():
    for what, array in taken_out():
        gc.collect()
        array.tobytes()
        if array.flags.writeable:
            array[...] = array.copy()
        print("read", what)


def objects_that_refer_to_others():
    by_hand, state = stepper(), drape.at_rest(sheet())
    gc.collect()
    by_hand.record_systems = True
    by_hand.advance(state, 0.01)
    system, constraints, solver, last = by_hand.system, by_hand.constraints, by_hand.solver, by_hand.last_system
    del by_hand
    gc.collect()
    system.energy(state), constraints.penetration(state), solver.solve(last)
    cloths, running = simulation().cloths, iter(simulation())
    state_of_one = simulation().state
    gc.collect()
    next(running)
    print(cloths[0].name, cloths[0].positions.sum(), state_of_one.x.sum(), state_of_one.hash)


def particles_become_fewer():
    sewn = drape.read_scene(str(SOURCE / "data/scenes/skirt-sewn.toml"), SEWN_QUICKLY)
    old_x, old_v, old_positions = sewn.state.x, sewn.state.v, sewn.cloths[0].positions
    for _ in sewn:
        if len(sewn.state.x) < len(old_x):
            break
    else:
        sys.exit("no seam has closed: nothing was checked")
    new_x = sewn.state.x
    del sewn
    gc.collect()
    for array in (old_x, old_v, old_positions, new_x):
        array.tobytes()


if not sanitized():
    sys.exit("the address sanitizer is not there: nothing was checked")
read_all()
objects_that_refer_to_others()
particles_become_fewer()
print("all owners lived long enough")
