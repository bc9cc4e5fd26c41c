"""A page on paper: PDF with an outline and page numbers, made by Chromium."""
from __future__ import annotations

import re
from pathlib import Path

from browser import Browser
from whole_file import write_whole

_LINE = ('<div style="font: 7pt sans-serif; color: #5d656e; width: 100%; padding: 0 16mm; display: flex; '
         'justify-content: space-between"><span class="title"></span><span><span class="pageNumber"></span> of '
         '<span class="totalPages"></span></span></div>')
_DATE = re.compile(rb"/(CreationDate|ModDate) \(D:\d{14}")
_NO_DATE = b"19700101000000"


def print_page(page: Path, out: Path) -> Path:
    """Prints an HTML file into a PDF file. Throws NoBrowser if there is no Chromium, or if it gives up."""
    with Browser() as browser:
        browser.open(page, script=False)
        content = browser.pdf("<span></span>", _LINE)
    # the moment of printing says nothing about the run
    write_whole(out, _DATE.sub(lambda found: b"/" + found[1] + b" (D:" + _NO_DATE, content))
    return out
