"""Draws what a report shows of a run, on all cores."""
from __future__ import annotations

import gc
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from data.results import CaseEntry, Run, load_case
from data.studies import Study
from data.unreadable import Unreadable, one_line
from pages.page import CaseView, Page, StudyView
from pictures.case_pictures import make_pictures
from pictures.garment_pictures import make_garment_view
from plots.angle_spectrum import plot_angle_spectrum
from plots.case_plots import plot_diagnostics
from plots.contact_maps import plot_contacts
from plots.map_plots import plot_study_map
from plots.plot_style import use_style
from plots.study_plots import plot_study_figure
from viewer.field_pictures import make_field_view

# characters that the data of all views of a page may take, shared equally
VIEWS = 4_000_000

Job = tuple[Callable[..., Any], tuple[Any, ...]]


def draw(run: Run, bench: Run | None, figures: Path, for_papers: bool) -> Page:
    """The report of a run, with all its pictures and plots."""
    bench_studies = bench.studies if bench else []
    jobs: list[Job] = [
        (draw_case, (entry, figures, VIEWS // len(run.cases))) for entry in run.cases
    ]
    jobs += [(draw_study, (study, figures)) for study in run.studies + bench_studies]
    drawn = run_jobs(jobs, for_papers)
    for view in drawn[: len(run.cases)]:
        view.foreign = origin_differs(view, run)
    return Page(run, bench, drawn[: len(run.cases)], drawn[len(run.cases) :])


def undrawn(run: Run, bench: Run | None) -> Page:
    """The report of a run without pictures and plots."""
    return Page(
        run, bench, [CaseView(entry, f"case-{file_name(entry.name)}") for entry in run.cases],
        [StudyView(study, f"study-{file_name(study.name)}") for study in run.studies]
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
    return StudyView(study, f"study-{name}", plots, maps)


def draw_case(entry: CaseEntry, figures: Path, most: int) -> CaseView:
    """Pictures, view (its data take `most` characters) and diagnostics of one case; a file that
    cannot be read becomes a sentence on the page."""
    name = file_name(entry.name)
    view = CaseView(entry, f"case-{name}")
    try:
        view.case = load_case(entry.path)
        view.row = make_pictures(view.case, name, figures)
        view.garment = make_garment_view(view.case, name, figures)
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
