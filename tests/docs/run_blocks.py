#!/usr/bin/env python3
"""Runs every code block of a page, in a folder of its own where the project's files are seen as in a fresh clone that is built.
    run_blocks.py --source DIR --build DIR --work DIR [--python DIR] PAGE.md

    sh       bash -eu, one block after another
    toml     a scene, or a part of one, which a small cloth makes whole: drape check
    python   one program for all blocks of the page; DIR (BUILD/python) holds the module drape
    cpp      a whole program: compiled with the installed library, and run
    cmake    configured, built and run, with the files of the blocks before
    text     not run; after `<!-- output -->` compared with what the command before it printed
page.py lists what may be said of a block. Exit code 77: all ran but those for which something is not there.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from page import Mistake, Page

optional_modules = ("drape", "numpy", "scipy", "matplotlib", "bpy", "vtk")
only_shown = ("text", "{toctree}")
only_as_file = ("json", "xml", "html", "js")
small_cloth = '[[cloth]]\nmesh = "data/meshes/sheet-625.obj"\n'


class Runner:
    def __init__(self, options, page):
        self.options, self.page = options, page
        self.folder = Path(options.work).resolve()
        self.printed = ""
        self.python = []
        self.counts, self.not_run, self.skipped = {}, [], []
        build = Path(options.build).resolve()
        self.environment = dict(os.environ, PATH=f"{build}{os.pathsep}{os.environ['PATH']}", MPLBACKEND="Agg")
        self.environment.pop("DRAPE_DATA", None)
        self.environment["PYTHONPATH"] = str(Path(options.python).resolve() if options.python else build / "python")

    def prepare(self):
        """The project's files, none of which a block can change: data/ is a copy, for programs write beside what they read."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        source, build = Path(self.options.source).resolve(), Path(self.options.build).resolve()
        for entry in sorted(source.iterdir()):
            if entry.name in ("build", "out", "data") or entry.name.startswith("."):
                continue
            (self.folder / entry.name).symlink_to(entry)
        shutil.copytree(source / "data", self.folder / "data", ignore=shutil.ignore_patterns("motions", "*.vdb"))
        (self.folder / "build").mkdir()
        (self.folder / "build" / "release").symlink_to(build)

    def fail(self, block, what):
        self.page.fail(block.line, f"{block.language or 'a'} block: {what}")

    def run(self, block, words, what):
        result = subprocess.run(words, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
        self.printed = result.stdout
        expected = int(block.said.get("exit", 0))
        if result.returncode != expected and not self.lacks_module(result.stdout):
            self.fail(block, f"{what} ended with {result.returncode}, expected {expected}:\n{result.stdout}")

    def lacks_module(self, printed):
        """Whether a program ended because a module is not there that need not be; then it is noted."""
        last = printed.strip().split("\n")[-1]
        for module in optional_modules:
            if last == f"ModuleNotFoundError: No module named '{module}'":
                self.skipped.append(f"{self.page.path}: the Python module {module} is not there")
                return True
        return False

    def run_block(self, block):
        language = block.language
        self.counts[language] = self.counts.get(language, 0) + 1
        if "not run" in block.said:
            self.not_run.append(f"{self.page.path}:{block.line}: {block.said['not run']}")
            return
        if "before" in block.said:
            self.run(block, ["bash", "-euc", block.said["before"]], "what comes before it")
        if "file" in block.said:
            file = self.folder / block.said["file"]
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(block.text, encoding="utf-8")
        kind = {"sh": self.sh, "toml": self.toml, "python": self.collect, "cpp": self.cpp, "cmake": self.cmake}.get(language)
        if kind:
            kind(block)
        elif language in only_shown:
            self.compare(block)
        elif language not in only_as_file:
            self.fail(block, f"nobody knows how to run '{language}'; expected sh, toml, python, cpp, cmake or text")
        elif "file" not in block.said:
            self.fail(block, "is neither a file that is used (<!-- file: NAME -->) nor said to be <!-- not run: REASON -->")

    def sh(self, block):
        text = block.text
        if "shorter" in block.said:
            text = re.sub(r"^(.*\bdrape (?:simulate|drop) .*?)(?=  #|$)", rf"\1 {block.said['shorter']}", text, flags=re.M)
        self.run(block, ["bash", "-eu", "-o", "pipefail", "-c", text], "bash")

    def compare(self, block):
        """Every line must have been printed, in this order, with blanks as they come."""
        if "output" not in block.said:
            return
        def plain(line):
            if block.said["output"] == "numbers may differ":
                line = re.sub(r"[-+]?\d[-+.\de]*", "0", line)
            return " ".join(line.split())

        printed = iter([plain(line) for line in self.printed.split("\n")])
        for line in block.text.split("\n"):
            wanted = plain(line)
            pattern = ".*".join(re.escape(part) for part in re.split(r" ?\.\.\. ?", wanted))
            if wanted and not any(re.fullmatch(pattern, each) for each in printed):
                self.fail(block, f"this line was not printed: {line}\nprinted was:\n{self.printed}")

    def toml(self, block):
        name = block.said.get("file", f"block-{block.line}.toml")
        text = block.text
        if "pattern" in block.said:
            (self.folder / name).write_text(text, encoding="utf-8")
            self.run(block, ["drape", "triangulate", name, "-o", name + ".obj", "--quiet"], "drape triangulate")
            return
        if "fabric" in block.said:
            (self.folder / name).write_text(text, encoding="utf-8")
            self.run(block, ["drape", "check", name], "drape check")
            return
        if "[[cloth]]" not in text and "[[soft]]" not in text:
            if "[" not in text.lstrip()[:1]:
                self.fail(block, "a part of a scene begins with the name of its table")
            text += "\n" + small_cloth
        (self.folder / name).write_text(text, encoding="utf-8")
        self.run(block, ["drape", "check", name], "drape check")

    def collect(self, block):
        if "file" not in block.said:
            self.python.append(block)

    def run_python(self):
        if not self.python:
            return
        text = ""
        for block in self.python:  # on the line on which it stands in the page
            text += "\n" * (block.line - 1 - text.count("\n")) + block.text
        name = self.page.path.stem + "-blocks.py"
        (self.folder / name).write_text(text, encoding="utf-8")
        result = subprocess.run([sys.executable, name], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
        if result.returncode != 0 and not self.lacks_module(result.stdout):
            self.fail(self.python[0], f"the python blocks failed:\n{result.stdout}")

    def install(self, block):
        prefix = self.folder / "installed"
        if not prefix.exists():
            self.run(block, ["cmake", "--install", "build/release", "--prefix", str(prefix)], "the installation")

    def build_and_run(self, block, folder, program):
        self.install(block)
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        self.run(block, ["cmake", "-S", folder, "-B", folder + "/build", "-DCMAKE_BUILD_TYPE=Debug", *generator,
                         f"-DCMAKE_PREFIX_PATH={self.folder}/installed"], "cmake")
        self.run(block, ["cmake", "--build", folder + "/build"], "compiling")
        self.run(block, [f"{folder}/build/{program}"], "the program")

    def cpp(self, block):
        if "int main(" not in block.text:
            self.fail(block, "has no main(): only whole programs can be compiled and run")
        if "file" in block.said:
            return  # a cmake block builds it
        folder = f"cpp-{block.line}"
        (self.folder / folder).mkdir()
        (self.folder / folder / "main.cpp").write_text(f'#line {block.line} "{self.page.path}"\n{block.text}')
        scenes = "<drape/app.h>" in block.text
        (self.folder / folder / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.21)\nproject(app CXX)\nfind_package(drape REQUIRED {'COMPONENTS app' if scenes else ''})\n"
            f"add_executable(app main.cpp)\ntarget_link_libraries(app {'drape::app' if scenes else 'drape::drape'})\n")
        self.build_and_run(block, folder, "app")

    def cmake(self, block):
        folder = f"cmake-{block.line}"
        (self.folder / folder).mkdir()
        (self.folder / folder / "CMakeLists.txt").write_text(block.text)
        for other in self.page.blocks:
            if other.language == "cpp" and "file" in other.said:
                (self.folder / folder / other.said["file"]).write_text(other.text)
        self.build_and_run(block, folder, "app")

    def run_page(self):
        for number in self.page.indented:
            self.page.fail(number, "a block without a fence: nobody knows what is in it; put it into one that names its language")
        self.prepare()
        for block in self.page.blocks:
            self.run_block(block)
        self.run_python()
        print(", ".join(f"{count} {language}" for language, count in sorted(self.counts.items())) or "no blocks")
        for text in self.not_run:
            print("not run:", text)
        for text in self.skipped:
            print("SKIPPED:", text)
        return 77 if self.skipped else 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", required=True)
    parser.add_argument("--build", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--python")
    parser.add_argument("page")
    options = parser.parse_args()
    return Runner(options, Page(options.page)).run_page()


try:
    sys.exit(main())
except Mistake as mistake:
    sys.exit(str(mistake))
