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
    names: list[str]
    seconds: float


# ---- what is asked, in which order ---------------------------------------------------------------


UNIT_TESTS = "unit tests"


def seconds_by_name(plan: Plan, checks_only: bool) -> dict[str, float]:
    """How long each check, each study and case of the quick tier, and the unit tests together take
    the unedited program; measured once for each build."""
    stored, build = FOLDER / "seconds.json", key_of(plan)
    known = json.loads(stored.read_text(encoding="utf-8")) if stored.is_file() else {}
    seconds = known["seconds"] if known.get("build") == build else {}
    if "checks" not in seconds:
        print("baseline: all checks of the unedited program, once for this build", flush=True)
        seconds["checks"] = {row["name"]: row["seconds"] for row in sound(findings(PROGRAM, []))}
    if "tests" not in seconds and not checks_only:
        print("baseline: unit tests of the unedited program, once for this build", flush=True)
        start = time.monotonic()
        sound(unit_tests(TESTS, [], None))
        seconds["tests"] = time.monotonic() - start
    if "others" not in seconds and not checks_only:
        print(
            "baseline: studies and cases of the unedited program, once for this build", flush=True
        )
        seconds["others"] = {name: time_of(name) for name in studies_and_cases()}
    write_at_once(stored, json.dumps({"build": build, "seconds": seconds}))
    if checks_only:
        return seconds["checks"]
    return seconds["checks"] | seconds["others"] | {UNIT_TESTS: seconds["tests"]}


def studies_and_cases() -> list[str]:
    """Those of the quick tier."""
    long = set(listed()["long_cases"])
    cases = [
        "case." + name.split("/")[-1]
        for name in listed()["cases"]
        if name not in long
    ]
    return [study["name"] for study in listed()["studies"]] + cases


def time_of(name: str) -> float:
    start = time.monotonic()
    sound(findings(PROGRAM, [name]))
    return time.monotonic() - start


def sound(rows: list[dict]) -> list[dict]:
    wrong = [row["name"] for row in rows if row["outcome"] == "fails"]
    if wrong:
        raise Unusable("these do not hold on the unedited program: " + ", ".join(wrong))
    return rows


def kind_of(name: str, studies: set[str]) -> str:
    if name == UNIT_TESTS:
        return "test"
    if name.startswith("case."):
        return "case"
    return (
        "study"
        if any(name == study or name.startswith(study + ".") for study in studies)
        else "check"
    )


def batches_of(file: str, seconds: dict[str, float], studies: set[str]) -> list[Batch]:
    """First the checks that faults name for this file, then all checks, then studies and cases; in
    each of these the fast ones first; the unit tests last, alone."""
    lists = (ROOT / "verification/faults").glob("*.toml")
    rows = [
        row
        for path in lists
        for row in tomllib.loads(path.read_text(encoding="utf-8")).get("fault", [])
    ]
    likely = {name for row in rows if row["file"] == file for name in row.get("caught_by", [])}
    def rank(name: str) -> tuple[int, float]:
        kind = kind_of(name, studies)
        first = 0 if kind == "check" and name in likely else {"check": 1, "test": 3}.get(kind, 2)
        return first, seconds[name]
    batches, most = [], FIRST_BATCH
    for name in sorted(seconds, key=rank):
        if batches and name != UNIT_TESTS and batches[-1].seconds + seconds[name] <= most:
            batches[-1] = Batch(batches[-1].names + [name], batches[-1].seconds + seconds[name])
        else:
            most *= GROWTH if batches else 1
            batches.append(Batch([name], seconds[name]))
    return batches


# ---- judging -------------------------------------------------------------------------------------


class Target:
    """One file to be mutated: its text, its own object code, and what is asked."""

    def __init__(
        self, file: str, plan: Plan, seed: int, batches: list[Batch],
        explained: set[tuple[str, str, str]]
    ) -> None:
        self.file, self.plan, self.batches, self.explained = file, plan, batches, explained
        self.text = (ROOT / file).read_text(encoding="utf-8")
        name = re.sub(r"\W", "-", file.removeprefix("reference/"))
        self.overlay = FOLDER / f"{name}-{seed}"  # another seed may be run at the same time
        unedited = self.compile(self.text, "unedited")
        self.code, self.control = code_of(unedited), link_mutant(
            plan, unedited, "foldproof", self.folder("unedited")
        )

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
        program = link("foldproof")
        for batch in self.batches[:1] if is_explained else self.batches:
            try:
                if batch.names == [UNIT_TESTS]:
                    failing = first_failing_test(link("tests"), clock_of(batch))
                    by = "test"
                else:
                    failing, by = self.first_failing(batch, program), ""
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
                return Judgement(mutant, "killed", by, failing)
        return Judgement(mutant, "equivalent" if is_explained else "SURVIVED")

    def first_failing(self, batch: Batch, program: Path) -> str | None:
        """The first finding of the batch that surely does not hold."""
        rows = findings(program, batch.names, clock_of(batch))
        failing = [row["name"] for row in rows if row["outcome"] in ("fails", "inconclusive")]
        return next((name for name in failing if self.is_sure(name, program)), None)

    def is_sure(self, name: str, program: Path) -> bool:
        """Does the finding fail again, and hold on the unedited file that was made in the same way?
        What measures seconds may fail by itself on a busy machine."""
        clock = clock_of(Batch([name], 10.0))
        again, unedited = (findings(asked, [name], clock) for asked in (program, self.control))
        return all(row["outcome"] == "holds" for row in unedited) and any(
            row["outcome"] != "holds" for row in again
        )


def first_failing_test(mutant: Path, clock: float) -> str | None:
    """The first unit test that fails twice with the mutant, and not with the unedited file."""
    failing = [row["name"] for row in unit_tests(mutant, [], clock) if row["outcome"] == "fails"]
    for name in failing:
        [again], [unedited] = (unit_tests(asked, [name], clock) for asked in (mutant, TESTS))
        if again["outcome"] == "fails" and unedited["outcome"] == "holds":
            return name
    return None


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
