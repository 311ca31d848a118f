#!/usr/bin/env python3
"""That the built site asks the network for nothing: no script, style, picture, font or frame of a page comes from elsewhere.
Links that a reader may follow are something else.
    check_site.py FOLDER"""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

fetched = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src", "embed": "src",
           "object": "data", "link": "href", "use": "href", "image": "href"}
harmless = {"canonical", "next", "prev", "index", "search", "author", "copyright", "license"}  # of <link rel>
elsewhere = re.compile(r"\s*(?:[a-z]+:)?/", re.IGNORECASE)  # another host, or a folder that only a server has
in_styles = re.compile(r"(?:url\(\s*['\"]?|@import\s+['\"])([^'\")\s]+)", re.IGNORECASE)


class Fetches(HTMLParser):
    def __init__(self):
        super().__init__()
        self.addresses, self.style = [], False

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.style = tag == "style"
        if tag == "link" and set((attributes.get("rel") or "").split()) <= harmless:
            return
        for name in (fetched.get(tag), "srcset", "xlink:href" if tag in ("use", "image") else None):
            self.addresses += [part.split()[0] for part in (attributes.get(name) or "").split(",") if part.strip()] if name else []
        self.addresses += in_styles.findall(attributes.get("style") or "")

    def handle_data(self, data):
        if self.style:
            self.addresses += in_styles.findall(data)

    def handle_endtag(self, tag):
        self.style = False


def addresses(path):
    text = path.read_text(encoding="utf-8", errors="replace")
    if path.suffix == ".html":
        page = Fetches()
        page.feed(text)
        return page.addresses
    return in_styles.findall(text)


def main(folder):
    files = [path for ending in ("html", "css", "svg") for path in Path(folder).rglob("*." + ending)]
    outside = sorted(f"{path}: {address}" for path in files for address in addresses(path) if elsewhere.match(address))
    print(*outside, sep="\n")
    print(f"{len(files)} files, {len(outside)} of their requests go elsewhere")
    return 1 if outside or not files else 0


sys.exit(main(*sys.argv[1:]))
