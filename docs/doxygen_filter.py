#!/usr/bin/env python3
"""Shows Doxygen the comments of a header, which are plain // comments: the one that opens the file as the file's description,
one above a declaration as that declaration's, one behind it as well. Comments are laid out by hand (formulas, tables of
symbols), so they are kept as they stand.
    doxygen_filter.py HEADER.h"""
import re
import sys

special = re.compile(r"([\\@&$#<>%\"])")


def escaped(text):
    return special.sub(r"\\\1", text)


def shown(texts):
    """As one paragraph where it is one, else with its lines and columns."""
    laid_out = any("   " in text.strip() or text.startswith("  ") for text in texts)
    if not laid_out:
        return [escaped(text) for text in texts]
    return ["\\verbatim", *(text.replace("\\endverbatim", "") for text in texts), "\\endverbatim"]


def block(texts, command=None):
    lines = ["/**"]
    if command:
        lines.append(command)
    return lines + shown(texts) + ["*/"]


def filtered(lines):
    out, comment, opening = [], [], True
    for line in lines + [""]:
        alone = re.match(r"\s*//[ ]?(.*)", line)
        if alone:
            comment.append(alone[1])
            continue
        if comment:
            out += block(comment, "\\file") if opening else (block(comment) if line.strip() else [])
            comment, opening = [], False
        if line.strip():
            opening = False
        out.append(re.sub(r"([;,{}])\s+// (.*)", lambda m: f"{m[1]} ///< {escaped(m[2])}", line))
    return out


with open(sys.argv[1], encoding="utf-8") as file:
    print("\n".join(filtered(file.read().split("\n"))))
