#!/usr/bin/env python3
"""Shows Doxygen the comments of a header, which are plain // comments: the one that opens the file as the file's description,
one above a declaration as that declaration's, one behind it as well. Comments are laid out by hand (formulas, tables of
symbols), so such are kept as they stand. Every line stays on its line, because Doxygen names lines of the header.
    doxygen_filter.py HEADER.h"""
import re
import sys
from pathlib import Path

special = re.compile(r"([\\@&$#<>%\"])")
root = Path(__file__).resolve().parent.parent


def escaped(text):
    return special.sub(r"\\\1", text)


def block(texts, command):
    """As a paragraph where it is one, else with its lines and columns."""
    laid_out = any("   " in text.strip() or text.startswith("  ") for text in texts)
    lines = list(texts) if laid_out else [escaped(text) for text in texts]
    lines[0] = f"/** {command}" + ("\\verbatim " if laid_out else "") + lines[0]
    lines[-1] += " \\endverbatim */" if laid_out else " */"
    return lines


def filtered(lines, file_command):
    out, comment, opening = [], [], True
    for line in lines + [""]:
        alone = re.match(r"\s*//[ ]?(.*)", line)
        if alone:
            comment.append(alone[1])
            continue
        if comment:
            described = opening or line.strip()  # else it stands alone: a heading of what follows
            out += block(comment, file_command if opening else "") if described else [""] * len(comment)
            comment, opening = [], False
        if line.strip():
            opening = False
        out.append(re.sub(r"([;,{}])\s+// (.*)", lambda m: f"{m[1]} ///< {escaped(m[2])}", line))
    return out[:-1]


header = Path(sys.argv[1]).resolve()
print("\n".join(filtered(header.read_text(encoding="utf-8").split("\n"), f"\\file {header.relative_to(root)} ")))
