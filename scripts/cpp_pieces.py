"""The pieces of a C++ file: comments, preprocessor lines, literals, white space, other tokens."""

import re
from collections.abc import Iterator
from typing import NamedTuple


class Piece(NamedTuple):
    kind: str  # comment, directive, text, space, word, number or sign
    text: str
    at: int  # where it begins in the file

    @property
    def end(self) -> int:
        return self.at + len(self.text)


CODE = ("text", "word", "number", "sign")
PIECE = re.compile(r"""
    (?P<comment>//(?:[^\n\\]|\\.)*|/\*.*?\*/)
  | (?P<directive>^[ \t]*\#(?:(?!//)[^\n\\]|\\.|\\\n)*)
  | (?P<text>R"(?P<mark>[^()\s\\]*)\(.*?\)(?P=mark)"|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+')
  | (?P<space>\s+)
  | (?P<word>[A-Za-z_]\w*)
  | (?P<number>(?:0x[\da-fA-F.]+(?:p[+-]?\d+)?
                |\d[\d']*\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)[uUlLfF]*)
  | (?P<sign><=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)
""", re.X | re.S | re.M)


def pieces_of(text: str) -> Iterator[Piece]:
    """Together they are the whole text."""
    for found in PIECE.finditer(text):
        yield Piece(str(found.lastgroup), found.group(), found.start())
