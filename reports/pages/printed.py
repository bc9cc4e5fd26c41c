"""A page on paper: PDF with an outline and page numbers, made by Chromium."""
from __future__ import annotations

import re
from pathlib import Path

from data.whole_file import write_whole
from pages.chromium import Browser

_LINE = (
    '<div style="font: 7pt sans-serif; color: #5d656e; width: 100%; padding: 0 16mm; display: flex;'
    ' justify-content: space-between"><span class="title"></span><span><span'
    ' class="pageNumber"></span> of <span class="totalPages"></span></span></div>'
)
_DATE = re.compile(rb"/(CreationDate|ModDate) \(D:\d{14}")
_NO_DATE = b"19700101000000"
# names of parts: the browser numbers them from what it did before
_NODE = re.compile(rb"\(node(\d{8})\)")


def print_page(page: Path, out: Path) -> Path:
    """Prints an HTML file into a PDF file. Throws NoBrowser if there is
    no Chromium, or if it gives up."""
    with Browser() as browser:
        browser.open(page, script=False)
        content = browser.pdf("<span></span>", _LINE)
    write_whole(out, same_each_time(content))
    return out


def same_each_time(content: bytes) -> bytes:
    """A PDF without the moment of its printing, and with its parts numbered from 0
    in their order; nothing moves."""
    ranks = {
        number: b"(node%08d)" % k for k, number in enumerate(sorted(set(_NODE.findall(content))))
    }
    content = _DATE.sub(lambda found: b"/" + found[1] + b" (D:" + _NO_DATE, content)
    return _NODE.sub(lambda found: ranks[found[1]], content)
