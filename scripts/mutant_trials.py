"""Judges mutants: which are drawn, what is asked of each, in which order, and what is said of it.
Of scripts/mutate.
"""

import concurrent.futures
import functools
import itertools
import json
import math
import re
import shutil
import subprocess
import threading
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from edits import Change, apply, changes_of, place_of, sample
from mutants import (
    BUILD,
    PROGRAM,
    ROOT,
    TESTS,
    DoesNotCompile,
    Edit,
    Plan,
    Unusable,
    compile_mutant,
    findings,
    key_of,
    link_mutant,
    listed,
    unit_tests,
    write_at_once,
)

EXPLAINED = "verification/faults/equivalent_mutants.toml"
FOLDER = BUILD / "mutate"
# s of the unedited program's time; each batch of findings takes so many times the one before
FIRST_BATCH, GROWTH = 1.5, 2.0
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


class Batch(NamedTuple):
    """Names to be asked together, and how long the unedited program takes for them."""
    names: list[str]  # of checks, studies and cases; of unit tests with TEST before
    seconds: float


# ---- what is asked, in which order ---------------------------------------------------------------


TEST = "test: "
FEW = 5  # that may fail on a busy machine: those that measure time or memory


def seconds_by_name(plan: Plan, checks_only: bool) -> dict[str, float]:
    """How long each check, each study and case of the quick tier, and each short unit test takes
    the unedited program; measured once for each build. What does not hold is left out: it would
    say nothing of a mutant."""
    asked = {
        "checks": lambda: findings(PROGRAM, []),
        "unit tests": lambda: unit_tests(TESTS, [], None),
        "studies and cases": lambda: [timed(name) for name in studies_and_cases()],
    }
    stored, build = FOLDER / "seconds.json", key_of(plan)
    known = json.loads(stored.read_text(encoding="utf-8")) if stored.is_file() else {}
    seconds = known["seconds"] if known.get("build") == build else {}
    for kind, ask in asked.items():
        if kind not in seconds and not (checks_only and kind != "checks"):
            print(f"baseline: {kind} of the unedited program, once for this build", flush=True)
            rows = sound(ask())
            prefix = TEST if kind == "unit tests" else ""
            seconds[kind] = {prefix + row["name"]: row["seconds"] for row in rows}
            write_at_once(stored, json.dumps({"build": build, "seconds": seconds}))
    chosen = ["checks"] if checks_only else asked
    return {name: each for kind in chosen for name, each in seconds[kind].items()}


def studies_and_cases() -> list[str]:
    """Those of the quick tier."""
    long = set(listed()["long_cases"])
    cases = [
        "case." + name.split("/")[-1]
        for name in listed()["cases"]
        if name not in long
    ]
    return [study["name"] for study in listed()["studies"]] + cases


def timed(name: str) -> dict:
    start = time.monotonic()
    wrong = does_not_hold(findings(PROGRAM, [name]))
    outcome = "fails" if wrong else "holds"
    return {"name": name, "outcome": outcome, "seconds": time.monotonic() - start}


def sound(rows: list[dict]) -> list[dict]:
    """Those that hold; a few may not on a busy machine, more mean that the program is wrong."""
    wrong = does_not_hold(rows)
    if len(wrong) > FEW:
        raise Unusable("these do not hold on the unedited program: " + ", ".join(wrong))
    if wrong:
        print(f"left out, as they do not hold here: {', '.join(wrong)}", flush=True)
    return [row for row in rows if row["name"] not in wrong]


def kind_of(name: str, studies: set[str]) -> str:
    if name.startswith(TEST):
        return "test"
    if name.startswith("case."):
        return "case"
    return (
        "study"
        if any(name == study or name.startswith(study + ".") for study in studies)
        else "check"
    )


def batches_of(file: str, seconds: dict[str, float], studies: set[str]) -> list[Batch]:
    """First what faults name for this file; then all checks, studies and cases, unit tests, or, of
    what is not the method, the unit tests before the others; the fast ones first in each."""
    likely = likely_catchers(file)
    order = ["check", "study", "case", "test"]
    if not file.startswith("reference/"):
        order = ["test", *order]

    def rank(name: str) -> tuple[int, float]:
        return 0 if name in likely else 1 + order.index(kind_of(name, studies)), seconds[name]

    batches, most = [], FIRST_BATCH
    for name in sorted(seconds, key=rank):
        if batches and batches[-1].seconds + seconds[name] <= most:
            batches[-1] = Batch(batches[-1].names + [name], batches[-1].seconds + seconds[name])
        else:
            most *= GROWTH if batches else 1
            batches.append(Batch([name], seconds[name]))
    return batches


@functools.cache
def faults_listed() -> list[dict]:
    lists = (ROOT / "verification/faults").glob("*.toml")
    return [
        row
        for path in lists
        for row in tomllib.loads(path.read_text(encoding="utf-8")).get("fault", [])
    ]


def likely_catchers(file: str) -> set[str]:
    """Checks, and unit tests with TEST before, that catch a fault of this file."""
    rows = [row for row in faults_listed() if row["file"] == file]
    return {name for row in rows for name in row.get("caught_by", [])} | {
        TEST + name for row in rows for name in row.get("caught_by_tests", [])
    }


# ---- judging -------------------------------------------------------------------------------------


class Target:
    """One file to be mutated: its text, its own object code, and what is asked."""

    def __init__(
        self, file: str, plan: Plan, seed: int, batches: list[Batch],
        explained: set[tuple[str, str, str]]
    ) -> None:
        self.file, self.plan, self.batches, self.explained = file, plan, batches, explained
        self.text = (ROOT / file).read_text(encoding="utf-8")
        name = re.sub(r"\W", "-", file)
        self.overlay = FOLDER / f"{name}-{seed}"  # another seed may be run at the same time
        self.unedited = self.compile(self.text, "unedited")
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
                link = functools.partial(
                    link_mutant, self.plan, objects, overlay=self.folder(name)
                )
                judged = self.judge_mutant(mutant, link)
        except DoesNotCompile as error:
            judged = Judgement(mutant, "not compiled", what=str(error))
        except Unusable as error:
            judged = Judgement(mutant, "ERROR", what=str(error))
        if judged.outcome != "SURVIVED":
            shutil.rmtree(self.folder(name), ignore_errors=True)
        return judged._replace(seconds=time.monotonic() - start)

    def judge_mutant(self, mutant: Mutant, link: Callable[[str], Path]) -> Judgement:
        """Asks batch by batch, up to the first finding that fails; of one that is declared
        equivalent, only whether the checks that are near say otherwise."""
        is_explained = (mutant.file, mutant.before, mutant.after) in self.explained
        link = functools.cache(link)
        for batch in self.batches[:1] if is_explained else self.batches:
            try:
                failing = self.first_failing(batch, link)
            except subprocess.TimeoutExpired:
                limit = (
                    f"{clock_of(batch):.0f} s, where the unedited program takes"
                    f" {batch.seconds:.1f} s"
                )
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
        for names, prefix, program, ask in (
            (checks, "", "foldproof", findings), (tests, TEST, "tests", unit_tests)
        ):
            for name in does_not_hold(ask(link(program), names, clock)) if names else []:
                again = does_not_hold(ask(link(program), [name], once_more))
                if again and not does_not_hold(ask(self.control(program), [name], once_more)):
                    return prefix + name
        return None

    @functools.cache
    def control(self, program: str) -> Path:
        """The unedited program, its file compiled as a mutant's is."""
        try:
            return link_mutant(self.plan, self.unedited, program, self.folder("unedited"))
        except Unusable as error:  # says nothing of a mutant
            raise RuntimeError(f"{self.file}, unedited: {error}") from error


def does_not_hold(rows: list[dict]) -> list[str]:
    return [row["name"] for row in rows if row["outcome"] in ("fails", "inconclusive")]


def clock_of(batch: Batch) -> float:
    """Many times what the unedited program takes for it, optimised, on the same cores [s]."""
    return 30 + 15 * batch.seconds


def code_of(objects: dict[str, list[Path]]) -> list[bytes]:
    """The object code that a mutant's own sources were compiled to: without debug information it
    depends on nothing else."""
    return [paths[0].read_bytes() for paths in objects.values()]


class Targets:
    """The files of a sample, each made ready when its first mutant comes."""

    def __init__(
        self, plan: Plan, seed: int, seconds: dict[str, float], studies: set[str],
        explained: set[tuple[str, str, str]]
    ) -> None:
        self.made: dict[str, Target] = {}
        self.lock = threading.Lock()
        self.make = lambda file: Target(
            file, plan, seed, batches_of(file, seconds, studies), explained
        )

    def judge(self, mutant: Mutant) -> Judgement:
        with self.lock:
            if mutant.file not in self.made:
                self.made[mutant.file] = self.make(mutant.file)
        return self.made[mutant.file].judge(mutant)


def sample_of(name: str, seed: int) -> list[Mutant]:
    """Every mutant of a file, or of all files of a folder, in an order that the seed decides: each
    edit is as likely as any other, so long files get more of them."""
    path = ROOT / name
    sources = [*path.glob("*.cpp"), *path.glob("*.h")] if path.is_dir() else [path]
    texts = {
        str(file.relative_to(ROOT)): file.read_text(encoding="utf-8") for file in sorted(sources)
    }
    edits = [(file, change) for file, text in texts.items() for change in changes_of(text)]
    return [
        mutant_of(file, texts[file], number, change)
        for number, (file, change) in enumerate(sample(edits, seed))
    ]


def mutant_of(file: str, text: str, number: int, change: Change) -> Mutant:
    line, before = place_of(text, change)
    after = apply(text, change).splitlines()[line - 1].strip()
    return Mutant(file, number, change, line, before, after)


def judge_sample(
    targets: Targets, mutants: list[Mutant], count: int, jobs: int
) -> list[Judgement]:
    """Judges mutants in their order until `count` of them have code of
    their own. Prints a line for each."""
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
    text = (
        f"{one.outcome:12} {one.seconds:6.1f} s  {mutant.file}:{mutant.line} {mutant.change.kind}"
    )
    if one.outcome in ("SURVIVED", "equivalent", "ERROR"):
        return f"{text}\n    - {mutant.before}\n    + {mutant.after}" + (
            f"\n    {one.what}" if one.what else ""
        )
    return f"{text}: {one.by} {one.what}".rstrip(": ")


def read_explained() -> set[tuple[str, str, str]]:
    """File, line and what it becomes, of mutants that are declared equivalent;
    refuses rows whose line is not there."""
    try:
        rows = tomllib.loads((ROOT / EXPLAINED).read_text(encoding="utf-8")).get("mutant", [])
        found = {(row["file"], row["line"], row["becomes"]) for row in rows if row["reason"]}
    except (OSError, tomllib.TOMLDecodeError, KeyError) as error:
        raise Unusable(f"{EXPLAINED}: {error}") from error
    for file, line, _ in sorted(found):
        occurrences = [
            text.strip() for text in (ROOT / file).read_text(encoding="utf-8").splitlines()
        ].count(line)
        if occurrences != 1:
            raise Unusable(
                f"{EXPLAINED}: '{line}' stands {occurrences} times in {file}; it must stand there"
                " once"
            )
    return found


def score_interval(hits: int, of: int) -> tuple[float | None, float | None]:
    """What share 95 % of such samples leave possible: Wilson's interval (Wilson, J. Am. Stat.
    Assoc. 22, 1927)."""
    if not of:
        return None, None
    z, share = 1.959964, hits / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of)) / (1 + z * z / of)
    return middle - half, middle + half
