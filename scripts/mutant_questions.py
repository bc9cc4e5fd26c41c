"""What is asked of a mutant, in which order, and how long the unedited program takes for it.
Of scripts/mutate.
"""

import functools
import json
import sys
import time
from typing import NamedTuple

from builds import PROGRAM, ROOT, Unusable, listed, write_at_once
from mutants import BUILD, TESTS, Plan, findings, keys_of, unit_tests

sys.path.insert(0, str(ROOT / "reports"))
from data.mutation_scores import FAULTS, fault_rows  # noqa: E402

FOLDER = BUILD / "mutate"
# s of the unedited program's time; each batch of findings takes so many times the one before
FIRST_BATCH, GROWTH = 1.5, 2.0
TEST = "test: "
FEW = 5  # that may fail on a busy machine: those that measure time or memory


class Batch(NamedTuple):
    """Names to be asked together, and how long the unedited program takes for them."""
    names: list[str]  # of checks, studies and cases; of unit tests with TEST before
    seconds: float


def seconds_by_name(plan: Plan, checks_only: bool) -> dict[str, float]:
    """How long each check, each study and case of the quick tier, and each short unit test takes
    the unedited program; measured once for each build. What does not hold is left out: it would
    say nothing of a mutant."""
    asked = {
        "checks": lambda: findings(PROGRAM, []),
        "unit tests": lambda: unit_tests(TESTS, [], None),
        "studies and cases": lambda: [timed(name) for name in studies_and_cases()],
    }
    stored, keys = FOLDER / "seconds.json", keys_of(plan)
    known = json.loads(stored.read_text(encoding="utf-8")) if stored.is_file() else {}
    made_by = {kind: keys["tests" if kind == "unit tests" else "foldproof"] for kind in asked}
    seconds = {kind: each for kind, each in known.get("seconds", {}).items()
               if known.get("keys", {}).get(kind) == made_by[kind]}
    chosen = ["checks"] if checks_only else list(asked)
    for kind in chosen:
        if kind not in seconds:
            print(f"baseline: {kind} of the unedited program, once for this build", flush=True)
            prefix = TEST if kind == "unit tests" else ""
            seconds[kind] = {prefix + row["name"]: row["seconds"] for row in sound(asked[kind]())}
            write_at_once(stored, json.dumps({"keys": made_by, "seconds": seconds}))
    return {name: each for kind in chosen for name, each in seconds[kind].items()}


def studies_and_cases() -> list[str]:
    """Those of the quick tier."""
    long = set(listed()["long_cases"])
    cases = [f"case.{name.split('/')[-1]}" for name in listed()["cases"] if name not in long]
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
    is_study = any(name == study or name.startswith(study + ".") for study in studies)
    return "study" if is_study else "check"


def batches_of(file: str, seconds: dict[str, float], studies: set[str]) -> list[Batch]:
    """First what faults name for this file; then checks and unit tests, studies and cases, or, of
    what is not the method, the unit tests before the others; the fast ones first in each."""
    likely = likely_catchers(file)
    order = {"check": 1, "test": 1, "study": 2, "case": 2}
    if not file.startswith("reference/"):
        order["test"] = 0

    def rank(name: str) -> tuple[int, float]:
        return 0 if name in likely else 1 + order[kind_of(name, studies)], seconds[name]

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
    """Rows of all lists."""
    return [row for path in FAULTS.glob("*.toml") for row in fault_rows(path)]


def likely_catchers(file: str) -> set[str]:
    """Checks, and unit tests with TEST before, that catch a fault of this file."""
    rows = [row for row in faults_listed() if row["file"] == file]
    return set().union(*map(catchers_of, rows))


def catchers_of(fault: dict) -> set[str]:
    return {*fault.get("caught_by", []), *(TEST + one for one in fault.get("caught_by_tests", []))}


def does_not_hold(rows: list[dict]) -> list[str]:
    return [row["name"] for row in rows if row["outcome"] in ("fails", "inconclusive")]


def clock_of(batch: Batch) -> float:
    """Some times what the unedited program takes for it, of the processor's time [s]."""
    return 20 + 6 * batch.seconds
