"""A Markdown page taken apart: code blocks with what is said of them, parts that a command made, links, headings.

What is said of a block stands in HTML comments right above its fence, which no reader of the page sees:
    <!-- before: COMMAND -->     sh, run first
    <!-- file: NAME -->          the block is this file
    <!-- shorter: WORDS -->      sh: words added to each run, so that the tests do not wait
    <!-- exit: N -->             how the command ends, when not with 0
    <!-- output -->              a text block: what the sh block before it printed; ... stands for anything
    <!-- output: numbers may differ -->
    <!-- pattern -->             a toml block that is a sewing pattern and no scene
    <!-- fabric -->              a toml block that is a fabric file and no scene
    <!-- not run: REASON -->
A part that a command made, between its table's ends:
    <!-- made by: COMMAND --> ... <!-- end -->
"""
import re
from dataclasses import dataclass, field
from pathlib import Path

words = {"before", "shorter", "file", "exit", "output", "pattern", "fabric", "not run"}


class Mistake(Exception):
    """What is wrong with a page, with its place."""


@dataclass
class Block:
    language: str
    line: int  # of the first line of the text, from 1
    text: str
    said: dict = field(default_factory=dict)


@dataclass
class Made:
    command: str
    begin: int  # lines of the page between the two comments
    end: int


class Page:
    def __init__(self, path):
        self.path = Path(path)
        self.lines = self.path.read_text(encoding="utf-8").split("\n")
        self.blocks, self.made, self.prose = [], [], []
        self.indented = []  # lines of blocks without a fence
        self.parse()

    def fail(self, line, what):
        raise Mistake(f"{self.path}:{line}: {what}")

    def parse(self):
        said, fence, made = {}, None, None
        for number, line in enumerate(self.lines, 1):
            if fence:
                block, mark, indent = fence
                if line.strip() == mark:
                    self.blocks.append(block)
                    fence = None
                else:
                    block.text += (line[indent:] if line[:indent].isspace() else line) + "\n"
                continue
            comment = re.fullmatch(r"\s*<!-- (.*) -->", line)
            opening = re.fullmatch(r"(\s*)(`{3,})([^\s`]*)", line)
            if comment:
                word, _, value = comment[1].partition(": ")
                if word == "made by":
                    made = Made(value, number, number)
                elif word == "end" and made:
                    made.end = number - 1
                    self.made.append(made)
                    made = None
                elif word in words:
                    said[word] = value
                else:
                    self.fail(number, f"nobody knows the comment '{word}'; known are: {', '.join(sorted(words))}, made by")
            elif opening:
                fence = (Block(opening[3], number + 1, "", said), opening[2], len(opening[1]))
                said = {}
            else:
                if said and line.strip():
                    self.fail(number, f"'{next(iter(said))}' is said of a block that does not follow")
                if re.match(r" {4,}\S", line) and not self.in_list(number):
                    self.indented.append(number)
                self.prose.append((number, line))
        if fence:
            self.fail(fence[0].line - 1, "the fence has no end")
        if made:
            self.fail(made.begin, "'made by' without '<!-- end -->'")

    def in_list(self, number):
        """Whether an indented line goes on with an item of a list."""
        for line in reversed(self.lines[: number - 1]):
            if re.match(r"\s*([-*]|\d+\.) ", line):
                return True
            if not line.startswith(" ") and line.strip():
                return False
        return False

    def links(self):
        """(line, target) of every link and picture in the prose."""
        for number, line in self.prose:
            bare = re.sub(r"`[^`]*`", "", line)
            for match in re.finditer(r"\]\(\s*<?([^)\s>]+)>?[^)]*\)", bare):
                yield number, match[1]

    def anchors(self):
        """Of the headings, as web sites that show Markdown name them."""
        found = {}
        for _, line in self.prose:
            heading = re.match(r"#{1,6} (.*)", line)
            if not heading:
                continue
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).replace("`", "").strip().lower()
            name = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
            found[name] = found.get(name, -1) + 1
            if found[name]:
                found[f"{name}-{found[name]}"] = 0
        return set(found)
