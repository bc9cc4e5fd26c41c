"""Numbers of findings as a reader would say them. A finding that asks for at least a number is
stored as what it falls short of it, below zero; here it is said as what was measured,
and the least that is required."""
from __future__ import annotations

import re

from markupsafe import Markup

from data.quantities import number_html, quantity_html
from data.results import Finding

_SHORT = re.compile(r"(?:(?P<unit>.*) )?short of (?P<least>-?\d+(?:\.\d+)?(?:e-?\d+)?)")


def least_of(finding: Finding) -> tuple[float, str] | None:
    """The least that is required and its unit, where the finding asks for
    that; None for an upper bound."""
    found = _SHORT.fullmatch(finding.unit)
    return (float(found["least"]), found["unit"] or "1") if found and finding.bound == 0 else None


def measured_html(finding: Finding) -> Markup:
    """What was measured, with its unit."""
    least = least_of(finding)
    return (
        quantity_html(least[0] - finding.measured, least[1])
        if least
        else quantity_html(finding.measured, finding.unit)
    )


def bound_html(finding: Finding) -> Markup:
    """The bound; "at least 60" where that is asked."""
    least = least_of(finding)
    return (
        Markup("at least {}").format(number_html(least[0])) if least else number_html(finding.bound)
    )


def rule_html(finding: Finding) -> Markup:
    """When it holds."""
    if least_of(finding):
        return Markup("holds if measured \u2212 uncertainty is at least what is required")
    return Markup("holds if measured + uncertainty \u2264 bound")
