"""The viewer's page inside a notebook, tested without one."""

import html.parser
import unittest

from workshop import Workshop

import drape

PAGE = "<!doctype html><title>\"a\" & 'b'</title><script>if (1 < 2 && '\u00e9') run(\"x\");</script>"


class Frame(html.parser.HTMLParser):
    """What a browser makes of the text: the one iframe's attributes, and nothing else."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self.attributes = [], [], {}
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes = dict(attrs)

    def handle_data(self, data):
        self.texts.append(data)


class Views(Workshop):
    def test_the_page_arrives_as_it_was(self):
        frame = Frame(drape.View(PAGE, height=321)._repr_html_())
        self.assertEqual((frame.tags, frame.texts), (["iframe"], []))
        self.assertEqual(frame.attributes["srcdoc"], PAGE)
        self.assertEqual(frame.attributes["height"], "321")

    def test_a_file_that_is_no_page_is_not_replaced(self):
        mine = self.folder / "mine.py"
        mine.write_text("keep = True\n")
        with self.assertRaisesRegex(ValueError, "mine.py: is there already, and is no page of drape"):
            drape.View(PAGE).save(mine)
        self.assertEqual(mine.read_text(), "keep = True\n")
        drape.View(PAGE).save(mine, force=True)
        self.assertEqual(mine.read_text(encoding="utf-8"), PAGE)
        for name in ("run.json", "steps.csv", "sheet.obj", "sheet.pc2"):
            with self.assertRaisesRegex(ValueError, "a run's own files"):
                drape.View(PAGE).save(self.folder / name, force=True)
        page = self.folder / "page.html"
        for height in (100, 200):  # a page of drape may be replaced
            drape.View('<meta name="generator" content="drape view">' + str(height)).save(page)
        self.assertTrue(page.read_text().endswith("200"))

    def test_a_page_can_be_saved(self):
        drape.View(PAGE).save(self.folder / "page.html")
        self.assertEqual((self.folder / "page.html").read_text(encoding="utf-8"), PAGE)

    def test_a_simulation_can_be_looked_at(self):
        simulation = drape.read_scene(self.folder / "scene.toml")
        if not drape.has_viewer():
            with self.assertRaisesRegex(ValueError, "viewer"):
                simulation.view()
            self.skipTest("the viewer is not in this build")
        self.assertIn("<html", simulation.view().page)  # as it stands
        simulation.run(0.1)
        self.assertEqual(simulation.view().page, drape.view_html(simulation.folder))
        simulation.run(0.1, out=self.folder / "o")
        view = simulation.view()
        self.assertEqual(view.page, drape.view_html(self.folder / "o"))
        self.assertEqual(Frame(view._repr_html_()).attributes["srcdoc"], view.page)


if __name__ == "__main__":
    unittest.main()
