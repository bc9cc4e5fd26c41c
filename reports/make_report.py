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
import gc
import os
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path
from typing import Any

sys.dont_write_bytecode = True

from data.command_line import OneLineParser, refuse, require_modules, require_program  # noqa: E402

require_modules("make_report", "numpy", "h5py", "matplotlib", "jinja2")
from data.fault_record import with_record  # noqa: E402
from data.history import row_of  # noqa: E402
from data.mutation_scores import load_mutation_page  # noqa: E402
from data.trials import is_trial, read_trial, trial_of_run  # noqa: E402
from data.results import (
    Case,
    CaseEntry,
    Run,
    Study,
    case_entry_of_file,
    load_case,
    load_run,
)  # noqa: E402
from data.unreadable import Unreadable, one_line  # noqa: E402
from data.whole_file import write_whole  # noqa: E402
from pages.chromium import PACKAGE, NoBrowser  # noqa: E402
from pages.compare import compare, read_side  # noqa: E402
from pages.hard_cases import findings_by_case  # noqa: E402
from pages.kill_matrix import load_mutation  # noqa: E402
from pages.ledger import claim_views  # noqa: E402
from pages.errors import load_errors  # noqa: E402
from pages.needs import load_needs  # noqa: E402
from pages.page import (
    CaseView,
    Page,
    StudyView,
    faults_of,
    OF_STUDIES,
    findings_by_section,
    render,
    render_comparison,
    render_pages,
)  # noqa: E402
from pages.printed import print_page  # noqa: E402
from pages.site import FIRST, FOLDER  # noqa: E402
from pages.summary import REFERENCE, since_last  # noqa: E402
from pages.summary_page import render_summary  # noqa: E402
from pages.trials import render_trials, trials_json, trials_of  # noqa: E402
from pages.trust import (
    kinds_of,
    load_coverage,
    load_machines,
    load_variants,
    tolerances_of,
    note_on_unfinished_run,
)  # noqa: E402
from pictures.case_pictures import make_pictures  # noqa: E402
from plots.angle_spectrum import plot_angle_spectrum  # noqa: E402
from plots.case_plots import plot_diagnostics  # noqa: E402
from plots.contact_maps import plot_contacts  # noqa: E402
from plots.map_plots import plot_study_map  # noqa: E402
from plots.plot_style import use_style  # noqa: E402
from plots.study_plots import plot_study_figure  # noqa: E402
from viewer.field_pictures import make_field_view  # noqa: E402

SHIPPED_CASES = Path(__file__).resolve().parent.parent / "cases"
# characters that the data of all views of a page may take, shared equally
VIEWS = 4_000_000

OF_A_CASE = ("precision.h5", "converge.h5")  # of `foldproof precision` and `foldproof converge`

Job = tuple[Callable[..., Any], tuple[Any, ...]]


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
                said.dir,
                said.out or said.dir / "report.html",
                said.figures or said.dir / "figures",
                for_papers=said.papers,
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
    page = gather(
        run,
        bench,
        [CaseView(entry, f"case-{file_name(entry.name)}") for entry in run.cases],
        [StudyView(study, f"study-{file_name(study.name)}", [], [], []) for study in run.studies],
    )
    page = replace(page, trial=trial_of_run(folder, run))
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
    recorded = (
        shipped if run.path and run.provenance.get("subject", REFERENCE) == REFERENCE else None
    )
    trial = trial_of_run(folder, run)
    beside = {
        "coverage": load_coverage(folder / "coverage.json"),
        "variants": load_variants(folder / "variants.json"),
        "machines": load_machines(folder / "machines.json"),
        "mutation": load_mutation(folder / "mutation.json"),
        "mutants": load_mutation_page() if recorded else None,
        "unended": "" if trial else note_on_unfinished_run(folder / "verdicts.json"),
        "trial": trial,
        "needs": load_needs(folder / "ablation.json", recorded),
        "errors": load_errors(recorded) if recorded else None,
    }
    figures.mkdir(parents=True, exist_ok=True)
    return replace(draw(run, bench, figures, for_papers), **beside)


def read_folder(folder: Path) -> tuple[Run, Run | None]:
    """The run (made up of the case files alone if there is no run.h5) and
    the speed measurements, if any."""
    bench = load_run(folder / "bench.h5") if (folder / "bench.h5").is_file() else None
    others = [load_run(folder / name) for name in OF_A_CASE if (folder / name).is_file()]
    studies = [study for other in others for study in other.studies]
    if (folder / "run.h5").is_file():
        run = load_run(folder / "run.h5")
        return replace(run, studies=run.studies + studies, faults=with_record(run.faults)), bench
    entries = [
        case_entry_of_file(path)
        for path in sorted(folder.glob("*.h5"))
        if path.name not in ("bench.h5", *OF_A_CASE)
    ]
    cases = [entry for entry in entries if entry is not None]
    if not cases and bench is None and not others:
        if not folder.exists():
            raise FileNotFoundError(f"{folder}: there is no such folder")
        raise FileNotFoundError(
            f"{folder}: no run.h5, no bench.h5 and no case file; run `foldproof verify` "
            "or `foldproof simulate` with --out first"
        )
    simulations = [one for case in cases if (one := load_if_readable(case.path))]
    alone = bench or (others[0] if others else None)
    provenance = (
        common_to([one.about_run for one in simulations])
        if simulations
        else alone.provenance
        if alone
        else {}
    )
    findings = [finding for one in simulations for finding in one.findings]
    return (
        Run(provenance=provenance, findings=findings, studies=studies, cases=cases, faults=[]),
        bench,
    )


def load_if_readable(path: Path) -> Case | None:
    """One simulation; None for a damaged file; the page says so."""
    try:
        return load_case(path)
    except Unreadable:
        return None


def common_to(provenances: list[dict[str, Any]]) -> dict[str, Any]:
    """The value that all of them share."""
    first, *others = provenances
    return {
        key: said
        for key, said in first.items()
        if all(str(other.get(key)) == str(said) for other in others)
    }


def draw(run: Run, bench: Run | None, figures: Path, for_papers: bool) -> Page:
    """Draws everything, on all cores, and gathers it for the page."""
    bench_studies = bench.studies if bench else []
    jobs: list[Job] = [
        (draw_case, (entry, figures, VIEWS // len(run.cases))) for entry in run.cases
    ]
    jobs += [(draw_study, (study, figures)) for study in run.studies + bench_studies]
    drawn = run_jobs(jobs, for_papers)
    return gather(run, bench, drawn[: len(run.cases)], drawn[len(run.cases) :])


def gather(run: Run, bench: Run | None, cases: list[CaseView], studies: list[StudyView]) -> Page:
    """The page of a run whose cases and studies were drawn, those
    of the speed measurements last."""
    everything = run.findings + (bench.findings if bench else [])
    for view in studies:
        view.findings = [
            finding
            for finding in everything
            if finding.kind in OF_STUDIES and finding.study == view.study.name
        ]
    checks, others, rates = findings_by_section(run, bench)
    for view in cases:
        view.foreign = origin_differs(view, run)
    usual, hard = findings_by_case(run.findings, run.cases, [view.anchor for view in cases])
    return Page(
        provenance=run.provenance,
        claims=claim_views(run.claims, everything),
        checks=checks,
        studies=studies[: len(run.studies)],
        other_findings=others,
        cases=cases,
        rates=rates,
        bench_studies=studies[len(run.studies) :],
        bench_provenance=bench.provenance if bench else {},
        faults=faults_of(run),
        tolerances=tolerances_of(run.findings),
        kinds=kinds_of(run.findings),
        case_findings=usual,
        hard_findings=hard,
        alone=run.path is None,
    )


def run_jobs(jobs: list[Job], for_papers: bool) -> list[Any]:
    """The results of the jobs, in their order; one process per core."""
    workers = min(os.cpu_count() or 1, len(jobs))
    if workers < 2:
        use_style(for_papers)
        return [make(*arguments) for make, arguments in jobs]
    with ProcessPoolExecutor(workers, initializer=start_worker, initargs=(for_papers,)) as pool:
        waiting = [pool.submit(make, *arguments) for make, arguments in jobs]
        return [job.result() for job in waiting]


def start_worker(for_papers: bool) -> None:
    """Makes a process ready to draw. It ends soon: looking for reference cycles
    would cost a tenth of its time."""
    gc.disable()
    use_style(for_papers)


def draw_study(study: Study, figures: Path) -> StudyView:
    """All figures of one study."""
    name = file_name(study.name)
    plots = [
        plot_study_figure(figure, f"{name}-{file_name(figure.name)}", figures)
        for figure in study.figures
    ]
    maps = [
        plot_study_map(study_map, f"{name}-{file_name(study_map.name)}", figures)
        for study_map in study.maps
    ]
    return StudyView(study, f"study-{name}", plots, maps, [])


def draw_case(entry: CaseEntry, figures: Path, most: int) -> CaseView:
    """Pictures, view (its data take `most` characters) and diagnostics of one case; a file that
    cannot be read becomes a sentence on the page."""
    name = file_name(entry.name)
    view = CaseView(entry, f"case-{name}")
    try:
        view.case = load_case(entry.path)
        view.row = make_pictures(view.case, name, figures)
        view.turning = make_field_view(view.case, name, figures, most)
        view.plots = (
            plot_contacts(view.case, name, figures)
            + plot_angle_spectrum(view.case, name, figures)
            + plot_diagnostics(view.case, name, figures)
        )
    except Unreadable as error:
        return CaseView(entry, view.anchor, problem=f"{entry.path.name} could not be read: {error}")
    except Exception as error:  # a damaged file may hold anything
        if isinstance(error, OSError) and error.errno is not None:
            raise  # figures that cannot be written
        return CaseView(
            entry, view.anchor, problem=f"{entry.path.name} could not be drawn: {one_line(error)}"
        )
    return view


def origin_differs(view: CaseView, run: Run) -> str:
    """Why the case's file is not the one that this run wrote, as when a later simulation wrote over
    it; "" if it is, or if nothing is known."""
    if view.case is None or run.path is None or not run.provenance.get("command"):
        return ""
    of_case, of_run = view.case.about_run, run.provenance
    if all(of_case.get(key) == of_run.get(key) for key in ("command", "date", "commit")):
        return ""
    return (
        f"{view.entry.path.name} is not the file that this run wrote: it comes from"
        f" \u201c{of_case.get('command', 'an unknown command')}\u201d of"
        f" {of_case.get('date', 'an unknown date')}, the run from \u201c{of_run['command']}\u201d"
        f" of {of_run.get('date', 'an unknown date')}. Pictures, plots and the case text below show"
        f" the later file; the findings case.{view.entry.name}.* on this page are of the run's own."
    )


def file_name(name: str) -> str:
    """The name with all but letters, digits, dots, hyphens and underscores replaced, and cut, so
    that any file system takes it."""
    return (
        "".join(c if c.isascii() and c.isalnum() or c in ".-_" else "-" for c in name).strip(".-")[
            :100
        ]
        or "unnamed"
    )


if __name__ == "__main__":
    sys.exit(main())
