"""A section of the report, as its module registers it: the bar, the contents, the pages of a long
report and what is read for it follow from this."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from data.results import Run
from data.trials import Trial


@dataclass(frozen=True)
class Source:
    """Where a section reads from: the folder of the run, and what was read of it so far."""

    folder: Path
    run: Run
    trial: Trial | None  # of another solver, or of frames
    shipped: Path | None  # cases whose records belong to this run; None: they are not its own


def nothing(_: Source) -> None:
    """For a section that shows the run alone."""


@dataclass(frozen=True)
class Section:
    """A part of the page, and a page of its own where the report is long. The macro `section` of
    its template NAME.html.j2 writes it."""

    name: str  # of its anchor, its template and its page
    title: str | Callable[[Any], str]  # of its page and in the contents; may depend on the Page
    shown: Callable[[Any], Any]  # of a Page: whether there is anything to show
    link: str = ""  # in the bar, where the title is too long for it
    read: Callable[[Source], Any] = nothing  # becomes page.parts[name]

    def title_on(self, page: Any) -> str:
        return self.title if isinstance(self.title, str) else self.title(page)
