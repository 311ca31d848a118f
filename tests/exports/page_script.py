#!/usr/bin/env python3
"""Runs what a page says for Blender:  python3 page_script.py PAGE.md DRAPE FOLDER

Its sh blocks in bash, in a folder where `drape` and data/ are found, in their order; a python block is the file that the comment
above it names (<!-- file: NAME -->).
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

page, program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
if not shutil.which("blender"):
    print("skipped: there is no blender here; ./build.sh test installs it on Debian")
    sys.exit(77)
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
(folder / "data").symlink_to(page.parent.parent / "data")
(folder / "bin").mkdir()
(folder / "bin" / "drape").symlink_to(program)
environment = dict(os.environ, PATH=f"{(folder / 'bin').resolve()}:{os.environ['PATH']}")
ran = 0
for file, language, text in re.findall(r"(?:<!-- file: (\S+) -->\n)?(?:<!-- [^\n]* -->\n)*```(\w+)\n(.*?)```", page.read_text(), re.S):
    if language == "sh":
        subprocess.run(["bash", "-euc", text], cwd=folder, env=environment, check=True)
        ran += 1
    elif language == "python":
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text)
assert ran > 0, f"{page} has no sh blocks"
