"""The viewer's page inside a notebook."""

from __future__ import annotations

import html
import os
from pathlib import Path
from typing import Union


class View:
    """A page that plays a run. A notebook shows it; `save` writes it for a browser."""

    def __init__(self, page: str, width: str = "100%", height: int = 600) -> None:
        self.page = page
        self.width = width
        self.height = height

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        Path(path).write_text(self.page, encoding="utf-8")

    def _repr_html_(self) -> str:
        # In a frame of its own, so that neither page's styles and scripts touch the other's.
        return (
            f'<iframe srcdoc="{html.escape(self.page, quote=True)}" width="{html.escape(self.width)}" '
            f'height="{int(self.height)}" style="border: 0" allowfullscreen></iframe>'
        )

    def __repr__(self) -> str:
        return f"View({len(self.page) / 1e6:.1f} MB; a notebook shows it, save(path) writes it for a browser)"
