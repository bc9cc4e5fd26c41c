"""Which checks, studies, cases and unit tests reach a function. Of scripts/mutate.

build-reach/ holds the programs built once more, with a hook at the entry of each function of ours
(scripts/reach_hook.cpp). Each name runs there in a process of its own, once for each build of its
program. The hook also sees what is inlined, which counters of executed code do not.

A name that does not reach an edited function cannot notice the edit, with these exceptions:
- it reaches the function only at times (clocks, threads, memory that was never set);
- the edit changes what the compiler makes of other code: a type that it deduces, or a call that it
  may evaluate itself. Functions declared `constexpr` and code outside of functions therefore have
  no entry: of a header, everything is asked; of a .cpp, what reaches any function of the file.
  Names that do not hold in build-reach/ are always asked;
- the process does not inherit the environment, or is another program than the two.
The table is held against the seeded faults: who notices one must reach its place.
"""

import bisect
import concurrent.futures
import fcntl
import functools
import itertools
import json
import os
import subprocess
import tempfile
from collections.abc import Iterator, Set
from pathlib import Path
from typing import NamedTuple

from builds import ROOT, Unusable, build, output_of, write_at_once
from cpp_pieces import CODE, pieces_of
from mutant_questions import (
    FOLDER, TEST, Batch, catchers_of, clock_of, does_not_hold, faults_listed
)
from mutants import Plan, findings, keys_of, unit_tests
from occurrences import occurrences

BUILD = ROOT / "build-reach"
PROGRAMS = ("foldproof", "tests")
VARIABLE = "REACH_RECORD"  # as in scripts/reach_hook.cpp

# ---- functions of a text -------------------------------------------------------------------------

SCOPES = {"namespace", "struct", "class", "union", "extern", "enum"}
BY_COMPILER = {"constexpr", "consteval"}


@functools.cache
def functions_of(text: str) -> list[range]:
    """The lines of each function with a body, of classes too; a lambda's are its function's."""
    starts = [0, *(place + 1 for place, sign in enumerate(text) if sign == "\n")]
    return [range(bisect.bisect(starts, first), bisect.bisect(starts, last) + 1)
            for first, last in bodies_of(text)]


def bodies_of(text: str) -> Iterator[tuple[int, int]]:
    """Where each function begins and ends, as layout and tokens tell."""
    tokens = [piece for piece in pieces_of(text) if piece.kind in CODE]
    depth, start, words = 0, 0, []  # words: of what begins at `start`, outside of brackets
    for k, token in enumerate(tokens):
        following = tokens[k + 1].text if k + 1 < len(tokens) else ""
        if not words:
            start = token.at
        if depth == 0:
            words.append(token.text)
        if token.text in ("(", "[", "{"):
            if token.text == "{" and depth == 0 and opens_scope(words):
                words = []
            else:
                depth += 1
        elif token.text in (")", "]"):
            depth -= 1
        elif token.text == "}":
            closes_scope = depth == 0
            depth = max(depth - 1, 0)
            if closes_scope:
                words = []
            elif depth == 0 and following not in (";", ",", "{", "(", ")", "."):
                if is_function(words):
                    yield start, token.at
                words = []
        elif token.text == ";" and depth == 0:
            words = []


def opens_scope(words: list[str]) -> bool:
    return not SCOPES.isdisjoint(words) and "(" not in words


def is_function(words: list[str]) -> bool:
    is_value = any(word == "=" and before != "operator"
                   for before, word in zip(["", *words], words))
    return "(" in words and not is_value and BY_COMPILER.isdisjoint(words)


# ---- the table -----------------------------------------------------------------------------------


class Table(NamedTuple):
    names: list[str]
    unknown: set[str]  # of them: those that do not hold in build-reach/
    reached: dict[str, dict[int, int]]  # file: line of a function's head: one bit for each name

    def names_for(self, file: str, text: str, line: int) -> set[str] | None:
        """Those known to reach the function of this line; None where nothing is known of it."""
        lines = next((lines for lines in functions_of(text) if line in lines), range(0))
        heads = self.reached.get(file, {})
        masks = [mask for head, mask in heads.items() if head in lines]
        if not masks and file.endswith(".cpp"):  # a constant: only this file's functions read it
            masks = list(heads.values())
        if not masks:
            return None
        mask = functools.reduce(int.__or__, masks)
        return {name for k, name in enumerate(self.names) if mask >> k & 1}


def to_json(table: Table, keys: dict[str, str]) -> str:
    masks = {file: {str(line): f"{mask:x}" for line, mask in lines.items()}
             for file, lines in table.reached.items()}
    return json.dumps({"keys": keys, "names": table.names, "unknown": sorted(table.unknown),
                       "reached": masks})


def from_json(text: str, keys: dict[str, str]) -> Table:
    """Without the names that a program of another build was asked."""
    kept = json.loads(text)
    reached = {file: {int(line): int(mask, 16) for line, mask in lines.items()}
               for file, lines in kept["reached"].items()}
    table = Table(kept["names"], set(kept["unknown"]), reached)
    same = {program for program, key in keys.items() if kept.get("keys", {}).get(program) == key}
    return table if same == set(keys) else only(table, same)


def only(table: Table, programs: Set[str]) -> Table:
    """The names that these programs answer; functions that none of them reaches are forgotten."""
    places = [k for k, name in enumerate(table.names) if program_of(name) in programs]
    names = [table.names[k] for k in places]
    reached: dict[str, dict[int, int]] = {}
    for file, lines in table.reached.items():
        for line, mask in lines.items():
            if bits := sum(1 << new for new, old in enumerate(places) if mask >> old & 1):
                reached.setdefault(file, {})[line] = bits
    return Table(names, table.unknown & set(names), reached)


def program_of(name: str) -> str:
    return "tests" if name.startswith(TEST) else "foldproof"


def read_table(plan: Plan, seconds: dict[str, float], jobs: int) -> Table:
    """Measures those of the names that are not yet in the file."""
    stored, keys = FOLDER / "reach.json", keys_of(plan)
    FOLDER.mkdir(parents=True, exist_ok=True)
    with open(FOLDER / "reach.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # samples with other seeds may run at the same time
        table = Table([], set(), {})
        if stored.is_file():
            table = from_json(stored.read_text(encoding="utf-8"), keys)
        missing = {name: each for name, each in seconds.items() if name not in set(table.names)}
        if missing:
            print(f"reach: {len(missing)} names, once for this build", flush=True)
            build(BUILD, list(PROGRAMS), "-DREACH=ON", jobs=jobs)
            table = with_names(table, missing, jobs)
            if missed := missed_catchers(table, faults_listed()):
                raise Unusable(f"these notice faults in functions that they do not seem to reach:"
                               f" {', '.join(missed)}; --all asks everything")
            write_at_once(stored, to_json(table, keys))
    return table


def missed_catchers(table: Table, faults: list[dict]) -> list[str]:
    """Names that notice a seeded fault, though the table says that they do not reach its place."""
    missed = set()
    for fault in faults:
        path = ROOT / fault["file"]
        if path.suffix not in (".cpp", ".h") or "equivalent" in fault:
            continue
        text = path.read_text(encoding="utf-8")
        for place in occurrences(text, fault["find"]):
            found = table.names_for(fault["file"], text, text.count("\n", 0, place.start) + 1)
            if found is None:
                continue
            missed |= (catchers_of(fault) & set(table.names)) - found - table.unknown
    return sorted(missed)


# ---- measuring -----------------------------------------------------------------------------------


class Function(NamedTuple):
    place: int  # of its entry, from the program's start
    file: str
    line: int


def functions_in(program: Path) -> list[Function]:
    """Our functions in the program. What initializes constants is none: it has no line."""
    rows = [line.split() for line in output_of(["nm", program]).splitlines()]
    rows = [row for row in rows if len(row) == 3 and "initialization_and_" not in row[2]]
    start = next(int(row[0], 16) for row in rows if row[2] == "__executable_start")
    places = sorted({int(row[0], 16) for row in rows if row[1] in "tTwW"})
    lines = lines_of(program, places)
    ours = f"{ROOT}/"
    return [
        Function(place - start, file.removeprefix(ours), line)
        for place, (file, line) in zip(places, lines) if file.startswith(ours)
    ]


def lines_of(program: Path, places: list[int]) -> list[tuple[str, int]]:
    asked = "".join(f"{place:x}\n" for place in places)
    told = subprocess.run(["addr2line", "-e", program], input=asked, capture_output=True, text=True,
                          check=True).stdout
    found = []
    for text in told.splitlines():  # `/path/file.cpp:12 (discriminator 3)`
        file, _, line = text.partition(" ")[0].rpartition(":")
        found.append((file, int(line) if line.isdigit() else 0))
    return found


def with_names(table: Table, seconds: dict[str, float], jobs: int) -> Table:
    """The table with these names, too."""
    functions = {program: functions_in(BUILD / program) for program in PROGRAMS}
    names, unknown, reached = [*table.names], {*table.unknown}, table.reached
    for one in itertools.chain(*functions.values()):
        reached.setdefault(one.file, {}).setdefault(one.line, 0)
    with (tempfile.TemporaryDirectory(dir=FOLDER) as folder,
          concurrent.futures.ProcessPoolExecutor(jobs) as pool):
        places = {program: [one.place for one in each] for program, each in functions.items()}
        measure = functools.partial(places_reached, Path(folder), places)
        for name, run_places in zip(seconds, pool.map(measure, seconds.items())):
            bit = 1 << len(names)
            names.append(name)
            if run_places is None:
                unknown.add(name)
                continue
            for program, each in functions.items():
                for one in each:
                    if one.place in run_places[program]:
                        reached[one.file][one.line] |= bit
    return Table(names, unknown, reached)


def places_reached(folder: Path, places: dict[str, list[int]],
                   asked: tuple[str, float]) -> dict[str, set[int]] | None:
    """By program, those of the places that a name runs; None if it does not hold here."""
    name, seconds = asked
    record = folder / str(os.getpid())
    os.environ[VARIABLE] = str(record)  # of this process of the pool, which runs one name at a time
    files = {program: record.with_name(f"{record.name}.{program}") for program in PROGRAMS}
    for program, file in files.items():
        file.unlink(missing_ok=True)
        file.touch()
        os.truncate(file, (BUILD / program).stat().st_size // 4)  # more than enough
    if not holds(name, clock_of(Batch([name], seconds))):
        return None
    bits = {program: file.read_bytes() for program, file in files.items()}
    return {program: {place for place in places[program]
                      if bits[program][place // 8] >> place % 8 & 1} for program in files}


def holds(name: str, clock: float) -> bool:
    try:
        if name.startswith(TEST):
            rows = unit_tests(BUILD / "tests", [name.removeprefix(TEST)], clock)
        else:
            rows = findings(BUILD / "foldproof", [name], clock)
    except (Unusable, ChildProcessError, subprocess.TimeoutExpired):
        return False
    return bool(rows) and not does_not_hold(rows)
