"""The viewer's page inside a notebook."""

from __future__ import annotations

import html
import os
from pathlib import Path
from typing import Union

RUN_FILES = {"run.json", "steps.csv", "bodies.csv"}
RUN_ENDINGS = {".obj", ".pc2", ".npy"}
MARK = b'<meta name="generator" content="drape view">'  # of every page of drape


class View:
    """A page that plays a run. A notebook shows it; `save` writes it for a browser."""

    def __init__(self, page: str, width: str = "100%", height: int = 600) -> None:
        self.page = page
        self.width = width
        self.height = height

    def save(self, path: Union[str, "os.PathLike[str]"], force: bool = False) -> None:
        """Writes the page. ValueError when there is a file that is no page of drape, unless forced, or when the name is
        one of a run's own files, such as run.json or sheet.obj."""
        file = Path(path)
        if file.name in RUN_FILES or file.suffix in RUN_ENDINGS:
            raise ValueError(f"{file}: is a name of a run's own files, which are not replaced; choose another")
        if not force and file.exists() and MARK not in file.read_bytes()[:1000]:
            raise ValueError(f"{file}: is there already, and is no page of drape; choose another, or force=True")
        file.write_text(self.page, encoding="utf-8")

    def _repr_html_(self) -> str:
        # In a frame of its own, so that neither page's styles and scripts touch the other's.
        return (
            f'<iframe srcdoc="{html.escape(self.page, quote=True)}" width="{html.escape(self.width)}" '
            f'height="{int(self.height)}" style="border: 0" allowfullscreen></iframe>'
        )

    def __repr__(self) -> str:
        return f"View({len(self.page) / 1e6:.1f} MB; a notebook shows it, save(path) writes it for a browser)"
