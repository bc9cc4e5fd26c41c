"""Embeds a figure's SVG file in the page. A page holds hundreds of figures, so what no reader sees
is left out: ids that nothing refers to, groups that say nothing, digits that no pixel shows."""
from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element, fromstring

from markupsafe import Markup, escape

# of coordinates; the unit of a figure is at most 1.7 pixels in the page
DECIMALS = 2
# the one rule of matplotlib's <style> stands in style.css for all figures
_LEFT_OUT = ("metadata", "style")
_FRACTION = re.compile(r"-?\d*\.\d+")
_AROUND_A_LETTER = re.compile(r"\s*([A-Za-z])\s*")
_NO_TURN = re.compile(r"rotate\(-?0 [^)]*\)")
_FONT = re.compile(r"font: (?:[a-z]+ )*([\d.]+)px [^;]*")
_REFERENCE = re.compile(r'(?<=href="#)[^"]+|(?<=url\(#)[^)]+')


@dataclass
class _Names:
    """Names of a file's ids and colours in the page."""
    ids: dict[str, str]             # only those that are referred to
    variables: Mapping[str, str]    # colour: CSS variable


def page_svg(text: str, name: str, description: str, variables: Mapping[str, str]) -> Markup:
    """An SVG file's text made fit to stand in the page: no prolog, ids of its own that begin with
    plot-NAME, the page's typeface, and colours as the CSS variables that are given for them."""
    referred = dict.fromkeys(_REFERENCE.findall(text))
    names = _Names({old: f"plot-{name}-{k}" for k, old in enumerate(referred)}, variables)
    drawing = fromstring(text.encode("utf-8"))
    inside = "".join(_write(child, names) for child in drawing)
    return Markup('<svg class="plot" role="img" aria-label="{}" viewBox="{}">{}</svg>').format(
        description, drawing.get("viewBox", ""), Markup(inside))


def _write(element: Element, names: _Names) -> str:
    """An element and all in it, as SVG; a group without attributes is what it holds."""
    tag = _local(element.tag)
    if tag in _LEFT_OUT:
        return ""
    inside = _words(element.text) + "".join(
        _write(child, names) + _words(child.tail) for child in element
    )
    attributes = "".join(_attribute(_local(key), value, names) for key, value in element.items())
    if tag in ("g", "defs") and not inside:
        return ""
    if tag == "g" and not attributes:
        return inside
    return f"<{tag}{attributes}>{inside}</{tag}>" if inside else f"<{tag}{attributes}/>"


def _local(name: str) -> str:
    """A name without its namespace, as HTML has it."""
    return name.rpartition("}")[2]


def _words(text: str | None) -> str:
    return str(escape(text)) if text and not text.isspace() else ""


def _attribute(key: str, value: str, names: _Names) -> str:
    """An attribute with the space before it; "" if it says nothing."""
    if key == "id":
        value = names.ids.get(value, "")
    elif key == "href" and value.startswith("#"):
        value = "#" + names.ids[value[1:]]
    elif key == "style":
        value = _style(value, names)
    elif key == "transform":
        value = _NO_TURN.sub("", value)
    elif key == "d":
        value = _AROUND_A_LETTER.sub(r"\1", _FRACTION.sub(_round, value))
    elif key in ("x", "y", "width", "height"):
        value = _FRACTION.sub(_round, value)
    value = _REFERENCE.sub(lambda found: names.ids[found[0]], value) if "url(" in value else value
    return f' {key}="{escape(value)}"' if value else ""


def _style(value: str, names: _Names) -> str:
    for colour, variable in names.variables.items():
        value = value.replace(colour, f"var({variable})")
    return _FONT.sub(r"font-size: \1px", value).replace(": ", ":").replace("; ", ";")


def _round(found: re.Match[str]) -> str:
    shorter = f"{float(found[0]):.{DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if shorter == "-0" else shorter
