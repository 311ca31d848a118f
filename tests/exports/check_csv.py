#!/usr/bin/env python3
"""numpy on the CSV tables:  python3 check_csv.py FOLDER   (short_run.py made it)"""
import pathlib
import sys

sys.dont_write_bytecode = True
import short_run
from short_run import np

folder = pathlib.Path(sys.argv[1])
times, shapes = short_run.shapes(folder / "run")
for shape in shapes:
    path = folder / "csv" / f"{shape.name}.csv"
    assert path.exists() == (not shape.body)
    if shape.body:
        continue
    table = np.genfromtxt(path, delimiter=",", names=True)
    frames, vertices = shape.positions.shape[:2]
    assert table.dtype.names == ("frame", "time", "vertex", "x", "y", "z", "vx", "vy", "vz", "strain", "contact")
    assert table.shape == (frames * vertices,)
    column = {name: table[name].reshape(frames, vertices) for name in table.dtype.names}
    assert (column["frame"] == np.arange(1, frames + 1)[:, None]).all()
    assert (column["time"] == np.array(times)[:, None]).all()
    assert (column["vertex"] == np.arange(vertices)[None, :]).all()
    for k, axis in enumerate("xyz"):
        assert (column[axis].astype(np.float32) == shape.positions[:, :, k]).all()
        assert (column["v" + axis].astype(np.float32) == shape.velocity[:, :, k].astype(np.float32)).all()
    assert (column["strain"].astype(np.float32) == shape.strain.astype(np.float32)).all()
    assert (column["contact"] == shape.contact).all()
    print(f"{path.name}: {table.shape[0]} rows as they were computed; {int((column['contact'] > 0).sum())} in contact")
