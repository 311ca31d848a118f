"""Builds the Python module for pip: CMake compiles it and installs it into the wheel, with its fabrics.

DRAPE_BUILD_DIR: take the module from this build folder, which `./build.sh python` makes, instead of compiling it.
CMAKE_ARGS: further options for CMake, such as -DDRAPE_NATIVE=OFF for a wheel that goes to other machines.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.egg_info import egg_info

SOURCE = Path(__file__).resolve().parent


class Build(build_ext):
    def run(self):
        folder = os.environ.get("DRAPE_BUILD_DIR")
        if not folder:
            folder = self.build_temp
            options = [f"-DPython_EXECUTABLE={sys.executable}", "-DDRAPE_PYTHON=ON", "-DDRAPE_TESTS=OFF", "-DCMAKE_BUILD_TYPE=Release"]
            subprocess.check_call(["cmake", "-S", SOURCE, "-B", folder, *options, *shlex.split(os.environ.get("CMAKE_ARGS", ""))])
            subprocess.check_call(["cmake", "--build", folder, "--target", "drape_python", "--parallel", str(os.cpu_count())])
        subprocess.check_call(["cmake", "--install", folder, "--component", "python", "--prefix", self.build_lib])


class EggInfo(egg_info):
    """Below build/, and not in the source folder."""

    def initialize_options(self):
        super().initialize_options()
        (SOURCE / "build").mkdir(exist_ok=True)
        self.egg_base = str(SOURCE / "build")


version = re.search(r"project\(drape VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
setup(
    version=version,
    packages=[],
    py_modules=[],
    ext_modules=[Extension("drape._drape", [])],  # so that the wheel is one of this platform
    cmdclass={"build_ext": Build, "egg_info": EggInfo},
    zip_safe=False,
)
