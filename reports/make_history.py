#!/usr/bin/python3
"""Shows what changed over runs of the verification: verdicts, rulings, margins, costs.

    reports/make_history.py results-monday results             -> a table; where changes began
    reports/make_history.py results --log history.jsonl        -> adds to the log, shows it
    reports/make_history.py --log history.jsonl --out FILE     -> a page
"""
from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from data.command_line import OneLineParser, refuse, require_modules  # noqa: E402

require_modules("make_history", "numpy", "h5py", "matplotlib", "jinja2")
from data.history import RunRow, append_to_log, in_order, read_log, row_of  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from data.whole_file import write_whole  # noqa: E402
from pages.history import History, as_json, as_text, history_of, render_history  # noqa: E402


def main() -> int:
    """Returns 0 when nothing got worse in the newest run, 1 when something did, 2 for bad input."""
    said = arguments()
    if not said.runs and not said.log:
        refuse("make_history", "give folders of runs, or --log FILE")
    try:
        history = history_of(gather(said.runs, said.log))
        if said.out:
            write_whole(said.out, render_history(history).encode("utf-8"))
    except (OSError, Unreadable) as error:
        refuse("make_history", str(error))
    show(history, said)
    return 1 if history.newest_regressions else 0


def arguments() -> argparse.Namespace:
    """Command line options."""
    parser = OneLineParser(description="What changed over runs, and in which run first.")
    parser.add_argument(
        "runs", metavar="DIR", type=Path, nargs="*", help="folder of a run, or a verdicts.json"
    )
    parser.add_argument(
        "--log", metavar="FILE", type=Path,
        help="JSON lines, one a run: the runs given are appended, and all that it has are shown"
    )
    parser.add_argument("--out", metavar="FILE", type=Path, help="write a page, too")
    parser.add_argument("--json", action="store_true", help="print the changes as JSON")
    return parser.parse_args()


def gather(runs: list[Path], log: Path | None) -> list[RunRow]:
    """The runs of the log and those given, by date; the log has them all afterwards."""
    given = [row_of(run) for run in runs]
    if log:
        append_to_log(log, given)
        given = read_log(log) + given
    if not given:
        raise Unreadable(f"{log}: there is no run in it yet; give the folder of one")
    return in_order(given)


def show(history: History, said: argparse.Namespace) -> None:
    """Prints the answer, then the path of the page."""
    print(as_json(history) if said.json else as_text(history))
    if said.out and not said.json:
        sys.stdout.flush()
        sys.stdout.buffer.write(os.fsencode(said.out) + b"\n")


if __name__ == "__main__":
    sys.exit(main())
