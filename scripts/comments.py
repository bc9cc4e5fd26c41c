"""Comments of C++ files: fills paragraphs, and moves comments that do not fit behind their code.

Only paragraphs are filled. Formulas, tables and lists stay as they are, because their lines are
indented, have wide gaps, or begin with a mark such as `- `. Drawings stay too: lines next to these
that hold no word. A line that ends like a sentence, though the next word would fit, was ended by
hand and stays.
"""

import re
from typing import NamedTuple

from cpp_pieces import CODE, Piece, pieces_of

WIDTH = 100
STUB = 16  # a shorter last line looks lost
LINE = re.compile(r"(?P<indent>[ \t]*)(?P<mark>///?)(?P<text>.*)")


# ---- paragraphs ----------------------------------------------------------------------------------


def filled(text: str) -> str:
    """The file with its paragraphs filled."""
    own = lines_of_comments(text)
    lines = text.split("\n")
    result: list[str] = []
    block: list[str] = []
    for number, line in enumerate(lines):
        if block and (number not in own or prefix(line) != prefix(block[0])):
            result += filled_block(block)
            block = []
        if number in own:
            block.append(line)
        else:
            result.append(line)
    return "\n".join(result + filled_block(block))


def lines_of_comments(text: str) -> set[int]:
    """Numbers of the lines that hold a // comment and nothing else, counted from 0."""
    numbers, line, is_blank = set(), 0, True
    for piece in pieces_of(text):
        is_line = piece.text.startswith("//") and "\n" not in piece.text
        if piece.kind == "comment" and is_line and is_blank:
            numbers.add(line)
        line += piece.text.count("\n")
        is_blank = (is_blank or "\n" in piece.text) if piece.kind == "space" else False
    return numbers


def prefix(line: str) -> str:
    found = LINE.fullmatch(line)
    return found["indent"] + found["mark"]


def filled_block(lines: list[str]) -> list[str]:
    """Consecutive lines that begin alike. Filling may join two paragraphs, so it is repeated."""
    for _ in range(8):
        before, lines = lines, filled_once(lines)
        if lines == before:
            break
    return lines


def filled_once(lines: list[str]) -> list[str]:
    start = prefix(lines[0]) if lines else ""
    texts = [line[len(start):].rstrip() for line in lines]
    kept = kept_lines(texts)
    result: list[str] = []
    paragraph: list[str] = []
    for k, text in enumerate(texts):
        if paragraph and (kept[k] or ended_by_hand(start + paragraph[-1], text)):
            result += wrapped(start, paragraph)
            paragraph = []
        if kept[k]:
            result.append(start + text)
        else:
            paragraph.append(text)
    return result + wrapped(start, paragraph)


def kept_lines(texts: list[str]) -> list[bool]:
    """Which lines of a block stay as they are."""
    kept = [text.strip() == "" or is_laid_out(text) for text in texts]
    drawn = [text.strip() != "" and is_laid_out(text) for text in texts]
    for order in (range(len(texts)), range(len(texts) - 1, -1, -1)):  # downwards, then upwards
        for k in order:
            beside = [j for j in (k - 1, k + 1) if 0 <= j < len(texts)]
            if not kept[k] and is_sketch(texts[k]) and any(drawn[j] for j in beside):
                kept[k] = drawn[k] = True
    return kept


def is_laid_out(text: str) -> bool:
    """Does its layout mean something: indentation, wide gaps, a list, a table, a heading `//-`?"""
    laid_out = r"\S| \s| .*\S  +\S| ([-*|] |\|-|\d+\. |NOLINT|clang-format )"
    return re.match(laid_out, text) is not None


def is_sketch(text: str) -> bool:
    """Does it hold no word, so that it may be the edge of a drawing?"""
    return re.search(r"[A-Za-z]{2}", text) is None


def ended_by_hand(line: str, following: str) -> bool:
    return line.endswith((".", ":", ";")) and len(line) + 1 + len(words_of(following)[0]) <= WIDTH


def wrapped(start: str, paragraph: list[str]) -> list[str]:
    """The paragraph's lines, as long as possible; a little shorter if that avoids a stub."""
    words = words_of(" ".join(paragraph))
    widest = in_width(start, words, WIDTH)
    for width in range(WIDTH, WIDTH - 2 * STUB, -1):
        lines = in_width(start, words, width)
        pairs = zip(lines, lines[1:])
        ends_early = any(ended_by_hand(line, after[len(start):]) for line, after in pairs)
        if len(lines) == len(widest) > 1 and len(lines[-1]) >= len(start) + STUB and not ends_early:
            return lines
    return widest


def in_width(start: str, words: list[str], width: int) -> list[str]:
    lines: list[str] = []
    for word in words:
        if lines and len(lines[-1]) + 1 + len(word) <= width:
            lines[-1] += " " + word
        else:
            lines.append(f"{start} {word}")
    return lines


def words_of(text: str) -> list[str]:
    """Lines break between these. No line begins with an operator, or like an entry of a list."""
    words: list[str] = []
    for word in text.split():
        if words and re.fullmatch(r"[-+*/=<>|&]+|<=|>=|\d+\.", word):
            words[-1] += " " + word
        else:
            words.append(word)
    return words


# ---- comments behind code ------------------------------------------------------------------------


class Trailing(NamedTuple):
    """A comment behind code, with its continuation on the next lines."""

    at: int
    end: int
    text: str


def trailing_comments(text: str) -> list[Trailing]:
    found: list[Trailing] = []
    has_code = False
    for piece in pieces_of(text):
        if piece.kind == "comment" and piece.text.startswith("//"):
            if has_code and not piece.text.startswith("// namespace"):  # clang-format writes those
                found.append(Trailing(piece.at, piece.end, piece.text.rstrip()))
            elif found and goes_on(text, found[-1], piece):
                more = piece.text.lstrip("/").strip()
                found[-1] = found[-1]._replace(end=piece.end, text=f"{found[-1].text} {more}")
        elif piece.kind != "space":
            has_code = True
        if "\n" in piece.text:
            has_code = False
    return found


def goes_on(text: str, before: Trailing, piece: Piece) -> bool:
    """Does the comment stand right below the one before, in its column?"""
    between = text[before.end:piece.at]
    is_below = between.count("\n") == 1 and not between.strip()
    return is_below and column(text, piece.at) == column(text, before.at)


def column(text: str, at: int) -> int:
    return at - (text.rfind("\n", 0, at) + 1)


MARK = "//."


def shortened(text: str) -> str:
    """The file with a short mark in place of each comment behind code."""
    for comment in reversed(trailing_comments(text)):
        text = text[:comment.at] + MARK + text[comment.end:]
    return text


def put_back(text: str, comments: list[str]) -> str:
    """The marked file with its comments: behind the code where they fit, else above it."""
    marks = [piece for piece in pieces_of(text) if piece.text == MARK]
    assert len(marks) == len(comments), "clang-format moved a comment"
    code = [piece for piece in pieces_of(text) if piece.kind in (*CODE, "directive")]
    edits: list[tuple[int, int, str]] = []
    for mark, comment in zip(marks, comments):
        edits += placed(text, code, mark, comment)
    for at, end, new in sorted(reversed(edits), key=lambda edit: edit[0], reverse=True):
        text = text[:at] + new + text[end:]
    return text


def placed(text: str, code: list[Piece], mark: Piece, comment: str) -> list[tuple[int, int, str]]:
    """Edits (start, end, new text) that put one comment back."""
    start = text.rfind("\n", 0, mark.at) + 1
    line = text[start:mark.at].rstrip()
    if not line:  # clang-format moved it to its own line
        return [(mark.at, mark.end, comment)]
    last = max(k for k in range(len(code)) if code[k].at < mark.at)
    first = code[first_of_item(code, last)]
    if len(line) + 2 + len(comment) <= WIDTH and not was_broken(text, first, mark):
        return [(start + len(line), mark.end, f"  {comment}")]
    if line.lstrip().startswith("}") and line.endswith("{"):  # `} else {`: it goes below
        return [(start + len(line), mark.end, f"\n{comment}")]
    above = text.rfind("\n", 0, first.at) + 1
    indent = text[above:first.at] if not text[above:first.at].strip() else ""
    return [(above, above, f"{indent}{comment}\n"), (start + len(line), mark.end, "")]


def was_broken(text: str, first: Piece, mark: Piece) -> bool:
    """Would the statement fit on one line without the mark?"""
    statement = text[first.at:mark.at].rstrip()
    width = column(text, first.at) + len(re.sub(r"\s+", " ", statement))
    return "\n" in statement and width <= WIDTH < width + len(f"  {MARK}")


def first_of_item(code: list[Piece], last: int) -> int:
    """The first piece of the statement, or of the entry of a list, that ends with code[last]."""
    if code[last].kind == "directive":
        return last
    follows = code[last + 1].text if last + 1 < len(code) else ""
    is_entry = code[last].text == "," or (follows in ("}", ")") and code[last].text != ";")
    depth = 0
    for k in range(last - 1, -1, -1):
        if depth == 0 and (begins_after(code, k) or (is_entry and code[k].text == ",")):
            return k + 1
        depth += {"}": 1, ")": 1, "]": 1, "{": -1, "(": -1, "[": -1}.get(code[k].text, 0)
    return 0


def begins_after(code: list[Piece], k: int) -> bool:
    """Does a statement, or the first entry of a list, begin after code[k]?"""
    piece, follows = code[k].text, code[k + 1]
    if piece == "}":
        return follows.kind == "word" and follows.text not in ("else", "while", "catch")
    is_access = piece == ":" and code[k - 1].text in ("public", "private", "protected")
    return piece in (";", "{", "(", "[") or code[k].kind == "directive" or is_access
