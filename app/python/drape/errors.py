"""What may go wrong, besides a ValueError for a mistake in what was given."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._drape import StepReport


class StepError(RuntimeError):
    """A step failed; the state is as it was before. `report` says why and where."""

    report: StepReport
