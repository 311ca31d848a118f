#!/usr/bin/env python3
"""VTK's own readers on the exports for ParaView, PLY and OBJ:  python3 check_vtk.py FOLDER   (short_run.py made it)"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOGeometry import vtkOBJReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError as error:
    print(f"skipped: {error}; ./build.sh test installs python3-vtk9 on Debian")
    sys.exit(77)

sys.dont_write_bytecode = True
import numpy as np

import short_run

folder = pathlib.Path(sys.argv[1])
times, shapes = short_run.shapes(folder / "run")
by_name = {shape.name: shape for shape in shapes}
checked = 0


def read(reader, path):
    assert path.exists(), path
    said = []
    for event in ("ErrorEvent", "WarningEvent"):
        reader.AddObserver(event, lambda *_: said.append(path))
    reader.SetFileName(str(path))
    reader.Update()
    assert not said, said
    return reader.GetOutput()


def polygons(data):
    ends = vtk_to_numpy(data.GetPolys().GetOffsetsArray())
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    return [corners[a:b].tolist() for a, b in zip(ends, ends[1:])]


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def same(found, expected):
    """In float32, which is what the files hold."""
    global checked
    np.testing.assert_array_equal(found, np.asarray(expected).astype(found.dtype))
    checked += 1


def near(found, expected):
    """Of bodies that poses move: bodies.csv has ten digits."""
    global checked
    np.testing.assert_allclose(found, expected, rtol=0, atol=5e-7)
    checked += 1


def frames(shape, kind):
    """(frame, file) of each."""
    if not shape.moves:
        return [(0, folder / kind / f"{shape.name}.{kind}")]
    return [(k, folder / kind / f"{shape.name}_{k + 1:04d}.{kind}") for k in range(len(times))]


def uv_of_vertices(shape):
    uv = np.zeros((len(shape.positions[0]), 2))
    for face, corners in zip(shape.faces, shape.uv):
        uv[face] = corners
    return uv


def check_vtp(shape, frame, path):
    data = read(vtkXMLPolyDataReader(), path)
    (near if shape.body else same)(points(data), shape.positions[frame])
    assert polygons(data) == shape.faces
    arrays = data.GetPointData()
    if shape.body:
        assert arrays.GetNumberOfArrays() == 0
    else:
        for name, expected in (("velocity", shape.velocity), ("strain", shape.strain), ("contact", shape.contact)):
            same(vtk_to_numpy(arrays.GetArray(name)), expected[frame])
    if shape.name == "plain":
        same(vtk_to_numpy(arrays.GetTCoords()), uv_of_vertices(shape))
    else:
        assert arrays.GetTCoords() is None
    value = vtk_to_numpy(data.GetFieldData().GetArray("TimeValue"))
    assert value.tolist() == [times[frame]] or not shape.moves


pvd = ElementTree.parse(folder / "vtk" / "run.pvd").getroot()
sets = [entry.attrib for entry in pvd.iter("DataSet")]
assert len(sets) == len(times) * len(shapes)
for k, time in enumerate(times):
    now = [entry for entry in sets if float(entry["timestep"]) == time]
    assert [entry["name"] for entry in now] == [shape.name for shape in shapes]
    assert [int(entry["part"]) for entry in now] == list(range(len(shapes)))
    for entry in now:
        check_vtp(by_name[entry["name"]], k if by_name[entry["name"]].moves else 0, folder / "vtk" / entry["file"])

for shape in shapes:
    for k, path in frames(shape, "ply"):
        data = read(vtkPLYReader(), path)
        (near if shape.body else same)(points(data), shape.positions[k])
        assert polygons(data) == shape.faces
    for k, path in frames(shape, "obj"):
        data = read(vtkOBJReader(), path)  # it makes points of its own where uv differ: corners are compared
        found = [points(data)[face] for face in polygons(data)]
        assert len(found) == len(shape.faces)
        for corners, face in zip(found, shape.faces):
            np.testing.assert_allclose(corners, shape.positions[k][face], rtol=0, atol=5e-7)
        written, faces, uv = short_run.read_obj(path)
        (near if shape.body else same)(written.astype(np.float32), shape.positions[k])
        assert faces == shape.faces and uv == shape.uv

print(f"VTK read {checked} arrays of {len(shapes)} shapes in {len(times)} frames as they were computed")
