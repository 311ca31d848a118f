#!/usr/bin/env python3
"""The tools of this folder refuse what they are there to refuse: a page with a mistake of each kind, one at a time.
    test_tools.py DRAPE"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

here = Path(__file__).resolve().parent
drape = None


def tool(name, *words):
    result = subprocess.run([sys.executable, here / name, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return result.returncode, result.stdout


class Pages(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def page(self, text, name="page.md"):
        path = self.folder / name
        path.write_text(text)
        return path

    def blocks(self, text):
        root, build = here.parent.parent, Path(drape).parent
        return tool("run_blocks.py", "--source", root, "--build", build, "--work", self.folder / "work", self.page(text))

    def refused(self, text, what):
        code, said = self.blocks(text)
        self.assertNotIn(code, (0, 77), said)
        self.assertIn(what, said)

    def test_what_runs(self):
        code, said = self.blocks("""
<!-- file: small.toml -->
```toml
[[cloth]]
mesh = "data/meshes/sheet-625.obj"
```
```toml
[[obstacle]]
shape = "plane"
```
```sh
drape check small.toml
build/release/drape --version
```
<!-- output -->
```text
drape ...
```
<!-- exit: 2 -->
```sh
drape check none.toml
```
<!-- not run: a reason -->
```sh
false
```
```python
from pathlib import Path
assert Path("small.toml").exists()
```
""")
        self.assertEqual(code, 0, said)
        self.assertIn("page.md:25: a reason", said)

    def test_command_that_fails(self):
        self.refused("```sh\ntrue\nfalse\ntrue\n```\n", "page.md:2: sh block: bash ended with 1")

    def test_command_that_does_not_fail(self):
        self.refused("<!-- exit: 2 -->\n```sh\ntrue\n```\n", "expected 2")

    def test_output_that_is_another(self):
        self.refused("```sh\necho one two\n```\n<!-- output -->\n```text\none three\n```\n", "was not printed: one three")

    def test_output_in_another_order(self):
        self.refused("```sh\nprintf 'a\\nb\\n'\n```\n<!-- output -->\n```text\nb\na\n```\n", "was not printed: a")

    def test_unknown_language(self):
        self.refused("```perl\nprint 1\n```\n", "nobody knows how to run 'perl'")

    def test_no_language(self):
        self.refused("```\nls\n```\n", "nobody knows how to run ''")

    def test_indented_block(self):
        self.refused("Then\n\n    drape list\n", "page.md:3: a block without a fence")

    def test_unknown_key_of_a_scene(self):
        self.refused('```toml\n[[obstacle]]\nshape = "plane"\nfrction = 1\n```\n', "unknown key 'frction'")

    def test_python(self):
        self.refused("text\n```python\nx = 1\n```\n```python\nassert x == 2\n```\n", "line 6")

    def test_module_that_is_not_there(self):
        code, said = self.blocks("```python\nraise ModuleNotFoundError(\"No module named 'bpy'\", name='bpy')\n```\n")
        self.assertEqual(code, 77, said)
        self.assertIn("SKIPPED", said)
        self.refused("```python\nimport no_such_module\n```\n", "no_such_module")

    def test_file_that_nobody_uses(self):
        self.refused("```json\n{}\n```\n", "neither a file")

    def test_program_without_main(self):
        self.refused("```cpp\nint x;\n```\n", "has no main()")

    def test_comment_that_nobody_knows(self):
        self.refused("<!-- notrun: x -->\n```sh\ntrue\n```\n", "nobody knows the comment 'notrun'")

    def test_fence_without_an_end(self):
        self.refused("```sh\ntrue\n", "the fence has no end")

    def test_links(self):
        self.page("# A heading, with `code`\n", "other.md")
        self.page("[a](other.md#a-heading-with-code) [b](https://nobody.invalid/x) ![c](other.md) `[d](gone.md)`\n")
        self.assertEqual(tool("check_links.py", self.folder)[0], 0)
        self.page("[a](gone.md)\n")
        self.assertIn("gone.md: there is no such file", tool("check_links.py", self.folder)[1])
        self.page("[a](other.md#a-heading)\n")
        code, said = tool("check_links.py", self.folder)
        self.assertEqual(code, 1)
        self.assertIn("no heading of", said)

    def test_requests(self):
        self.page('<a href="https://elsewhere.invalid/">x</a><link rel="stylesheet" href="a.css"><img src="b.png">', "a.html")
        self.page("p { background: url(b.png) }", "a.css")
        self.assertEqual(tool("check_site.py", self.folder)[0], 0)
        for text in ('<script src="https://cdn.invalid/x.js"></script>', '<img src="//cdn.invalid/x.png">',
                     '<link rel="stylesheet" href="https://fonts.invalid/css">', "<style>@import 'https://x.invalid/a.css';</style>",
                     '<p style="background: url(http://x.invalid/a.png)">', '<img srcset="a.png 1x, https://x.invalid/b.png 2x">'):
            self.page(text, "b.html")
            self.assertEqual(tool("check_site.py", self.folder)[0], 1, text)
        self.page("p", "b.html")
        self.page("@import url(/javascript/a.css);", "b.css")
        self.assertEqual(tool("check_site.py", self.folder)[0], 1)

    def test_parts_made_by_commands(self):
        page = self.page("before\n<!-- made by: drape keys spin --markdown -->\nold\n<!-- end -->\nafter\n")
        self.assertEqual(tool("made.py", "--program", drape, page)[0], 1)
        self.assertEqual(tool("made.py", "--program", drape, "--write", page)[0], 0)
        self.assertEqual(tool("made.py", "--program", drape, page)[0], 0)
        self.assertIn("| `rate` | a rate of turning | rad/s | **required** |", page.read_text())
        self.assertTrue(page.read_text().startswith("before\n<!--") and page.read_text().endswith("<!-- end -->\nafter\n"))


drape = sys.argv.pop()
unittest.main()
