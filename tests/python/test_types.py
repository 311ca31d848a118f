"""The stubs say what the module has, and the examples are typed as the stubs say."""

import os
import shutil
import subprocess
import unittest
from pathlib import Path

from workshop import SOURCE, Workshop

import drape

PYTHON = "/usr/bin/python3"  # Debian's mypy is a package of this one


@unittest.skipUnless(shutil.which("mypy", path="/usr/bin"), "mypy is not installed (Debian package mypy)")
class Types(Workshop):
    def checked(self, *words):
        package = Path(drape.__file__).parent.parent
        done = subprocess.run([PYTHON, "-m", *words], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "MYPYPATH": str(package), "PYTHONPATH": str(package)})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_stubs_are_the_module(self):
        # Classes without a constructor have one of pybind11's that refuses everything.
        (self.folder / "allowed").write_text(r"drape\._drape\.\w+\.__init__" + "\n")
        self.checked("mypy.stubtest", "drape._drape", "--allowlist", "allowed", "--ignore-unused-allowlist")

    def test_the_package_and_the_examples(self):
        examples = sorted(map(str, (SOURCE / "app/python/examples").glob("*.py")))
        self.assertGreater(len(examples), 3)
        self.checked("mypy", "--strict", "--ignore-missing-imports", "--cache-dir", "cache", *examples)

    def test_everything_has_a_docstring(self):
        missing = [name for name in drape.__all__ if not (getattr(drape, name).__doc__ or "").strip()]
        self.assertEqual(missing, [])


if __name__ == "__main__":
    unittest.main()
