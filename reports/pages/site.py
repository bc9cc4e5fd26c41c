"""The report as a first page and a folder of pages beside it. The template marks the parts that
become a page of their own; the finished text is cut there, and links lead to the page that holds
their target."""
from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass

from markupsafe import Markup, escape

FIRST = "report.html"
FOLDER = "report"  # of the other pages
SEARCHED = 20    # entries of a page that are searched, at least
_MARK = re.compile(r"<!--(page|end) (\d+)-->")
_ID = re.compile(r'\sid="([^"]+)"')
_LINK = re.compile(r'href="#([^"]+)"')
_HEADING = re.compile(r"(</?h)([1-6])\b")
_ENTRY_ID = re.compile(r'<(?:section|article|details|div|li|tr)\b[^>]*\sid="([^"]+)"')
_LEAD_ON = """
const pages = PAGES;
const leadOn = () => {
  const name = decodeURIComponent(location.hash.slice(1));
  if (!name || document.getElementById(name)) return;
  for (const [file, names] of Object.entries(pages))
    if (names.includes(name)) location.replace(`${file}#${encodeURIComponent(name)}`);
};
addEventListener("hashchange", leadOn);
leadOn();
"""
_ENTRY = re.compile(r'class="(?:claim-row|finding|fault|case|study)"|class="data rates"')


@dataclass(frozen=True)
class Cut:
    """A page that the template marked."""
    file: str          # from the folder of the first page
    title: str
    above: str         # file of the page that leads to it


class Cuts:
    """Marks in a text where pages begin and end; none where the report is one page."""

    def __init__(self, is_site: bool) -> None:
        self._is_site = is_site
        self.pages: list[Cut] = []

    def begin(self, name: str, title: str, above: str = "") -> Markup:
        """Begins the page NAME.html; "" where the report is one page."""
        if not self._is_site:
            return Markup("")
        self.pages.append(Cut(_file(name), title, _file(above) if above else FIRST))
        return Markup("<!--page {}-->").format(len(self.pages) - 1)

    def end(self, name: str) -> Markup:
        """Ends that page."""
        if not self._is_site:
            return Markup("")
        number = next(k for k, page in enumerate(self.pages) if page.file == _file(name))
        return Markup("<!--end {}-->").format(number)


def _file(name: str) -> str:
    return f"{FOLDER}/{name}.html"


def _way(here: str, there: str) -> str:
    """The link from one file to another."""
    return os.path.relpath(there, os.path.dirname(here) or ".")


def split(text: str, cuts: Cuts, viewer: str) -> dict[str, str]:
    """File names and texts of all pages, of the report as one text with marks."""
    start, stop = text.index("<main"), text.index("</main>")
    parts = _parts(text[start:stop], cuts.pages)
    head, foot = text[:start], text[stop:]
    before = head[:head.index("<header>")]
    inside = parts.pop(FIRST) + _contents(cuts.pages)
    whole = {FIRST: head + inside + _anchors_elsewhere(parts) + foot}
    for cut in cuts.pages:
        shown = '<main id="content">' + _levelled(parts[cut.file])
        scripts = f"<script>{viewer}</script>" if 'class="view"' in shown else ""
        whole[cut.file] = (
            _titled(before, cut.title) + _crumbs(cut, cuts.pages) + shown + scripts + foot
        )
    return _linked({file: _without_idle_search(page) for file, page in whole.items()})


def _anchors_elsewhere(parts: dict[str, str]) -> str:
    """A script that leads from report.html#NAME to the page on which the entry now stands."""
    ids = {file: _ENTRY_ID.findall(text) for file, text in parts.items()}
    listed = json.dumps({file: names for file, names in ids.items() if names})
    script = _LEAD_ON.replace("PAGES", listed.replace("</", "<\\/"))
    return f"<script>{script}</script>"


def _parts(text: str, pages: list[Cut]) -> dict[str, str]:
    """What stands on each page; where another page was cut out, a link to it."""
    open_pages, collected = [FIRST], {FIRST: [""]}
    at = 0
    for mark in _MARK.finditer(text):
        collected[open_pages[-1]].append(text[at:mark.start()])
        cut, at = pages[int(mark[2])], mark.end()
        if mark[1] == "page":
            collected[open_pages[-1]].append(
                _leads_to(open_pages[-1], cut) if open_pages[-1] != FIRST else ""
            )
            open_pages.append(cut.file)
            collected[cut.file] = []
        elif open_pages.pop() != cut.file:
            raise ValueError(f"{cut.file}: pages overlap")
    collected[open_pages[-1]].append(text[at:])
    return {file: "".join(pieces) for file, pieces in collected.items()}


def _leads_to(here: str, cut: Cut) -> str:
    way = _way(here, cut.file)
    return f'<p class="leads-to"><a href="{escape(way)}">{escape(cut.title)}</a></p>\n'


def _contents(pages: list[Cut]) -> str:
    """The contents of the report: its pages, and below each those that it leads to."""
    def listed(above: str) -> Iterator[str]:
        inside = [cut for cut in pages if cut.above == above]
        for cut in inside:
            below = "".join(listed(cut.file))
            yield (f'<li><a href="{escape(cut.file)}">{escape(cut.title)}</a>'
                   + (f"<ul>{below}</ul>" if below else "") + "</li>\n")
    return (
        '<section id="contents"><h2>Contents</h2>\n<ul'
        f' class="contents">{"".join(listed(FIRST))}</ul></section>\n'
    )


def _crumbs(cut: Cut, pages: list[Cut]) -> str:
    """The way back."""
    way, file = [], cut.above
    while file != FIRST:
        above = next(one for one in pages if one.file == file)
        way.append((above.file, above.title))
        file = above.above
    links = " › ".join(
        f'<a href="{escape(_way(cut.file, file))}">{escape(title)}</a>'
        for file, title in [(FIRST, "Report"), *reversed(way)]
    )
    return f'<header><p class="kicker crumbs">{links}</p></header>\n'


def _titled(before: str, title: str) -> str:
    return re.sub(
        r"<title>.*?</title>", lambda _: f"<title>{escape(title)}: foldproof</title>", before,
        count=1, flags=re.DOTALL
    )


def _levelled(text: str) -> str:
    """The text with its headings raised, so that the first is the page's title."""
    first = _HEADING.search(text)
    up = int(first[2]) - 1 if first else 0
    return _HEADING.sub(lambda found: f"{found[1]}{max(int(found[2]) - up, 1)}", text)


def _without_idle_search(page: str) -> str:
    """The search is for pages with many entries; others have none of its controls."""
    if len(_ENTRY.findall(page[page.index("<main"):])) >= SEARCHED:
        return page
    return re.sub(r'<form class="filter".*?</form>', "", page, count=1, flags=re.DOTALL)


def _linked(pages: dict[str, str]) -> dict[str, str]:
    """The pages with links to what stands on another one leading there."""
    ids = {file: set(_ID.findall(page)) for file, page in pages.items()}
    home = {name: file for file in reversed(pages) for name in ids[file]}

    def lead(file: str, name: str) -> str:
        is_here = name in ids[file] or name not in home
        return f"#{name}" if is_here else f"{_way(file, home[name])}#{name}"
    return {
        file: _LINK.sub(lambda found: f'href="{lead(file, found[1])}"', page)
        for file, page in pages.items()
    }
