#!/usr/bin/env python3
"""The page of docs/web-page.md in Chromium:  python3 check_web_page.py PAGE.md FOLDER   (short_run.py made the folder)

It is served with the glTF file of the short run and the three.js of this folder. Nothing may be said in the console; the cloth is
seen, and at a later time it is seen elsewhere.
"""
import contextlib
import functools
import http.server
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading

here = pathlib.Path(__file__).resolve().parent
chromium = shutil.which("chromium-headless-shell") or shutil.which("chromium")
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader
except ImportError as error:
    print(f"skipped: {error}; ./build.sh test installs python3-vtk9 on Debian")
    sys.exit(77)
for there, name in ((chromium, "Chromium"), ((here / "node_modules/three").exists(), "tests/exports/node_modules/three")):
    if not there:
        print(f"skipped: there is no {name} here")
        sys.exit(77)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@contextlib.contextmanager
def served(folder):
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/index.html"
        server.shutdown()


def picture(address, folder, milliseconds):
    """Pixels of the page when it has run so long by its own clock."""
    path = folder / f"{milliseconds}.png"
    words = ["--no-sandbox", "--headless", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--enable-logging=stderr",
             "--window-size=400,300", f"--virtual-time-budget={milliseconds}", f"--user-data-dir={folder / 'profile'}",
             f"--screenshot={path}", address]
    result = subprocess.run([chromium, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=240)
    said = [line for line in result.stdout.splitlines() if "CONSOLE" in line and "GPU stall" not in line]
    assert result.returncode == 0 and path.exists(), result.stdout
    assert not said, said
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)[:, :3]


def cloth(pixels):
    """Blue is what it has most of."""
    return pixels[:, 2] > pixels[:, 0] + 15


page, run = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
text = re.search(r"<!-- file: out/page/index.html -->\n```html\n(.*?)```", page.read_text(), re.S).group(1)
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    site = folder / "site"
    site.mkdir()
    (site / "index.html").write_text(text.replace("</style>", '</style><link rel="icon" href="data:,">'))
    (site / "ball.glb").symlink_to((run / "gltf" / "run.glb").resolve())
    (site / "node_modules").symlink_to(here / "node_modules")
    with served(site) as address:
        early, late = picture(address, folder, 1000), picture(address, folder, 5250)
seen = [int(cloth(pixels).sum()) for pixels in (early, late)]
assert min(seen) > 1000, f"the cloth has {seen} of {len(early)} pixels"
changed = int((cloth(early) != cloth(late)).sum())
assert changed > 100, f"only {changed} pixels changed: it does not play"
print(f"the cloth is seen ({seen[0]} and {seen[1]} pixels), and moves ({changed} pixels changed)")
