"""Where a text stands in a C++ file, however the two are laid out.

White space does not count. Nor do the marks of a continuation: where a string literal ends and the
next line begins another, and the // of a line that holds only a comment.
"""

import functools
import re

LAYOUT = re.compile(r'"\s*\n\s*"|(?:\A|\n)\s*//+|\s+')


@functools.cache
def condensed(text: str) -> tuple[str, list[int]]:
    """The characters that count, and where in the text each of them stands."""
    places: list[int] = []
    start = 0
    for gap in LAYOUT.finditer(text):
        places.extend(range(start, gap.start()))
        start = gap.end()
    places.extend(range(start, len(text)))
    return "".join(text[place] for place in places), places


def occurrences(text: str, find: str) -> list[slice]:
    """Each part of the text that reads as `find`."""
    read, places = condensed(text)
    sought, _ = condensed(find)
    starts = [found.start() for found in re.finditer(re.escape(sought), read)] if sought else []
    return [slice(places[start], places[start + len(sought) - 1] + 1) for start in starts]


def replaced(text: str, part: slice, by: str) -> str:
    return text[:part.start] + by.strip() + text[part.stop:]
