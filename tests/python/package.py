"""The module as pip installs it into a virtual environment, without a network: package.py SOURCE BUILD WORK PROGRAM."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

source, build, work, program = map(Path, sys.argv[1:])


def run(*words, **options):
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "DRAPE_DATA")}
    environment["DRAPE_BUILD_DIR"] = str(build)
    done = subprocess.run(list(map(str, words)), env=environment, capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout


shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
run(sys.executable, "-m", "venv", "--system-site-packages", work / "env")
python = work / "env/bin/python"
run(python, "-m", "pip", "install", "--no-index", "--no-build-isolation", source)

scene = source / "data/scenes/sheet-on-ball.toml"
out = run(python, "-c", f"""
import drape, json, pathlib
folder = pathlib.Path(drape.__file__).parent
(folder / "data/fabrics/of-the-package.toml").write_text((folder / "data/fabrics/cotton-broad.toml").read_text())
simulation = drape.read_scene({str(scene)!r}, {{"simulation.duration": 0.1}})
simulation.run(frames="none")
print(json.dumps([str(folder), simulation.state_hash, drape.fabric_names(), drape.__version__]))
""", cwd=work)
folder, state_hash, fabrics, version = json.loads(out)
run(program, "simulate", scene, "--duration", "0.1", "--out", work / "o", "--quiet", "--frames", "none")
expected = json.loads((work / "o/run.json").read_text())
assert Path(folder).is_relative_to(work), folder
assert state_hash == expected["state_hash"], (state_hash, expected["state_hash"])
assert "of-the-package" in fabrics, fabrics
assert version == expected["drape_version"], version
for name in ("py.typed", "_drape.pyi"):
    assert (Path(folder) / name).is_file(), name
left = [p.name for p in source.glob("*.egg-info")]
assert not left, left
run(python, "-m", "pip", "uninstall", "--yes", "drape")
print("installed, ran with the same bits, uninstalled")
