"""foldproof in Python: put a solver on trial, read and plot results. Needs numpy, pandas and
cloudpickle; `read` needs h5py, `plot` also matplotlib and jinja2 (pip install foldproof[report]).

    import foldproof
    class Mine(foldproof.Solver): ...         # prepare(scene), advance(dt, steps)
    table = foldproof.judge(Mine)             # a row a law: outcome, measured, bound, unit, ...

The program is always a process of its own: this package links none of its libraries.
"""
from __future__ import annotations

import contextlib
import inspect
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foldproof.solver import Declined, Scene, Solver, serve

if TYPE_CHECKING:
    import pandas

__all__ = ["Declined", "Figures", "Scene", "Solver", "cases", "judge", "laws", "plot", "program",
           "read", "run", "serve", "table"]

HERE = Path(__file__).parent
REPORT_ROOMS = ("data", "pages", "plots", "pictures", "viewer", "foldproof_results")
# by the module of its base, which may be a copy of foldproof.solver
SERVE = """
import sys, cloudpickle
solver = cloudpickle.load(open(sys.argv[1], 'rb'))
base = next(one for one in solver.__mro__ if one.__name__ == 'Solver')
sys.modules[base.__module__].serve(solver())
"""
COLUMNS = ("name", "outcome", "measured", "bound", "uncertainty", "unit", "seconds", "note",
           "claim")


def program() -> str:
    """The program's file: of the wheel, of the source tree's build, or the one on the PATH."""
    for file in (HERE / "bin/foldproof", HERE.parents[3] / "build/foldproof"):
        if file.is_file():
            return str(file)
    found = shutil.which("foldproof")
    if not found:
        raise FileNotFoundError("the program foldproof is neither in this package nor on the PATH")
    return found


def _environment(**more: str) -> dict[str, str]:
    """Scripts of reports run with the Python of the wheel, which has its packages."""
    own = {"FOLDPROOF_PYTHON": sys.executable} if (HERE / "bin/foldproof").is_file() else {}
    return {**os.environ, **own, **more}


def run(*words: str | Path, **how: Any) -> subprocess.CompletedProcess[str]:
    """Runs a command of the program, as run("simulate", "hanging_sheet", "--out", "mine"); `how` is
    that of subprocess.run. Raises ValueError with the program's message for bad input."""
    how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "env": _environment(), **how}
    done = subprocess.run([program(), *map(str, words)], text=True, check=False, **how)
    if done.returncode == 2:
        raise ValueError((done.stderr or done.stdout or "bad input").strip())
    return done


def main() -> None:
    """The command `foldproof` of the wheel."""
    os.execve(program(), ["foldproof", *sys.argv[1:]], _environment())


def judge(
    solver: type[Solver] | str,
    laws: str | Iterable[str] = (),
    *,
    settings: Mapping[str, Any] | None = None,
    out: str | Path | None = None,
    bundle: str | Path | None = None,
    options: Iterable[str | Path] = (),
) -> pandas.DataFrame:
    """Puts a solver on trial and returns the verdicts, a row a law, by its name.

    solver    a class derived from Solver, made without arguments in processes of its own (it may
              be defined in a notebook), or the command of an adapter
    laws      the name of a law set ("2026.1"), or names, groups or beginnings of names; all if none
    settings  given to the solver's `prepare`
    out       folder for run.h5, verdicts.json, junit.xml and solver.json
    bundle    file for `foldproof results add`; needs a law set
    options   further words of `foldproof judge`, as ("--baseline", "kept/verdicts.json")

    Columns: outcome (holds, fails, inconclusive, not applicable, did not run); measured and bound
    [unit]; uncertainty [unit]; seconds [s]; note; claim. `attrs["solver"]` is what the solver
    declares and how it maps the scene's material. Raises ValueError for a wrong name or setting.
    """
    chosen = [laws] if isinstance(laws, str) else list(laws)
    words: list[str | Path] = [name for name in chosen if not name[:1].isdigit()]
    for name in chosen:
        words += ["--laws", name] if name[:1].isdigit() else []
    for key, value in (settings or {}).items():
        words += ["--settings", f"{key}={value}"]
    words += ["--bundle", bundle] if bundle else []
    with tempfile.TemporaryDirectory(prefix="foldproof ") as scratch:
        folder = Path(out or scratch) if out else Path(scratch) / "out"
        command = solver if isinstance(solver, str) else _command_of(solver, Path(scratch))
        # classes of modules are found as they are found here
        paths = os.pathsep.join(path or os.getcwd() for path in sys.path)
        run("judge", "--solver", command, *words, "--out", folder, "--restart", *options,
            env=_environment(PYTHONPATH=paths))
        found = json.loads((folder / "verdicts.json").read_text())["findings"]
        facts = json.loads((folder / "solver.json").read_text())
    verdicts = table(found)
    verdicts.attrs["solver"] = facts
    return verdicts


def _command_of(solver: type[Solver], folder: Path) -> str:
    """Starts the class in a Python like this one; its source is named last, for a bundle."""
    import cloudpickle

    file = folder / "solver.pickle"
    file.write_bytes(cloudpickle.dumps(solver))
    source = Path(inspect.getsourcefile(solver) or "")
    if not source.is_file():  # of a notebook
        source = folder / "solver.py"
        source.write_text(inspect.getsource(solver))
    return "exec " + shlex.join([sys.executable, "-c", SERVE, str(file), str(source)])


def table(findings: Iterable[Any] | Mapping[str, Any]) -> pandas.DataFrame:
    """Findings by name: those of verdicts.json, or `read("run.h5").findings`."""
    import pandas

    if isinstance(findings, Mapping):
        findings = findings.values()
    rows = [one if isinstance(one, dict) else vars(one) for one in findings]
    columns = {name: [row.get(name) for row in rows] for name in COLUMNS}
    numbers = {name: "float64" for name in ("measured", "bound", "uncertainty", "seconds")}
    return pandas.DataFrame(columns).set_index("name").astype(numbers)


def _list() -> dict[str, Any]:
    return json.loads(run("list", "--json").stdout)


def laws() -> pandas.DataFrame:
    """The laws by name: claim, source, and what they need of a solver."""
    import pandas

    return pandas.DataFrame(_list()["laws"]).set_index("name")


def cases() -> dict[str, Path]:
    """The shipped cases by name, with their files."""
    listed = _list()
    return {name: Path(listed["cases_folder"]) / f"{name}.toml" for name in listed["cases"]}


@contextlib.contextmanager
def _reports() -> Iterator[None]:
    """The modules of reports/, whose names (data, plots) are then free for others again."""
    folder = str(Path(_list()["cases_folder"]).parent / "reports")

    def own() -> list[str]:
        return [name for name in sys.modules if name.partition(".")[0] in REPORT_ROOMS]

    others = {name: sys.modules.pop(name) for name in own()}
    sys.modules.update(_kept)
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path.remove(folder)
        _kept.update({name: sys.modules.pop(name) for name in own()})
        sys.modules.update(others)


_kept: dict[str, Any] = {}


def read(path: str | Path) -> Any:
    """Results of a run (run.h5, or the folder that has it): provenance, findings, studies, claims
    and cases by name; or a Trajectory (CASE.h5): times (T) [s], positions (T, N, 3) [m], velocities
    [m/s], triangles (M, 3), diagnostics by name with units. Raises an error that names the file."""
    with _reports():
        from foldproof_results import Unreadable, load_results, load_trajectory

        try:
            return load_results(path)
        except Unreadable as error:
            if Path(path).is_dir() or "no run of foldproof" not in str(error):
                raise
            return load_trajectory(path)


class Figures(dict[str, str]):
    """SVG texts by name; a notebook shows them one below the other."""

    def _repr_html_(self) -> str:
        return "\n".join(self.values())


def plot(path: str | Path, *names: str) -> Figures:
    """The report's figures: of the studies of a run.h5, or of the energies, momenta and steps of a
    CASE.h5. names: words that a figure's name holds; all figures if there is none."""
    with _reports(), tempfile.TemporaryDirectory() as scratch:
        from data.results import load_case, load_run
        from plots.case_plots import plot_diagnostics
        from plots.plot_style import use_style
        from plots.study_plots import plot_study_figure

        use_style()
        folder, path = Path(scratch), Path(path)
        run_file = path / "run.h5" if path.is_dir() else path
        made = [plot_study_figure(figure, f"{study.name}-{figure.name}", folder)
                for study in load_run(run_file).studies for figure in study.figures]
        if not made:
            made = [figure for _, figure in plot_diagnostics(load_case(path), path.stem, folder)]
        return Figures({one.name: (folder / f"{one.name}.svg").read_text() for one in made
                        if not names or any(name in one.name for name in names)})
