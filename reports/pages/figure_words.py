"""Text around a study's figure: observed orders, keys of curves, notes."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from data import quantities
from data.studies import StudyFigure
from plots.plot_style import level_text
from plots.point_marks import has_mark, is_marked
from plots.study_plots import floors_below, key_svg, pens_of, points_left_out


@dataclass
class OrderTable:
    """Observed orders under a plot: one row for each curve, beginning with its key."""
    heads: list[str]
    rows: list[tuple[Markup, str, list[Markup]]]


def order_table(figure: StudyFigure) -> OrderTable | None:
    """The observed order of every pair of points, as the program
    wrote them; None if it wrote none."""
    with_orders = [curve for curve in figure.curves if curve.pair_orders is not None
                   and len(curve.pair_orders)]
    if not with_orders:
        return None
    widest = max(with_orders, key=lambda curve: len(curve.pair_orders))
    shared = all(len(curve.x) == len(widest.x) and np.allclose(curve.x, widest.x, equal_nan=True)
                 for curve in with_orders)
    heads = [f"{level_text(a)} – {level_text(b)}" if shared else f"pair {k + 1}"
             for k, (a, b) in enumerate(zip(widest.x[:-1], widest.x[1:]))][:len(widest.pair_orders)]
    rows = []
    for curve, pen in zip(figure.curves, pens_of(figure)):
        orders = curve.pair_orders if curve.pair_orders is not None else []
        cells = [quantities.order_html(order) for order in orders]
        rows.append((key_svg(pen), curve.label, cells + [Markup("")] * (len(heads) - len(cells))))
    return OrderTable(heads, rows)


def figure_keys(figure: StudyFigure) -> list[tuple[Markup, str]]:
    """Key and label of every curve, for screens too narrow for the plot's own labels."""
    # as in the plot, where hollow says something
    filled = is_marked(figure.curves)
    return [
        (key_svg(pen, filled), curve.label)
        for curve, pen in zip(figure.curves, pens_of(figure))
    ]


def figure_notes(figure: StudyFigure) -> list[str]:
    """Notes that a reader of the plot needs."""
    notes = []
    left_out, floors = points_left_out(figure), floors_below(figure)
    if left_out:
        logarithmic = "log" in (figure.x_scale, figure.y_scale)
        what = (
            "NaN, infinite, or not positive on a logarithmic axis"
            if logarithmic
            else "NaN or infinite"
        )
        notes.append(f"{left_out} point{'s' if left_out > 1 else ''} not drawn ({what}).")
    # of a ladder the caption says what hollow points are
    if (
        any(has_mark(curve, "unfinished").any() for curve in figure.curves)
        and "Hollow:" not in figure.caption
    ):
        notes.append("Hollow: a solve on the way of that run did not finish.")
    if floors:
        plural = "s" if len(floors) > 1 else ""
        notes.append(f"Noise floor of {len(floors)} curve{plural} below the plot: at most "
                     f"{quantities.quantity_text(max(floors), figure.y_unit)}.")
    return notes
