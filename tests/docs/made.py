#!/usr/bin/env python3
"""The parts of the pages that a command makes (tables of keys, of fabrics, of solvers): compares them with what the command
prints now, or with --write puts that in.
    made.py --program DRAPE [--write] PAGE.md..."""
import argparse
import os
import shlex
import subprocess
import sys

from page import Mistake, Page


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="the drape command")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("pages", nargs="+")
    options = parser.parse_args()
    environment = {name: value for name, value in os.environ.items() if name != "DRAPE_DATA"}
    checked, stale = 0, []
    for path in options.pages:
        page = Page(path)
        lines = list(page.lines)
        for made in reversed(page.made):
            words = shlex.split(made.command)
            if words[0] != "drape":
                page.fail(made.begin, f"'{words[0]}' may not make a part of a page; expected drape")
            result = subprocess.run([options.program] + words[1:], capture_output=True, text=True, env=environment)
            if result.returncode != 0:
                page.fail(made.begin, f"{made.command}: {result.stderr.strip()}")
            lines[made.begin : made.end] = [""] + result.stdout.strip("\n").split("\n") + [""]
            checked += 1
        if lines != page.lines:
            stale.append(path)
            if options.write:
                page.path.write_text("\n".join(lines), encoding="utf-8")
    print(f"{checked} parts made by commands")
    if stale and not options.write:
        sys.exit(f"no longer what the command prints (./build.sh docs writes it): {', '.join(stale)}")


try:
    main()
except Mistake as mistake:
    sys.exit(str(mistake))
