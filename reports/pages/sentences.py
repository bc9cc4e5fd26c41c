"""Sentences whose numbers and quotations come from the results of a run, and carry the place they
come from. The words between them hold no digits, so that no number on a
page can be anything but data."""
from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from markupsafe import Markup, escape

from data.formulas import formula_html
from data.quantities import quantity_html, quantity_text


@dataclass(frozen=True)
class Number:
    """A value of the run with its unit, and where it stands in the results."""
    value: float
    unit: str
    source: str                    # "finding NAME", "study NAME: TITLE", "findings that hold"


@dataclass(frozen=True)
class Quoted:
    """Words of the run: a name, a statement, a date. `anchor` leads to it
    on the page; "" leads nowhere."""
    text: str
    source: str
    anchor: str = ""
    is_name: bool = False          # set as code in Markdown


Piece = str | Number | Quoted


def count_of(value: int, source: str) -> Number:
    """How many of something there are."""
    return Number(value, "1", source)


@dataclass(frozen=True)
class Conclusion:
    """What a run shows, in plain words: the answer, what it rests on, what to do."""
    headline: list[Piece]
    rest: list[Piece] = field(default_factory=list)
    advice: list[Piece] = field(default_factory=list)


def html_of(pieces: Iterable[Piece]) -> Markup:
    """The sentence for a page."""
    return Markup("").join(_html(piece) for piece in pieces)


def markdown_of(pieces: Iterable[Piece]) -> str:
    """The sentence for a pull request."""
    return "".join(_markdown(piece) for piece in pieces)


def in_words(items: list[list[Piece]], between: str = ", ", last: str = " and ") -> list[Piece]:
    """"a, b and c" """
    joined: list[Piece] = []
    for k, item in enumerate(items):
        joined += [last if k == len(items) - 1 else between] if k else []
        joined += item
    return joined


def escaped_markdown(text: str) -> str:
    """Text in which no sign means anything to Markdown or HTML; on one line."""
    one_line = " ".join(text.split())
    return re.sub(r"([\\`*_\[\]<>#|&~@$])", r"\\\1", one_line)


def _html(piece: Piece) -> Markup:
    if isinstance(piece, Number):
        return quantity_html(piece.value, piece.unit)
    if isinstance(piece, Quoted):
        text = piece.text if piece.is_name else formula_html(piece.text)
        said = Markup('<span class="quoted">{}</span>').format(text)
        return Markup('<a href="#{}">{}</a>').format(piece.anchor, text) if piece.anchor else said
    return escape(piece)


def _markdown(piece: Piece) -> str:
    if isinstance(piece, Number):
        return quantity_text(piece.value, piece.unit)
    if isinstance(piece, Quoted):
        # a name in code may hold anything but the sign that ends it
        return (
            f"`{' '.join(piece.text.replace('`', ' ').split())}`"
            if piece.is_name
            else escaped_markdown(piece.text)
        )
    return piece
