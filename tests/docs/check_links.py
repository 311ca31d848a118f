#!/usr/bin/env python3
"""Every link of every page of the repository: the file is there, and the heading in it. Addresses on the web are not fetched.
    check_links.py FOLDER"""
import sys
from pathlib import Path
from urllib.parse import unquote

from page import Mistake, Page

skipped = {"build", "out", ".git", "node_modules"}


def pages_below(folder):
    return sorted(p for p in folder.rglob("*.md") if not skipped & set(p.relative_to(folder).parts))


def dead_links(page):
    for line, target in page.links():
        if "://" in target or target.startswith("mailto:"):
            continue
        name, _, anchor = unquote(target).partition("#")
        path = page.path.parent / name if name else page.path
        if not path.exists():
            yield f"{page.path}:{line}: {target}: there is no such file"
        elif anchor and path.suffix == ".md" and anchor not in Page(path).anchors():
            yield f"{page.path}:{line}: {target}: no heading of {path} gives this anchor"


def main(folder):
    pages = [Page(path) for path in pages_below(Path(folder))]
    dead = [text for page in pages for text in dead_links(page)]
    print(*dead, sep="\n")
    print(f"{len(pages)} pages, {sum(len(list(page.links())) for page in pages)} links, {len(dead)} dead")
    return 1 if dead or not pages else 0


try:
    sys.exit(main(*sys.argv[1:]))
except Mistake as mistake:
    sys.exit(str(mistake))
