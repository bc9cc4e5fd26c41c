"""How every plot of the report looks, and how it becomes an inline SVG
that follows the page's colours.

Plots are drawn in the light palette. In the page each of its colours is replaced by a CSS variable
(style.css gives it a light and a dark value), and the text takes the page's typeface.
"""
from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO, StringIO
from pathlib import Path

import matplotlib
import matplotlib.font_manager
import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import (
    FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
)

from data.formulas import formula_text
from data.quantities import MINUS, is_count, number_text, superscript, unit_text
from data.whole_file import write_whole
from plots.svg_in_page import page_svg

INK, MUTED, GRID, BAND, PAPER = "#24292e", "#68707a", "#e4e6e9", "#eceef1", "#fefefe"
COLOURS = ("#1562a8", "#c4501b", "#0b8268", "#8b3f94", "#a8780a", "#3597bf", "#bf4a7b", "#5b6068",
           "#5a7312", "#7d4a20", "#4b45c6")
_FABRIC_COLOURS = ("blue", "orange", "green", "purple", "ochre", "light blue", "pink", "grey")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "h", "*", "p")
_VARIABLES = {INK: "--plot-ink", MUTED: "--plot-muted", GRID: "--plot-grid", BAND: "--plot-band",
              PAPER: "--paper",
              **{colour: f"--plot-{k}" for k, colour in enumerate(COLOURS)}}
_RC = {
    "font.family": ["DejaVu Sans"],
    "font.size": 8.0,
    "text.color": INK,
    "text.parse_math": False,
    "axes.edgecolor": MUTED,
    "axes.linewidth": 0.6,
    "axes.labelcolor": INK,
    "axes.facecolor": "none",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.size": 3.0,
    "ytick.major.size": 0.0,
    "xtick.major.width": 0.6,
    "xtick.minor.size": 1.8,
    "xtick.minor.width": 0.4,
    "ytick.minor.size": 0.0,
    "ytick.major.pad": 4.0,
    "figure.facecolor": "none",
    "savefig.facecolor": "none",
    "savefig.transparent": True,
    "lines.solid_capstyle": "round",
    "lines.linewidth": 1.3,
    "path.simplify": True,
    "svg.fonttype": "none",
    "svg.hashsalt": "foldproof",
    "pdf.fonttype": 42,
}


@dataclass
class Plot:
    """A finished plot: its name as a file, and the SVG for the page."""
    name: str
    svg: Markup


@dataclass
class Pen:
    """How one curve is drawn. Curves that lie on each other get nested
    markers and lines of falling width."""
    colour: str
    marker: str
    width: float
    size: float


Points = tuple[np.ndarray, np.ndarray]   # x and y of the points of a curve that can be drawn


_for_papers = False


def use_style(for_papers: bool = False) -> None:
    """Sets the style for every figure made from here on, and whether files for papers are written:
    PDF and PNG of each figure, and pictures that the page holds as they are."""
    global _for_papers
    _for_papers = for_papers
    matplotlib.rcParams.update(_RC)


def are_for_papers() -> bool:
    """Whether files for papers are written."""
    return _for_papers


def font_path() -> str:
    """The file of the typeface of the plots."""
    return matplotlib.font_manager.findfont("DejaVu Sans")


def new_figure(width: float, height: float) -> Figure:
    """A figure of the given size [inch], without pyplot's global state."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def finish(figure: Figure, name: str, folder: Path, description: str) -> Plot:
    """Writes name.svg, for papers name.pdf and name.png (200 dpi, white) too, into the folder and
    returns the SVG for the page."""
    text = svg_text(figure)
    write_whole(folder / f"{name}.svg", text.encode("utf-8"))
    if _for_papers:
        pdf, png = BytesIO(), BytesIO()
        figure.savefig(
            pdf, format="pdf", metadata={"CreationDate": None, "Creator": None, "Producer": None}
        )
        figure.savefig(png, format="png", dpi=200, transparent=False, facecolor="white",
                       metadata={"Software": None}, pil_kwargs={"compress_level": 3})
        write_whole(folder / f"{name}.pdf", pdf.getvalue())
        write_whole(folder / f"{name}.png", png.getvalue())
    return Plot(name, page_svg(text, name, description, _VARIABLES))


def svg_text(figure: Figure) -> str:
    """The figure as the text of an SVG file, the same on every run."""
    text = StringIO()
    figure.savefig(
        text, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None}
    )
    return text.getvalue()


def fabric_colour(k: int) -> str:
    """The colour of fabric k, in plots and in pictures."""
    return COLOURS[k % len(_FABRIC_COLOURS)]


def name_of_fabric_colour(k: int) -> str:
    """The same in a word."""
    return _FABRIC_COLOURS[k % len(_FABRIC_COLOURS)]


def variable_of(colour: str) -> str:
    """The CSS variable that stands for a colour of the palette in the page."""
    return f"var({_VARIABLES[colour]})"


def label_axes(axes: Axes, x_label: str, x_unit: str, y_label: str, y_unit: str) -> None:
    """The y label stands level above its axis, where it reads without
    turning the head; units in brackets."""
    axes.set_xlabel(with_unit(x_label, x_unit), labelpad=4)
    _label_above(axes, with_unit(y_label, y_unit), 0.0, 0, "left")
    axes.grid(axis="y", color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)


def _label_above(axes: Axes, words: str, x: float, right: float, align: str) -> None:
    """Words above axes, at a fraction of their width and so many points to the right."""
    axes.annotate(words, (x, 1.0), xycoords="axes fraction", xytext=(right, 6),
                  textcoords="offset points", ha=align, va="bottom", fontsize=8.0, color=INK)


def draw_colour_bar(axes: Axes, colours: ScalarMappable, label: str, right: float) -> None:
    """A colour bar that fills the axes, its label above, so many points to the right."""
    bar = Colorbar(axes, colours, ticklocation="right")
    bar.outline.set_visible(False)
    bar.solids.set_rasterized(True)
    _label_above(axes, label, 1.0, right, "right")


def with_unit(label: str, unit: str) -> str:
    """A label with its unit in brackets; the unit 1 is not written."""
    said = formula_text(label)
    return said if unit.strip() in ("", "1") else f"{said} [{unit_text(unit)}]"


def scale_axis(axes: Axes, which: str, scale: str, values: np.ndarray) -> None:
    """Sets a linear or logarithmic scale and ticks that a reader
    can name; `which` is "x" or "y"."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    if scale != "log":
        axis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]))
        axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
        return
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    levels = np.unique(values[np.isfinite(values) & (values > 0)])
    decades = np.log10(levels[-1] / levels[0]) if len(levels) > 1 else 0.0
    if which == "x" and 1 < len(levels) <= 8 and np.diff(np.log10(levels)).min() > 0.1 * decades:
        _tick_levels(axes, levels)
        return
    axis.set_minor_locator(NullLocator())
    axis.set_major_locator(LogLocator(numticks=9, subs=_parts_of_a_decade(decades)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: _power(value)))


def _tick_levels(axes: Axes, levels: np.ndarray) -> None:
    """Ticks at the very levels that were run; every second one
    named where the names would touch."""
    width = axes.get_position().width * axes.figure.get_figwidth()     # [inch]
    room = np.diff(np.log10(levels)).min() / np.log10(levels[-1] / levels[0]) * 0.89 * width
    needed = 0.08 + 0.07 * max(len(level_text(level)) for level in levels)
    named = levels if room > needed else levels[::-2][::-1]
    axes.xaxis.set_major_locator(FixedLocator(named))
    axes.xaxis.set_minor_locator(FixedLocator(levels))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: level_text(value)))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _parts_of_a_decade(decades: float) -> tuple[float, ...]:
    if decades > 2.5:
        return (1.0,)
    return (1.0, 3.0) if decades > 1.2 else (1.0, 2.0, 5.0)


def plain(value: float) -> str:
    """A tick of a linear axis."""
    if abs(value) < 1e-12:
        return "0"
    if 1e-5 < abs(value) < 1e5:
        return np.format_float_positional(float(f"{value:.6g}"), trim="-").replace("-", MINUS)
    return number_text(value)


def _power(value: float) -> str:
    """A tick of a logarithmic axis: plain from 0.01 to 1000, else as a power of ten."""
    exponent = int(np.floor(np.log10(value) + 1e-9))
    return (
        plain(value)
        if -2 <= exponent <= 3
        else _times_power(f"{value / 10.0 ** exponent:.6g}", exponent)
    )


def _times_power(mantissa: str, exponent: int) -> str:
    power = f"10{superscript(str(exponent))}"
    return power if mantissa == "1" else f"{mantissa}×{power}"


def level_text(value: float) -> str:
    """A value that was run, as a tick: counts in full, else three digits without trailing zeros."""
    if is_count(value) or not np.isfinite(value):
        return number_text(value)
    if 1e-3 < abs(value) < 1e4:
        return plain(float(f"{value:.3g}"))
    mantissa, exponent = f"{value:.2e}".split("e")
    return _times_power(f"{float(mantissa):g}".replace("-", MINUS), int(exponent))


def say_in_the_middle(axes: Axes, words: str) -> None:
    """Words where nothing can be drawn, instead of an empty panel."""
    axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center", color=MUTED)
    axes.set_xticks([])
    axes.set_yticks([])


def hatch(axes: Axes) -> None:
    """Hatches the whole frame, below what is drawn later: what stays uncovered has no value."""
    axes.add_patch(
        Rectangle(
            (0, 0),
            1,
            1,
            transform=axes.transAxes,
            facecolor="none",
            edgecolor=MUTED,
            hatch="/////",
            linewidth=0.0,
            zorder=0.5,
        )
    )
