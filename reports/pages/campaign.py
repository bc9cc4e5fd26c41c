"""The page of a campaign. Arranges what was stored; judges nothing."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from data.campaign_table import CampaignFigure, CampaignTable, figures_of, require_columns
from pages.render import new_environment
from plots.campaign_plots import figure_notes, plot_campaign_figure
from plots.plot_style import Plot, use_style

MOST_REASONS = 12


@dataclass(frozen=True)
class ShownFigure:
    """A figure of the page."""

    figure: CampaignFigure
    plots: list[Plot]
    notes: list[str]


def draw_figures(table: CampaignTable, asked: list[CampaignFigure],
                 folder: Path) -> list[ShownFigure]:
    """Draws those that are asked for, else the campaign's; files go to `folder`. Unreadable for a
    parameter or a quantity that there is not."""
    use_style()
    folder.mkdir(parents=True, exist_ok=True)
    shown = []
    for k, figure in enumerate(asked or figures_of(table)):
        require_columns(table, figure)
        plots = plot_campaign_figure(table, figure, f"figure-{k + 1}", folder)
        shown.append(ShownFigure(figure, plots, figure_notes(table, figure)))
    return shown


def render_campaign(table: CampaignTable, shown: list[ShownFigure]) -> str:
    """The page as one HTML text."""
    known = table.seconds[np.isfinite(table.seconds)]
    return new_environment().get_template("campaign.html.j2").render(
        said=table, shown=shown, seconds=float(known.sum()),
        reasons=table.commonest_reasons(MOST_REASONS))
