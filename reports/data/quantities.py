"""How numbers and units are written: three significant digits, a proper minus,
powers of ten, and always the unit."""
from __future__ import annotations

import math
import re
from collections.abc import Iterable

from markupsafe import Markup, escape

MINUS = "\u2212"
THIN = "\u202f"  # narrow no-break space
_SUPERSCRIPTS = str.maketrans("0123456789-+.", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺·")


def superscript(text: str) -> str:
    """The text in Unicode superscripts: -5 becomes ⁻⁵."""
    return text.translate(_SUPERSCRIPTS)


def split_number(value: float, digits: int = 3) -> tuple[str, int | None]:
    """(mantissa, exponent of ten); the exponent is None where plain decimals read better.

    Whole numbers below 1e7 are written in full. A number that fewer digits write exactly gets no
    more than it needs: 0.1, not 0.100.
    """
    if is_count(value):
        return (MINUS if value < 0 else "") + _group_digits(str(abs(int(value)))), None
    enough = (count for count in range(1, digits) if float(f"{value:.{count - 1}e}") == value)
    return round_number(value, next(enough, digits))


def is_count(value: float) -> bool:
    """Whether a number is whole and small enough to be written in full."""
    return math.isfinite(value) and abs(value) < 1e7 and value == int(value)


def round_number(value: float, digits: int = 3) -> tuple[str, int | None]:
    """As split_number, but a whole number is rounded like any
    other. NaN and infinities are named."""
    if math.isnan(value):
        return "NaN", None
    if math.isinf(value):
        return ("" if value > 0 else MINUS) + "∞", None
    if value == 0:
        return "0", None
    sign = MINUS if value < 0 else ""
    size = abs(value)
    exponent = int(f"{size:.{digits - 1}e}".split("e")[1])
    if -3 <= exponent < 6:
        places = digits - 1 - exponent
        return sign + _group_digits(f"{round(size, places):.{max(0, places)}f}"), None
    mantissa, power = f"{size:.{digits - 1}e}".split("e")
    return sign + mantissa, int(power)


def _group_digits(text: str) -> str:
    """Thousands apart from five digits on: 12345 becomes 12 345."""
    whole, point, rest = text.partition(".")
    if len(whole) >= 5:
        whole = f"{int(whole):,}".replace(",", THIN)
    return whole + point + rest


def number_text(value: float, digits: int = 3) -> str:
    """A number as plain Unicode text, for plots and file names' captions."""
    mantissa, exponent = split_number(float(value), digits)
    return mantissa if exponent is None else f"{mantissa}×10{superscript(str(exponent))}"


def number_html(value: float) -> Markup:
    """A number for the page; the full value shows when pointed at, if it was rounded."""
    return _mark_up(float(value), *split_number(float(value)))


def known_html(value: float) -> Markup:
    """A number for the page, a dash for one that says nothing."""
    return Markup('<span class="n">–</span>') if math.isnan(value) else number_html(value)


def _mark_up(value: float, mantissa: str, exponent: int | None) -> Markup:
    power = "" if exponent is None else Markup("{}×{}10<sup>{}</sup>").format(
        "\u200a", "\u200a", str(exponent).replace("-", MINUS))
    if math.isfinite(value) and not is_count(value) and float(f"{value:.2e}") != value:
        return Markup('<span class="n" title="{}">{}{}</span>').format(
            f"{value:.17g}", mantissa, power
        )
    return Markup('<span class="n">{}{}</span>').format(mantissa, power)


def unit_text(unit: str) -> str:
    """A unit for print: m^2 becomes m², N*m becomes N·m; none at all becomes 1."""
    unit = unit.strip() or "1"
    power = r"\^(?:\(([-+]?\d+)\)|([-+]?\d+))"
    unit = re.sub(power, lambda found: superscript(found[1] or found[2]), unit)
    return unit.replace("*", "·")


def quantity_text(value: float, unit: str) -> str:
    """A number with its unit as plain text; the unit 1 is not written."""
    return number_text(value) + ("" if unit.strip() in ("", "1") else f" {unit_text(unit)}")


def digits_apart(value: float, other: float) -> int:
    """The significant digits, three to ten, that tell a number from another one close by."""
    if value == other or not (math.isfinite(value) and math.isfinite(other)):
        return 3
    return next((count for count in range(3, 10)
                 if f"{value:.{count - 1}e}" != f"{other:.{count - 1}e}"), 10)


def quantity_html(value: float, unit: str, beside: float = math.nan) -> Markup:
    """A number with its unit; the unit 1 is not written.

    beside   a number that it does not equal, and must not seem to
    """
    written = _mark_up(float(value), *split_number(float(value), digits_apart(value, beside)))
    if unit.strip() in ("", "1"):
        return written
    return Markup('{}\u2009<span class="unit">{}</span>').format(written, unit_text(unit))


_WRITTEN = re.compile(r"-?\d+(?:\.\d+)?|-?\d(?:\.\d+)?e[-+]?\d+")


def _text_html(text: str) -> Markup:
    """A text of a table; a number that was written with its own digits keeps them."""
    if not _WRITTEN.fullmatch(text):
        return escape(text)
    mantissa, _, exponent = text.partition("e")
    return _mark_up(float("nan"), mantissa.replace("-", MINUS), int(exponent) if exponent else None)


def cells_html(values: Iterable[object]) -> list[Markup]:
    """The cells of one column: texts, or numbers written in one
    manner (all whole, or all rounded)."""
    values = list(values)
    if any(isinstance(value, str) for value in values):
        return [_text_html(str(value)) for value in values]
    numbers = [float(value) for value in values]  # type: ignore[arg-type]
    if all(is_count(value) or not math.isfinite(value) for value in numbers):
        return [known_html(value) for value in numbers]
    return [
        known_html(value) if math.isnan(value) else _mark_up(value, *round_number(value))
        for value in numbers
    ]


def seconds_html(value: float) -> Markup:
    """A duration as a reader would say it."""
    if math.isnan(value):
        return Markup("duration not recorded")
    if value >= 120:
        minutes = _mark_up(value / 60, *round_number(value / 60))
        return Markup('{}\u2009<span class="unit">min</span>').format(minutes)
    if value < 0.01:
        return Markup('<span class="n">&lt;\u20090.01</span>\u2009<span class="unit">s</span>')
    return quantity_html(value, "s") if value >= 0.1 else quantity_html(value * 1e3, "ms")


def order_html(value: float) -> Markup:
    """An observed order of convergence, to two decimals; a dash where there is none."""
    written = "–" if math.isnan(value) else f"{value:.2f}".replace("-", MINUS).replace("inf", "∞")
    return Markup('<span class="n">{}</span>').format(written)


def ratio_of(value: float, reference: float) -> float:
    """value/reference where both are positive (or value is 0); NaN where a ratio says nothing."""
    if not (math.isfinite(value) and math.isfinite(reference) and reference > 0 and value >= 0):
        return float("nan")
    return value / reference
