"""Judges mutants: which are drawn, how each is asked, and what is said of it.
Of scripts/mutate.
"""

import collections
import concurrent.futures
import functools
import itertools
import re
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Set
from pathlib import Path
from typing import NamedTuple

from builds import ROOT, Unusable
from edits import Change, apply, changes_of, place_of, sample
from mutant_questions import FOLDER, TEST, Batch, batches_of, clock_of, does_not_hold
from mutants import (
    DoesNotCompile, Edit, Plan, compile_mutant, compile_unedited, findings, link_mutant, unit_tests
)
from reach import Table

sys.path.insert(0, str(ROOT / "reports"))
from data.mutation_scores import EXPLAINED, read_explained_edits  # noqa: E402

MOST_UNITS = 20  # that a header may be part of to be drawn from a folder


class Mutant(NamedTuple):
    file: str
    number: int  # in the file's sample
    change: Change
    line: int
    before: str  # text of the line
    after: str


class Judgement(NamedTuple):
    mutant: Mutant
    outcome: str  # killed, SURVIVED, equivalent, same code, not compiled, ERROR
    by: str = ""  # of a killed one: check, study, case, refusal, crash or clock
    what: str = ""  # the finding that failed, or what was said
    seconds: float = 0.0
    left_out: int = 0  # names that were not to be asked: they do not reach the edited function


class Questions(NamedTuple):
    """What may be asked of mutants."""
    seconds: dict[str, float]  # by name: how long the unedited program takes
    studies: set[str]
    table: Table | None  # who reaches what; without it, everything is asked

    def reaching(self, mutant: Mutant, text: str) -> set[str]:
        """The names that reach the edited function of this text; all, where it is not known."""
        found = self.table.names_for(mutant.file, text, mutant.line) if self.table else None
        return set(self.seconds) if found is None else found

    def batches(self, file: str, reaching: set[str]) -> list[Batch]:
        """Of these names, and of those of which it is not known what they reach."""
        names = reaching | (self.table.unknown if self.table else set())
        chosen = {name: seconds for name, seconds in self.seconds.items() if name in names}
        return batches_of(file, chosen, self.studies)


# ---- judging -------------------------------------------------------------------------------------


class Target:
    """One file to be mutated: its text, its own object code, and what is asked."""

    def __init__(self, file: str, plan: Plan, seed: int, questions: Questions,
                 explained: set[tuple[str, str, str]]) -> None:
        self.file, self.plan, self.questions, self.explained = file, plan, questions, explained
        self.text = (ROOT / file).read_text(encoding="utf-8")
        name = re.sub(r"\W", "-", file)
        self.overlay = FOLDER / f"{name}-{seed}"  # another seed may be run at the same time
        self.unedited = compile_unedited(plan, file)
        self.code = code_of(self.unedited)

    def folder(self, name: str) -> Path:
        return self.overlay / name

    def compile(self, text: str, name: str) -> dict[str, list[Path]]:
        shutil.rmtree(self.folder(name), ignore_errors=True)
        return compile_mutant(self.plan, Edit(name, self.file, text), self.folder(name))

    def judge(self, mutant: Mutant) -> Judgement:
        start, name = time.monotonic(), str(mutant.number)
        try:
            objects = self.compile(apply(self.text, mutant.change), name)
            if code_of(objects) == self.code:
                judged = Judgement(mutant, "same code")
            else:
                link = functools.partial(link_mutant, self.plan, objects,
                                         overlay=self.folder(name))
                judged = self.ask_who_reaches(mutant, link)
        except DoesNotCompile as error:
            judged = Judgement(mutant, "not compiled", what=str(error))
        except Unusable as error:
            judged = Judgement(mutant, "ERROR", what=str(error))
        if judged.outcome != "SURVIVED":
            shutil.rmtree(self.folder(name), ignore_errors=True)
        return judged._replace(seconds=time.monotonic() - start)

    def ask_who_reaches(self, mutant: Mutant, link: Callable[[str], Path]) -> Judgement:
        reaching = self.questions.reaching(mutant, self.text)
        batches = self.questions.batches(self.file, reaching)
        judged = self.judge_mutant(mutant, batches, link)
        if judged.outcome == "SURVIVED" and not reaching:
            judged = judged._replace(what="nothing reaches it")
        asked = sum(len(batch.names) for batch in batches)
        return judged._replace(left_out=len(self.questions.seconds) - asked)

    def judge_mutant(self, mutant: Mutant, batches: list[Batch],
                     link: Callable[[str], Path]) -> Judgement:
        """Asks batch by batch, up to the first finding that fails; of one that is declared
        equivalent, only whether the checks that are near say otherwise."""
        is_explained = (mutant.file, mutant.before, mutant.after) in self.explained
        link = functools.cache(link)
        for batch in batches[:1] if is_explained else batches:
            try:
                failing = self.first_failing(batch, link)
            except subprocess.TimeoutExpired:
                limit = (f"{clock_of(batch):.0f} s, where the unedited program takes"
                         f" {batch.seconds:.1f} s")
                return Judgement(mutant, "killed", "clock", limit)
            except ChildProcessError as error:
                return Judgement(mutant, "killed", "crash", str(error))
            except Unusable as error:
                return Judgement(mutant, "killed", "refusal", str(error))
            if failing:
                return Judgement(mutant, "killed", "", failing)
        return Judgement(mutant, "equivalent" if is_explained else "SURVIVED")

    def first_failing(self, batch: Batch, link: Callable[[str], Path]) -> str | None:
        """The first of the batch that surely does not hold: that fails again, and holds on the
        unedited file that was made in the same way. What measures seconds may fail by itself on a
        busy machine."""
        tests = [name.removeprefix(TEST) for name in batch.names if name.startswith(TEST)]
        checks = [name for name in batch.names if not name.startswith(TEST)]
        clock, once_more = clock_of(batch), clock_of(Batch([], 10.0))
        for names, prefix, program, ask in ((checks, "", "foldproof", findings),
                                            (tests, TEST, "tests", unit_tests)):
            for name in does_not_hold(ask(link(program), names, clock)) if names else []:
                again = does_not_hold(ask(link(program), [name], once_more))
                if again and not does_not_hold(ask(self.control(program), [name], once_more)):
                    return prefix + name
        return None

    @functools.cache
    def control(self, program: str) -> Path:
        """The unedited program, its file compiled as a mutant's is."""
        self.folder("unedited").mkdir(parents=True, exist_ok=True)
        try:
            return link_mutant(self.plan, self.unedited, program, self.folder("unedited"))
        except Unusable as error:  # says nothing of a mutant
            raise RuntimeError(f"{self.file}, unedited: {error}") from error


def code_of(objects: dict[str, list[Path]]) -> list[bytes]:
    """The object code that a mutant's own sources were compiled to: without debug information it
    depends on nothing else."""
    return [paths[0].read_bytes() for paths in objects.values()]


class Targets:
    """The files of a sample, each made ready when its first mutant comes."""

    def __init__(self, plan: Plan, seed: int, questions: Questions,
                 explained: set[tuple[str, str, str]]) -> None:
        self.made: dict[str, Target] = {}
        self.lock = threading.Lock()
        self.make = lambda file: Target(file, plan, seed, questions, explained)

    def judge(self, mutant: Mutant) -> Judgement:
        with self.lock:
            if mutant.file not in self.made:
                self.made[mutant.file] = self.make(mutant.file)
        return self.made[mutant.file].judge(mutant)


def wide_headers(plan: Plan) -> set[Path]:
    """Those of whose edits each is most of a build."""
    counts = collections.Counter(path for unit in plan.units for path in unit.made_from)
    return {path for path, units in counts.items() if units > MOST_UNITS and path.suffix == ".h"}


def sample_of(name: str, seed: int, left_out: Set[Path] = frozenset()) -> list[Mutant]:
    """Every mutant of a file, or of all files of a folder but some, in an order that the seed
    decides: each edit is as likely as any other, so long files get more of them."""
    path = ROOT / name
    sources = [path]
    if path.is_dir():
        sources = [file for ending in ("cpp", "h") for file in path.glob(f"*.{ending}")]
        sources = [file for file in sources if file.resolve() not in left_out]
    texts = {str(file.relative_to(ROOT)): file.read_text(encoding="utf-8")
             for file in sorted(sources)}
    edits = [(file, change) for file, text in texts.items() for change in changes_of(text)]
    return [mutant_of(file, texts[file], number, change)
            for number, (file, change) in enumerate(sample(edits, seed))]


def mutant_of(file: str, text: str, number: int, change: Change) -> Mutant:
    line, before = place_of(text, change)
    after = apply(text, change).splitlines()[line - 1].strip()
    return Mutant(file, number, change, line, before, after)


def judge_sample(targets: Targets, mutants: list[Mutant], count: int,
                 jobs: int) -> list[Judgement]:
    """Judges mutants in their order until `count` of them have code of their own. Prints a line
    for each."""
    todo = iter(mutants)
    judged: list[Judgement] = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(targets.judge, mutant) for mutant in itertools.islice(todo, count)}
        while running:
            done, running = concurrent.futures.wait(
                running, return_when=concurrent.futures.FIRST_COMPLETED
            )
            for one in (future.result() for future in done):
                if one.outcome in ("not compiled", "same code") and (more := next(todo, None)):
                    running.add(pool.submit(targets.judge, more))
                judged.append(one)
                print(line_of(one), flush=True)
    return sorted(judged, key=lambda one: one.mutant.number)


def line_of(one: Judgement) -> str:
    mutant = one.mutant
    place = f"{mutant.file}:{mutant.line} {mutant.change.kind}"
    text = f"{one.outcome:12} {one.seconds:6.1f} s  {place}"
    if one.outcome in ("SURVIVED", "equivalent", "ERROR"):
        said = f"\n    {one.what}" if one.what else ""
        return f"{text}\n    - {mutant.before}\n    + {mutant.after}{said}"
    return f"{text}: {one.by} {one.what}".rstrip(": ")


def read_explained() -> set[tuple[str, str, str]]:
    """File, line and what it becomes, of mutants that are declared equivalent;
    refuses rows whose line does not stand there as often as they say."""
    edits = read_explained_edits()
    for edit in edits:
        text = (ROOT / edit.file).read_text(encoding="utf-8")
        times = [row.strip() for row in text.splitlines()].count(edit.line)
        if times != edit.times:
            raise Unusable(f"{EXPLAINED.name}: '{edit.line}' stands {times} times in {edit.file},"
                           f" not {edit.times}")
    return {(edit.file, edit.line, edit.becomes) for edit in edits}
