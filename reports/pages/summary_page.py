"""The page of verdict alone: HTML, and Markdown for a pull request."""
from __future__ import annotations

import re

from pages.page import Page, new_environment, summary_of_page
from pages.sentences import Piece
from pages.summary_markdown import TITLE, summary_markdown

_LINK = re.compile(r'<a href="#[^"]*"[^>]*>(.*?)</a>', re.DOTALL)


def render_summary(page: Page, since: list[Piece] | None = None) -> tuple[str, str]:
    """The page as one HTML text that needs nothing beside it and has no links, as there is nothing
    to lead to; and as Markdown."""
    environment = new_environment()
    summary = summary_of_page(page, since, environment)
    text = environment.get_template("summary_page.html.j2").render(summary=summary, title=TITLE)
    return _LINK.sub(r'<span class="quoted">\1</span>', text), summary_markdown(summary)
