"""Blender on the PC2, MDD and glTF files:  blender -b --factory-startup --python-exit-code 1 -P check_blender.py -- FOLDER

short_run.py made the folder. OBJ and glTF come in as Blender's importers bring them, z up; the Mesh Cache modifier then moves the OBJ.
What is compared are the vertices that Blender evaluates, in its world: (x, y, z) of drape is (x, -z, y) there.
"""
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bpy
import numpy as np

import short_run

folder = pathlib.Path(sys.argv[sys.argv.index("--") + 1])
times, shapes = short_run.shapes(folder / "run")
scene = bpy.context.scene
scene.render.fps = 25


def empty():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    global scene
    scene = bpy.context.scene
    scene.render.fps = 25


def world(points):
    return points @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])


def evaluated(thing):
    """Vertices in the world, as they are drawn now."""
    now = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = now.to_mesh()
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    now.to_mesh_clear()
    matrix = np.array(now.matrix_world)
    return points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def check(found, expected, what):
    assert found.shape == expected.shape, (what, found.shape, expected.shape)
    error = np.abs(found - expected).max()
    assert error < 3e-7, (what, error)
    return error


def import_obj(path):
    bpy.ops.wm.obj_import(filepath=str(path))
    things = [thing for thing in scene.objects if thing.type == "MESH"]
    assert len(things) == 1, things
    return things[0]


def check_cache(shape, file, kind):
    empty()
    thing = import_obj(folder / "run" / ("bodies" if shape.body else ".") / (shape.name + ".obj"))
    check(evaluated(thing), world(shape.positions[-1]), shape.name + " as imported")
    cache = thing.modifiers.new("drape", "MESH_CACHE")
    cache.cache_format = kind
    cache.filepath = str(file)
    cache.frame_start = 1
    worst = 0
    for k in range(len(times)):
        scene.frame_set(1 + k)
        worst = max(worst, check(evaluated(thing), world(shape.positions[k]), f"{shape.name} {kind} frame {k + 1}"))
    moved = np.abs(shape.positions - shape.positions[0]).max()
    assert moved > 0.01, (shape.name, "does not move")
    print(f"{kind} of {shape.name}: {len(times)} frames within {worst:.1e} m")


for shape in shapes:
    if not shape.moves:
        assert not (folder / "mdd" / (shape.name + ".mdd")).exists()
        continue
    check_cache(shape, folder / "mdd" / (shape.name + ".mdd"), "MDD")
    own = folder / "run" / ("bodies" if shape.body else ".") / (shape.name + ".pc2")
    if own.exists():
        check_cache(shape, own, "PC2")

if not hasattr(np, "bool"):  # Blender 3.4's importer asks for it, and Debian 12's numpy 1.24 no longer has it
    np.bool = bool
empty()
bpy.ops.import_scene.gltf(filepath=str(folder / "gltf" / "run.glb"))
things = {thing.name: thing for thing in scene.objects if thing.type == "MESH"}
assert sorted(things) == sorted(shape.name for shape in shapes), list(things)
for shape in shapes:
    worst = 0
    for k, time in enumerate(times):
        scene.frame_set(round(time * scene.render.fps))
        found = evaluated(things[shape.name])[:len(shape.positions[k])]  # doubles of the uv seam come after
        worst = max(worst, check(found, world(shape.positions[k]), f"{shape.name} glTF frame {k + 1}"))
    print(f"glTF of {shape.name}: {len(times)} frames within {worst:.1e} m")
