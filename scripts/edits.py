"""Small edits of a C++ file, one slip each: an operator, a number, a name taken for its neighbour,
a statement left out.

Edits are made of the tokens of the code, never in comments, texts, preprocessor lines or template
arguments. What tells an operator from a type's `*`, `&` and `<` is the layout that .clang-format
asks for: operators of two operands have spaces on both sides.
"""

import random
import re
from collections.abc import Iterator
from typing import NamedTuple

from cpp_pieces import Piece, pieces_of


class Change(NamedTuple):
    at: int  # where it begins in the file
    before: str
    after: str
    kind: str  # operator, sign, number, name, bound or removal


def tokens_of(text: str) -> list[Piece]:
    """The code's tokens, but those in template argument lists."""
    tokens = [piece for piece in pieces_of(text) if piece.kind in ("word", "number", "sign")]
    return list(outside_templates(text, tokens))


def outside_templates(text: str, tokens: list[Piece]) -> Iterator[Piece]:
    """Leaves out `<...>` where no space stands before the `<`, or the word template does."""
    depth = 0
    for before, token in zip([None, *tokens], tokens):
        name = before.text if before else ""
        opens = (token.text == "<" and name != "operator"
                 and (not text[token.at - 1].isspace() or name == "template"))
        if opens or (depth and token.text == "<"):
            depth += 1
        elif not depth:
            yield token
        else:
            depth -= {">": 1, ">>": 2}.get(token.text, 0)


# ---- what can slip -------------------------------------------------------------------------------

OPERATORS = {
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["*"], "<": ["<=", ">"], "<=": ["<", ">="],
    ">": [">=", "<"], ">=": [">", "<="], "==": ["!="], "!=": ["=="], "&&": ["||"], "||": ["&&"],
    "+=": ["-=", "="], "-=": ["+=", "="], "*=": ["/="], "/=": ["*="]
}
NAMES = [pair.split("/") for pair in """
    min/max sin/cos asin/acos true/false front/back first/last begin/rbegin lower/upper
    lower_/upper_ lower_squared_/upper_squared_ x/v a/b A/B X/V wa/wb here/there now/next
    before/after mass/inverse_mass velocity/acceleration start/end from/until near/far p/q l/r
    cwiseMin/cwiseMax minCoeff/maxCoeff left/right w/v floor/ceil row/col size/count
    theta/rest_angle E/N normal/velocity exact/semidefinite rest/current break/continue
    extension/compression""".split()]
NEIGHBOURS = {name: other for pair in NAMES for name, other in (pair, pair[::-1])}
VALUES = {"0": ["1"], "0.0": ["1.0"], "1": ["2", "0"], "2": ["1", "3"], "0.5": ["0.6"]}
# there without being named
LANGUAGE = {"min", "max", "sin", "cos", "asin", "acos", "true", "false", "break", "continue"}
UNARY_AFTER = {
    "(", ",", "=", "return", "[", "{", "?", ":", "&&", "||", "+", "*", "/", "<", ">", "<=", ">=",
    "+=", "-="
}


def changes_of(text: str) -> list[Change]:
    """Every edit that can be made, in the order of the file."""
    tokens = tokens_of(text)
    found: set[Change] = set()
    for k in range(len(tokens)):
        found.update(of_operator(text, tokens, k), of_unary(text, tokens, k),
                     of_number(tokens, k), of_name(text, tokens, k))
    found.update(of_bounds(tokens))
    found.update(removals(text, tokens))
    return sorted(change for change in found if not asks_for_memory(text, change))


def asks_for_memory(text: str, change: Change) -> bool:
    """Is it in a call of reserve(), or the number of rows of a PerParticle3, which has three rows
    whatever the number says? Results do not depend on those."""
    line = place_of(text, change)[1]
    before = text[text.rfind("\n", 0, change.at) + 1:change.at]
    is_rows = change.before == "3" and text[change.at + 1:].startswith(", ")
    makes_vectors = re.search(r"\bPerParticle3\b[^;]*\($", before) is not None
    return ".reserve(" in line or (is_rows and makes_vectors)


def is_spaced(text: str, token: Piece) -> bool:
    end = token.at + len(token.text)
    return text[token.at - 1].isspace() and text[end].isspace()


def of_operator(text: str, tokens: list[Piece], k: int) -> Iterator[Change]:
    token = tokens[k]
    if (token.kind == "sign" and k > 0 and tokens[k - 1].text != "operator"
            and is_spaced(text, token)):
        for after in OPERATORS.get(token.text, []):
            yield Change(token.at, token.text, after, "operator")


def of_unary(text: str, tokens: list[Piece], k: int) -> Iterator[Change]:
    """A minus or a `not` that is left out, a step the other way."""
    token, before = tokens[k], tokens[k - 1].text if k > 0 else ""
    if token.text in ("++", "--"):
        yield Change(token.at, token.text, "--" if token.text == "++" else "++", "sign")
    elif token.text == "!" or (token.text == "-" and before in UNARY_AFTER
                               and not is_spaced(text, token)):
        yield Change(token.at, token.text, "", "sign")


def of_number(tokens: list[Piece], k: int) -> Iterator[Change]:
    token = tokens[k]
    if token.kind != "number":
        return
    for after in VALUES.get(token.text) or [other_number(token.text)]:
        yield Change(token.at, token.text, after, "number")


def other_number(text: str) -> str:
    """The next whole number; of others a fifth more, or a thousand times as
    much where they are very small."""
    if re.fullmatch(r"\d+", text):
        return str(int(text) + 1)
    try:
        value = float(text.replace("'", ""))
    except ValueError:
        return f"({text} + 1)"
    return f"{(1000 if 0 < value < 1e-5 else 1.2) * value:.15g}"


def of_name(text: str, tokens: list[Piece], k: int) -> Iterator[Change]:
    """A name taken for its neighbour: min for max, x1 for x2 where there is
    an x2. Not where it is declared."""
    token = tokens[k]
    before = tokens[k - 1] if k > 0 else token
    follows = tokens[k + 1].text if k + 1 < len(tokens) else ""
    is_second = before.text == "," and follows == "="  # of several that one type declares
    is_of_type = before.kind == "word" and before.text not in ("return", "throw")
    is_reference = before.text in ("&", "&&", "*") and not is_spaced(text, before)
    if token.kind != "word" or is_of_type or is_second or is_bound(tokens, k) or is_reference:
        return
    known = {other.text for other in tokens}
    numbered = re.fullmatch(r"([A-Za-z_]*[A-Za-z_])([1-9])", token.text)
    others = [f"{numbered[1]}{(int(numbered[2]) + step)}" for step in (-1, 1)] if numbered else []
    others += [NEIGHBOURS[token.text]] if token.text in NEIGHBOURS else []
    for after in others:
        if after in known or token.text in LANGUAGE:
            yield Change(token.at, token.text, after, "name")


def is_bound(tokens: list[Piece], k: int) -> bool:
    """Is tokens[k] one of the names of `auto [a, b]`?"""
    for i in range(k - 1, 0, -1):
        if tokens[i].text == "[":
            return tokens[i - 1].text in ("auto", "&") and tokens[i - 2].text != ")"
        if tokens[i].kind != "word" and tokens[i].text != ",":
            return False
    return False


def of_bounds(tokens: list[Piece]) -> Iterator[Change]:
    """`for (...; i < n; ...)`: one turn less."""
    for k, token in enumerate(tokens):
        if token.text != "for":
            continue
        ends = [i for i in range(k, min(k + 60, len(tokens))) if tokens[i].text == ";"][:2]
        if (len(ends) == 2 and tokens[ends[1] - 1].kind == "word"
                and tokens[ends[1] - 2].text in ("<", "<=")):
            bound = tokens[ends[1] - 1]
            yield Change(bound.at, bound.text, f"{bound.text} - 1", "bound")


DEPTHS = {"(": 1, ")": -1, "[": 1, "]": -1, "{": 1, "}": -1}
KEPT = {
    "return", "using", "for", "while", "do", "else", "case", "default", "template", "struct",
    "class", "namespace", "const", "constexpr", "static", "auto", "switch", "try", "catch",
    "public", "private", "enum"
}


def removals(text: str, tokens: list[Piece]) -> Iterator[Change]:
    """Statements that can be left out: calls, assignments, and an `if` with what
    hangs on it, on one statement."""
    inside = inner_brackets(tokens)
    for k in range(1, len(tokens)):
        begins = tokens[k - 1].text in (";", "{", "}") or closes_condition(tokens, k - 1)
        is_word = tokens[k].kind == "word" or tokens[k].text in ("++", "--")
        if inside[k] == "(" or not begins or tokens[k].text in KEPT or not is_word:
            continue
        end = statement_end(tokens, k)
        if end and (tokens[k].text in ("if", "throw", "continue", "break")
                    or is_action(tokens[k:end])):
            at, stop = tokens[k].at, tokens[end].at
            yield Change(at, text[at:stop + 1], ";", "removal")


def inner_brackets(tokens: list[Piece]) -> list[str]:
    """For each token the innermost bracket that is open before it; "" if there is none."""
    stack, inner = [""], []
    for token in tokens:
        inner.append(stack[-1])
        step = DEPTHS.get(token.text, 0)
        if step > 0:
            stack.append(token.text)
        elif step < 0 and len(stack) > 1:
            stack.pop()
    return inner


def closes_condition(tokens: list[Piece], k: int) -> bool:
    """Is tokens[k] the `)` of an if or a for?"""
    if tokens[k].text != ")":
        return False
    depth = 0
    for i in range(k, -1, -1):
        depth -= DEPTHS.get(tokens[i].text, 0)
        if depth == 0:
            return i > 0 and tokens[i - 1].text in ("if", "for", "while")
    return False


def statement_end(tokens: list[Piece], k: int) -> int | None:
    """Where its `;` stands; None where a block or another function comes first."""
    depth = 0
    for i in range(k, len(tokens)):
        depth += DEPTHS.get(tokens[i].text, 0)
        if depth < 0:
            return None
        follows = tokens[i + 1].text if i + 1 < len(tokens) else ""
        if depth == 0 and tokens[i].text == "}" and follows not in (";", ")", ",", "."):
            return None  # a block
        if depth == 0 and tokens[i].text == ";":
            return None if follows == "else" else i
    return None


def is_action(statement: list[Piece]) -> bool:
    """Does it do something, rather than declare? A declaration begins with two
    words, or with a word and & or *."""
    if statement[0].text in ("++", "--"):
        return True
    depth = 0
    for before, token in zip(statement, statement[1:]):
        depth += DEPTHS.get(before.text, 0)
        is_after_type = before.kind == "word" or before.text in ("&", "*", ">")
        if depth == 0 and token.kind == "word" and is_after_type:
            return False  # `double x`, `Vector3& x`
        if depth == 0 and token.text in ("=", "+=", "-=", "*=", "/=", "<<"):
            return True
        if depth == 0 and token.text == "{":
            return False
    return statement[-1].text in (")", "++", "--")


def apply(text: str, change: Change) -> str:
    return text[:change.at] + change.after + text[change.at + len(change.before):]


def sample(changes: list[Change], seed: int) -> list[Change]:
    """All of them, in an order that the seed decides."""
    return random.Random(seed).sample(changes, len(changes))


def place_of(text: str, change: Change) -> tuple[int, str]:
    """Line number and the text of the line where it begins."""
    number = text.count("\n", 0, change.at) + 1
    return number, text.splitlines()[number - 1].strip()
