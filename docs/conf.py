# How Sphinx makes the pages a site; docs/README.md says why Sphinx. Nothing in it comes from the network.
project = "drape"
author = "the drape authors"
project_copyright = author
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "docs/index"  # the pages of the whole project belong to it, so that links between them hold
exclude_patterns = ["build", "out", ".*", "**/node_modules"]
myst_heading_anchors = 4
myst_enable_extensions = []
html_theme = "furo"
html_title = "drape"
templates_path = ["templates"]
html_sidebars = {"**": ["sidebar/brand.html", "sidebar/search.html", "sidebar/scroll-start.html", "sidebar/navigation.html",
                        "interface.html", "sidebar/scroll-end.html"]}
html_static_path = ["static"]
html_css_files = ["wide.css"]
smartquotes = False  # texts in quotes are what is to be written
html_show_sphinx = False
html_copy_source = False
html_permalinks_icon = "#"
highlight_language = "none"
nitpicky = True
