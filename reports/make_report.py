#!/usr/bin/python3
"""Writes the report of a run: one HTML page that needs nothing beside it, and its figures as files.

    reports/make_report.py results                    -> results/report.html, results/figures/*.svg
    reports/make_report.py results --papers           -> also figures and pictures as PDF and PNG
    reports/make_report.py results --out page.html --figures paper
    reports/make_report.py results --pdf                -> results/report.pdf too
    reports/make_report.py results --summary            -> results/summary.*: html, md, pdf
    reports/make_report.py results --one-file           -> results/report.html with everything in it
    reports/make_report.py results mine                 -> mine/compare.html: what differs
    reports/make_report.py jolt mujoco bullet           -> bullet/compare.html: judged solvers
    reports/make_report.py results mine --summary       -> mine/summary.*, with changes
"""
from __future__ import annotations

import argparse
import os
import sys
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path

sys.dont_write_bytecode = True

from data.command_line import OneLineParser, refuse, require_modules, require_program  # noqa: E402

require_modules("make_report", "numpy", "h5py", "matplotlib", "jinja2")
from data.history import row_of  # noqa: E402
from data.run_folder import read_folder  # noqa: E402
from data.trials import is_trial, read_trial, trial_of_run  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from data.whole_file import write_whole  # noqa: E402
from pages.chromium import PACKAGE, NoBrowser  # noqa: E402
from pages.compare import compare, read_side  # noqa: E402
from pages.drawing import draw, undrawn  # noqa: E402
from pages.page import Page, read_parts  # noqa: E402
from pages.printed import print_page  # noqa: E402
from pages.render import render, render_comparison, render_pages, render_summary  # noqa: E402
from pages.section import Source  # noqa: E402
from pages.site import FIRST, FOLDER  # noqa: E402
from pages.summary import REFERENCE, since_last  # noqa: E402
from pages.trials import render_trials, trials_json, trials_of  # noqa: E402
from pages.trust import note_on_unfinished_run  # noqa: E402

SHIPPED_CASES = Path(__file__).resolve().parent.parent / "cases"


def main() -> int:
    """Returns 0 when the page is written, 2 when there is nothing to report
    on, or no browser to print with."""
    said = arguments()
    others: list[Path] = said.others
    are_trials = bool(others) and all(is_trial(folder) for folder in (said.dir, *others))
    if len(others) > 1 and (not are_trials or said.summary):
        refuse(
            "make_report",
            "more than two folders are compared only if `foldproof judge --out` wrote each of them",
        )
    if said.pdf:
        require_program("make_report", PACKAGE)
    try:
        if said.summary:
            outs = make_summary(others[0] if others else said.dir, said.dir if others else None)
            return show_paths(outs)
        if are_trials:
            out = compare_trials([said.dir, *others], said.out)
        elif others:
            out = compare_runs(said.dir, others[0], said.out)
        elif said.one_file or said.out or said.pdf:
            out = make_report(
                said.dir, said.out or said.dir / "report.html",
                said.figures or said.dir / "figures", for_papers=said.papers
            )
        else:
            out = make_pages(said.dir, said.figures or said.dir / "figures", said.papers)
        if said.pdf:
            out = print_page(out, out.with_suffix(".pdf"))
    except (OSError, Unreadable, NoBrowser, BrokenProcessPool) as error:
        print(f"make_report: the report could not be made: {error}", file=sys.stderr)
        return 2
    return show_paths([out])


def show_paths(outs: list[Path]) -> int:
    """Prints what was written; a path may hold bytes that are no text."""
    for out in outs:
        sys.stdout.buffer.write(os.fsencode(out) + b"\n")
    return 0


def arguments() -> argparse.Namespace:
    """Command line options."""
    parser = OneLineParser(
        description=(
            "Write the report of a run as one self-contained HTML page; of two runs, what differs."
        )
    )
    parser.add_argument(
        "dir", metavar="DIR", type=Path, help="folder with run.h5, bench.h5 or case files"
    )
    parser.add_argument(
        "others",
        metavar="OTHER",
        type=Path,
        nargs="*",
        help=(
            "folder or run.h5 of another run: DIR (a folder or run.h5) is compared with it; or "
            "folders of other judged solvers"
        ),
    )
    parser.add_argument(
        "--out",
        metavar="FILE",
        type=Path,
        help="the page (default: DIR/report.html; of more runs compare.html in the last folder)",
    )
    parser.add_argument(
        "--figures", metavar="DIR", type=Path, help="folder for the figures (default: DIR/figures)"
    )
    parser.add_argument(
        "--papers",
        action="store_true",
        help="figures as PDF and PNG files (200 dpi) too, and the pictures of cases as files",
    )
    parser.add_argument(
        "--summary",
        action="store_true",
        help=(
            "the verdict on one page instead: summary.html, summary.md and, where chromium is, "
            "summary.pdf; of two runs that of OTHER, with what changed since DIR"
        ),
    )
    parser.add_argument(
        "--one-file",
        action="store_true",
        help=(
            "everything in DIR/report.html; otherwise a long report has a page for each topic,"
            " study and case in DIR/report"
        ),
    )
    parser.add_argument(
        "--pdf",
        action="store_true",
        help="print the page too, beside it, as PDF; needs Debian's package chromium",
    )
    return parser.parse_args()


def compare_runs(first: Path, other: Path, out: Path | None) -> Path:
    """Writes the page of two runs. Throws Unreadable if one of them cannot be read."""
    a, b = read_side("A", first), read_side("B", other)
    out = out or b.run.path.parent / "compare.html"
    out.parent.mkdir(parents=True, exist_ok=True)
    write_whole(out, render_comparison(compare(a, b)).encode("utf-8"))
    return out


def compare_trials(folders: list[Path], out: Path | None) -> Path:
    """Writes the page of judged solvers, its numbers as JSON and the folder figures beside it.
    Throws Unreadable if one of them cannot be read."""
    said = trials_of([read_trial(folder) for folder in folders])
    out = out or folders[-1] / "compare.html"
    figures = out.parent / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    write_whole(out, render_trials(said, figures).encode("utf-8"))
    write_whole(out.with_suffix(".json"), trials_json(said).encode("utf-8"))
    return out


def make_summary(folder: Path, earlier: Path | None) -> list[Path]:
    """Writes the page of verdict beside the run, and says what changed since an earlier one.
    Without Chromium there is no PDF, which a line on the error output
    says. Throws as make_report does."""
    run, bench = read_folder(folder)
    page = replace(undrawn(run, bench), trial=trial_of_run(folder, run))
    since = since_last(row_of(earlier), row_of(folder), str) if earlier else None
    html, markdown = render_summary(page, since)
    outs = [folder / "summary.html", folder / "summary.md", folder / "summary.pdf"]
    write_whole(outs[0], html.encode("utf-8"))
    write_whole(outs[1], markdown.encode("utf-8"))
    try:
        print_page(outs[0], outs[2])
    except NoBrowser as why:
        outs[2].unlink(missing_ok=True)  # of an earlier run
        print(f"make_report: summary.pdf was not written: {why}", file=sys.stderr)
        del outs[2]
    return outs


def make_pages(
    folder: Path, figures: Path, for_papers: bool = False, shipped: Path = SHIPPED_CASES
) -> Path:
    """As make_report, with pages in the folder report/ where one would be long, in place of those
    of an earlier report. Returns the first page."""
    pages = render_pages(make_page(folder, figures, for_papers, shipped))
    for old in set((folder / FOLDER).glob("*.html")) - {folder / name for name in pages}:
        old.unlink()
    if len(pages) > 1:
        (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    for name, text in reversed(pages.items()):  # the first page last: its links then lead somewhere
        write_whole(folder / name, text.encode("utf-8"))
    return folder / FIRST


def make_report(
    folder: Path, out: Path, figures: Path, for_papers: bool = False, shipped: Path = SHIPPED_CASES
) -> Path:
    """Reads the folder, draws, and writes the page; what is recorded of the cases in the folder
    `shipped` stands in the report of a run of the verification. Throws FileNotFoundError if the
    folder holds no results, Unreadable if a file in it is damaged."""
    page = make_page(folder, figures, for_papers, shipped)
    out.parent.mkdir(parents=True, exist_ok=True)
    write_whole(out, render(page).encode("utf-8"))
    return out


def make_page(folder: Path, figures: Path, for_papers: bool, shipped: Path) -> Page:
    """The report of a folder, with its pictures and plots."""
    run, bench = read_folder(folder)
    is_own = run.path and run.provenance.get("subject", REFERENCE) == REFERENCE
    source = Source(folder, run, trial_of_run(folder, run), shipped if is_own else None)
    unended = "" if source.trial else note_on_unfinished_run(folder / "verdicts.json")
    parts = read_parts(source)
    figures.mkdir(parents=True, exist_ok=True)
    page = draw(run, bench, figures, for_papers)
    return replace(page, trial=source.trial, unended=unended, parts=parts)


if __name__ == "__main__":
    sys.exit(main())
