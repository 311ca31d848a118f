#!/usr/bin/env python3
"""Makes the site of the pages in docs/ (Sphinx) with the C++ interface under api/ (Doxygen), and looks for links that lead
nowhere and for requests to the network in it.
    make.py OUT"""
import re
import shutil
import subprocess
import sys
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
    run([python, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-b", "html", "-d", f"{out}.cache", "docs", out])
    (out / ".buildinfo").unlink(missing_ok=True)


def interface(out):
    settings = (root / "docs/Doxyfile").read_text() + f"\nINPUT = {' '.join(public_headers())}\nOUTPUT_DIRECTORY = {out}\n"
    run(["doxygen", "-"], input=settings, text=True)


def check(out):
    run([python, "tests/docs/check_links.py", "."])
    run([python, "tests/docs/check_site.py", out])
    # linkchecker leaves addresses on the web alone unless it is asked to.
    settings = Path(f"{out}.linkcheckerrc")
    settings.write_text("[AnchorCheck]\n[filtering]\nignorewarnings=url-content-too-large\n")
    run(["linkchecker", "--config", settings, "--no-status", "--recursion-level", "3", "--threads", "2",
         (out / "index.html").as_uri()])


def main(out):
    pages(out)
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
