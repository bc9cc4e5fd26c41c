#!/usr/bin/python3
"""Makes the page of a campaign from the files of `foldproof campaign table`.

    reports/make_campaign.py mine/campaigns/first_grid
    reports/make_campaign.py mine/campaigns/first_grid --quantity tip --over time.step
"""
from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from data.command_line import OneLineParser, refuse, require_modules  # noqa: E402

require_modules("make_campaign", "numpy", "matplotlib", "jinja2")
from data.campaign_table import CampaignFigure, load_campaign  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from data.whole_file import write_whole  # noqa: E402
from pages.campaign import draw_figures, render_campaign  # noqa: E402


def main() -> int:
    """Returns 0 when the page is written; ends with 2 for bad input."""
    said = arguments()
    if bool(said.quantity) != bool(said.over):
        refuse("make_campaign", "give --quantity and --over, or neither")
    asked = (
        [CampaignFigure(said.quantity, tuple(said.over[:3]), "", said.log)] if said.quantity else []
    )
    page = said.folder / "report.html"
    try:
        table = load_campaign(said.folder)
        shown = draw_figures(table, asked, said.folder / "figures")
        write_whole(page, render_campaign(table, shown).encode("utf-8"))
    except (OSError, Unreadable) as error:
        refuse("make_campaign", str(error))
    sys.stdout.buffer.write(os.fsencode(page) + b"\n")
    return 0


def arguments() -> argparse.Namespace:
    """Command line options."""
    parser = OneLineParser(description="Maps and curves of a campaign.")
    parser.add_argument("folder", metavar="DIR", type=Path, help="with its campaign.json")
    parser.add_argument("--quantity", metavar="NAME", help="in place of the campaign's figures")
    parser.add_argument(
        "--over", metavar="NAME", nargs="+", default=[], help="one to three of its parameters"
    )
    parser.add_argument("--log", action="store_true", help="logarithmic values")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
