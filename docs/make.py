#!/usr/bin/env python3
"""Makes the site of the pages in docs/ (Sphinx) with the C++ interface under api/ (Doxygen), and looks for links that lead
nowhere and for requests to the network in it.
    make.py OUT"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parent.parent
python = "/usr/bin/python3"  # the one that Debian's packages are for


def run(words, **more):
    print("--", " ".join(str(word) for word in words if len(str(word)) < 60), flush=True)
    if subprocess.run([str(word) for word in words], cwd=root, **more).returncode != 0:
        sys.exit(f"{words[0]} found mistakes, see above")


def public_headers():
    """What a program has that includes drape.h."""
    found, open_ = [], ["solver/drape.h"]
    while open_:
        header = open_.pop()
        if header not in found:
            found.append(header)
            open_ += re.findall(r'#include "([^"]+)"', (root / header).read_text())
    return sorted(found)


def pages(out):
    # The whole site each time: what is gone from the pages is gone from it.
    shutil.rmtree(out, ignore_errors=True)
    run([python, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-b", "html", "-d", f"{out}.cache", "-c", "docs", ".", out])
    (out / ".buildinfo").unlink(missing_ok=True)
    (out / "index.html").write_text('<!doctype html><meta charset="utf-8"><title>drape</title>'
                                    '<meta http-equiv="refresh" content="0; url=docs/index.html">'
                                    '<a href="docs/index.html">drape</a>, <a href="api/index.html">C++ interface</a>\n')


def bring_styles(out):
    """Debian's Furo takes a style from a web server's folder /javascript; a site on a disk must have it itself."""
    for style in out.rglob("*.css"):
        text = style.read_text()
        for address in set(re.findall(r"url\((/javascript/[^)]+)\)", text)):
            shutil.copy(f"/usr/share{address}", style.parent)
            text = text.replace(address, Path(address).name)
        style.write_text(text)


def bring_scripts(out):
    """Debian's Furo is not bundled: its script imports another, which a page from a disk may not."""
    script = out / "_static/scripts/furo.js"
    text, imported = script.read_text(), 'import Gumshoe from "./gumshoe-patched.js";\n'
    if imported in text:
        script.write_text(script.with_name("gumshoe-patched.js").read_text() + text.replace(imported, ""))


def interface(out):
    settings = (root / "docs/Doxyfile").read_text() + f"\nINPUT = docs/interface.dox {' '.join(public_headers())}\nOUTPUT_DIRECTORY = {out}\n"
    run(["doxygen", "-"], input=settings, text=True)


def check(out):
    run([python, "tests/docs/check_links.py", "."])
    run([python, "tests/docs/check_site.py", out])
    # linkchecker leaves addresses on the web alone unless it is asked to. Run by root it becomes nobody, who may not be allowed to
    # read this folder: so it gets a copy.
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        site = shutil.copytree(out, Path(folder) / "site")
        settings = Path(folder) / "linkcheckerrc"
        settings.write_text("[checking]\nmaxrequestspersecond=1000\n[AnchorCheck]\n")
        # Links within Doxygen's pages are Doxygen's.
        run(["linkchecker", "--config", settings, "--no-follow-url", "/api/", "--no-status", "--threads", "2",
             (site / "index.html").as_uri()])


def main(out):
    pages(out)
    bring_styles(out)
    bring_scripts(out)
    interface(out)
    check(out)
    print(f"the site: {out}/index.html")


missing = [tool for tool in ("doxygen", "linkchecker") if not shutil.which(tool)]
if subprocess.run([python, "-c", "import myst_parser, furo"], capture_output=True).returncode != 0:
    missing.append("sphinx with myst-parser and furo")
if missing:
    print(f"SKIPPED: not there: {', '.join(missing)}; ./build.sh docs installs them")
    sys.exit(77)
main(Path(sys.argv[1]).resolve())
