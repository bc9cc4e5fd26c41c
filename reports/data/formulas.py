"""Formulas in sentences as a reader expects them: omega h <= 2/omega^2 becomes ω h ≤ 2/ω². Results
keep the plain text; pages and plots show it so."""
from __future__ import annotations

import re
from collections.abc import Callable

from markupsafe import Markup, escape

from data.quantities import MINUS, superscript

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "zeta": "ζ", "theta": "θ", "kappa": "κ", "lambda": "λ",
    "mu": "μ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "omega": "ω"
}
_LETTERS = "".join(GREEK.values())
_PLAIN: list[tuple[re.Pattern[str], str | Callable[[re.Match[str]], str]]] = [
    (re.compile(r"\bd\((\w+)\)/dt\b"), r"d\1/dt"),
    (
        re.compile(rf"(?<![\w.=])(?<![a-z]-)(d?)({'|'.join(GREEK)})(?![a-z]|-[a-z])"),
        lambda found: found[1] + GREEK[found[2]],
    ),
    (re.compile(r"<="), "≤"),
    (re.compile(r">="), "≥"),
    (re.compile(r"\+-"), "±"),
    (re.compile(r"\bsqrt\((\w)\)"), r"√\1"),
    (re.compile(r"\bsqrt\("), "√("),
    (re.compile(r"(?<=[a-z]_[a-z])\.(?=[a-z]_[a-z]\b)"), "·"),
    (re.compile(r"(?<=\s[a-z])\.(?=[a-z]_[a-z]\b)"), "·"),
    (re.compile(r"\b([a-z])\^(?![\w({-])"), "\\1\u0302"),  # t^ is the unit vector along t
    (re.compile(r"(?<![\w.=])\.(?=\d)"), "0."),
    (re.compile(r"(?:^|(?<=[\s(\[]))-(?=\d)"), MINUS),
]
_POWER = re.compile(r"\^(?:\(([^()]*)\)|\{([^{}]*)\}|(-?\d+\.\d+|-?\w+?)(?=th\b|\b))")
_INDEX = re.compile(rf"\b(kd|ke|[A-Za-z{_LETTERS}])_([A-Za-z0-9]{{1,5}})\b")
_TEN = re.compile(r"(?<![\w.=-])(-?\d+(?:\.\d+)?)e(-?\d+)(?![\w.]\w)")


def formula_html(text: object) -> Markup:
    """The text for a page, powers raised and indices lowered. Marked-up text stays as it is."""
    if isinstance(text, Markup):
        return text
    said = str(escape(_written(str(text))))
    said = _TEN.sub(lambda found: _power_of_ten(found, lambda power: f"<sup>{power}</sup>"), said)
    said = _POWER.sub(lambda found: f"<sup>{_inside(found)}</sup>", said)
    return Markup(_INDEX.sub(r"\1<sub>\2</sub>", said))


def formula_text(text: str) -> str:
    """The text for a plot, in Unicode: powers that are whole numbers are raised, others stay."""
    said = _TEN.sub(lambda found: _power_of_ten(found, superscript), _written(text))
    return re.sub(r"\^(-?\d+)", lambda found: superscript(found[1]), said)


def _written(text: str) -> str:
    for pattern, sign in _PLAIN:
        text = pattern.sub(sign, text)
    return text


def _power_of_ten(found: re.Match[str], raised: Callable[[str], str]) -> str:
    power = "10" + raised(str(int(found[2]))).replace("-", MINUS)
    return power if found[1] == "1" else f"{found[1]}\u200a×\u200a{power}"


def _inside(found: re.Match[str]) -> str:
    return next(part for part in found.groups() if part is not None).replace("-", MINUS)
