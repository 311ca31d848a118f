# How Sphinx makes the pages a site; docs/README.md says why Sphinx. Nothing in it comes from the network.
project = "drape"
author = "the drape authors"
project_copyright = author
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["README.md"]
myst_heading_anchors = 4
myst_enable_extensions = []
html_theme = "furo"
html_title = "drape"
html_show_sphinx = False
html_copy_source = False
html_permalinks_icon = "#"
highlight_language = "none"
nitpicky = True
