"""Mutants: the program with one file edited. Shared by scripts/faults and scripts/mutate.

An edited copy lies in a folder of its own, which comes first on the include path; what is made of
the file is compiled anew and linked before the unedited libraries.
The source tree is never touched.
"""

import collections
import functools
import hashlib
import json
import math
import os
import re
import shlex
import subprocess
import threading
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any, NamedTuple

from clocked import run

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
PROGRAM = BUILD / "foldproof"
LISTED = BUILD / "faults/listed.json"  # what the program names
TESTS = BUILD / "tests"
SHORT_TESTS = "~[.]~[long]"  # those that ctest runs as `units`
# test class: its file; each takes --program FILE
PYTHON_TESTS = {
    "ProgramTest": ROOT / "scripts/tests/test_program.py",
    "SimulateTest": ROOT / "scripts/tests/test_simulate.py",
    "EvaluateTest": ROOT / "scripts/tests/test_evaluate.py",
    "ResumeTest": ROOT / "scripts/tests/test_resume.py",
    "CampaignTest": ROOT / "scripts/tests/test_campaign.py",
    "SlicesTest": ROOT / "scripts/tests/test_campaign.py",
    "Judge": ROOT / "scripts/tests/test_judge.py",
    "JudgeFrames": ROOT / "scripts/tests/test_judge_frames.py",
    "SolverTest": ROOT / "scripts/tests/test_converge_solver.py",
    "PrecisionSolverTest": ROOT / "scripts/tests/test_precision_solver.py",
    "IndependentTest": ROOT / "verification/independent/test_independent.py",
}
APART_FOLDER = BUILD / "faults" / "apart"
CLOCK = 240  # s: how long the processor may take for a mutant


class Unusable(Exception):
    """Why nothing can be said: of one mutant when it is judged, else of all."""


class DoesNotCompile(Unusable):
    """The edit is no C++."""


class Edit(NamedTuple):
    name: str  # of the mutant's folder
    file: str  # path from the repository's root
    text: str  # of the whole edited file


class Unit(NamedTuple):
    command: list[str]  # one compilation, as ninja runs it in build/
    object: str
    made_from: set[Path]


class Plan(NamedTuple):
    units: list[Unit]
    links: dict[str, list[str]]  # program: the command that links it, as ninja runs it in build/
    objects: dict[str, set[str]]  # of each program, with those of its libraries


def clean_commit(*records: Path) -> str:
    """The commit of the working tree; Unusable if a file but the records differs: what is recorded
    must be repeatable."""
    but = [f":!{record.relative_to(ROOT)}" for record in records]
    status = run(["git", "status", "--porcelain", "--untracked-files=no", "--", ".", *but], ROOT)
    if status.returncode or status.stdout:
        raise Unusable("what is recorded needs a working tree without changes: commit them first")
    return run(["git", "rev-parse", "HEAD"], ROOT).stdout.strip()


# ---- how the unedited program is made ------------------------------------------------------------


def read_plan(programs: list[str]) -> Plan:
    """Brings the unedited programs up to date; returns their compilations
    and links, as ninja tells them."""
    if not (BUILD / "build.ninja").is_file():
        raise Unusable("there is no build; run scripts/setup first")
    built = run(["ninja", *programs], BUILD)
    if built.returncode:
        raise Unusable(f"the unedited program does not build:\n{built.stdout}{built.stderr}")
    made_from = files_by_object()
    units, links, objects = {}, {}, {}
    for program in programs:
        lines = run(["ninja", "-t", "commands", program], BUILD).stdout.splitlines()
        # `: && c++ ... && :`
        links[program] = shlex.split(lines[-1].removeprefix(": && ").split(" && ")[0])
        for words in map(shlex.split, lines):
            if "-c" in words and "-o" in words and words[-1].endswith((".cpp", ".cxx")):
                name = words[words.index("-o") + 1]
                units[name] = Unit(words, name, made_from.get(name, set()))
                objects.setdefault(program, set()).add(name)
    return Plan(list(units.values()), links, objects)


def files_by_object() -> dict[str, set[Path]]:
    """The files that each object was made from: ninja prints `object:
    #deps ...`, then indented paths."""
    resolve = functools.cache(lambda path: (BUILD / path).resolve())
    found: dict[str, set[Path]] = {}
    for line in run(["ninja", "-t", "deps"], BUILD).stdout.splitlines():
        if line.startswith(" "):
            files.add(resolve(line.strip()))
        elif line:
            files = found.setdefault(line.rsplit(": #deps", 1)[0], set())
    return found


def sources_of(unit: Unit) -> list[Path]:
    """The unit's source; or the sources that CMake has compiled as one, which
    it lists in a file of its own."""
    source = Path(unit.command[-1])
    if source.suffix != ".cxx":
        return [source.resolve()]
    listed = re.findall(r'^#include "(.+)"$', source.read_text(encoding="utf-8"), re.M)
    return [Path(path).resolve() for path in listed]


def keys_of(plan: Plan) -> dict[str, str]:
    return {program: key_of(plan, program) for program in plan.objects}


def files_of_independent() -> list[Path]:
    """The independent program, its test and its cases."""
    files = PYTHON_TESTS["IndependentTest"].parent.rglob("*.*")
    return sorted(path for path in files if path.suffix in (".py", ".toml", ".obj"))


def key_of(plan: Plan, program: str | None = None) -> str:
    """A digest of the unedited programs, or of one of them, and of what their answers depend on:
    their code without the commit's name, the cases, the claims, and the scripts that test the
    program."""
    objects = [
        BUILD / unit.object
        for unit in plan.units
        if (program is None or unit.object in plan.objects[program])
        and not any(path.name == "build_facts.h" for path in unit.made_from)
    ]
    key = hashlib.sha256()
    read = sorted((ROOT / "cases").rglob("*.*")) + sorted(
        (ROOT / "verification/claims").glob("*.toml")
    )
    read += [file for file in PYTHON_TESTS.values() if file.parent.name == "tests"]
    read += [ROOT / f"scripts/tests/{name}_case.py" for name in ("program", "judge")]
    read += files_of_independent()
    for path in objects + read:
        key.update(path.read_bytes())
    return key.hexdigest()


# ---- making a mutant -----------------------------------------------------------------------------


def compile_mutant(plan: Plan, edit: Edit, overlay: Path) -> dict[str, list[Path]]:
    """Compiles what is made of the edited file, into the empty folder `overlay`; the objects that
    take the place of each of the program's own. Throws DoesNotCompile."""
    original = (ROOT / edit.file).resolve()
    copy = overlay / edit.file
    copy.parent.mkdir(parents=True)
    copy.write_text(edit.text, encoding="utf-8")
    objects = {}
    for number, unit in enumerate(units_made_from(plan, edit.file)):
        together = sources_of(unit)
        objects[unit.object] = [overlay / f"{number}.o"]
        source = copy if original in together else Path(unit.command[-1])
        compile_unit(plan, unit, source, objects[unit.object][0], overlay)
        if original in together:  # the others that are compiled as one with it, as they are
            objects[unit.object] += [
                compile_apart(plan, unit, other) for other in together if other != original
            ]
    return objects


def units_made_from(plan: Plan, file: str) -> list[Unit]:
    original = (ROOT / file).resolve()
    touched = [unit for unit in plan.units if original in unit.made_from]
    if not touched:
        raise Unusable(f"nothing in the program is made from {file}")
    return touched


def compile_unedited(plan: Plan, file: str) -> dict[str, list[Path]]:
    """The objects that a mutant of this file replaces, made of the unedited file with a mutant's
    flags. They are compiled once after each change."""
    original, objects = (ROOT / file).resolve(), {}
    for unit in units_made_from(plan, file):
        together = sources_of(unit)
        apart = [original, *(other for other in together if other != original)]
        sources = apart if original in together else [Path(unit.command[-1])]
        objects[unit.object] = [compile_apart(plan, unit, source) for source in sources]
    return objects


def write_at_once(path: Path, text: str) -> None:
    """Another program that reads the file now finds the old text, or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(f".{os.getpid()}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


APART = collections.defaultdict(threading.Lock)


def compile_apart(plan: Plan, unit: Unit, source: Path) -> Path:
    """The object of an unedited source by itself, made once after each
    change of what it is compiled with."""
    target = APART_FOLDER / source.relative_to(ROOT).with_suffix(".o")
    with APART[target]:
        if not target.exists() or target.stat().st_mtime < (BUILD / unit.object).stat().st_mtime:
            target.parent.mkdir(parents=True, exist_ok=True)
            part = target.with_suffix(f".{os.getpid()}.part")  # other programs may make it, too
            compile_unit(plan, unit, source, part, target.parent)
            part.replace(target)
    return target


def compile_unit(plan: Plan, unit: Unit, source: Path, target: Path, overlay: Path) -> None:
    """Compiles as the program's own build does, but with the overlay first on the include path, and
    the method for a short compilation where the build has it for speed: the bits are the same."""
    words = quick_compile_command(plan, unit.command)
    # ninja's own record of what was read stays as it is
    words[words.index("-MF") + 1] = f"{target}.d"
    words[words.index("-o") + 1] = str(target)
    words[-1] = str(source)
    first_option = next(place for place, word in enumerate(words) if word.startswith("-"))
    # an edit may leave a variable unused
    words[first_option:first_option] = ["-I", str(overlay), "-w"]
    make(words, "does not compile", DoesNotCompile)


def quick_compile_command(plan: Plan, command: list[str]) -> list[str]:
    """The command with -O1 in place of -O3, and with the precompiled
    header that was made with -O1."""
    words = list(command)
    if "-O3" not in words or "-O1" in words:
        return words
    header = next(
        (
            unit.command
            for unit in plan.units
            if "-O1" in unit.command and "-include" in unit.command
        ),
        None,
    )
    if header and "-include" in words:
        words[words.index("-include") + 1] = header[header.index("-include") + 1]
    words.insert(words.index("-c"), "-O1")  # the last one counts
    return words


def link_mutant(plan: Plan, objects: dict[str, list[Path]], program: str, overlay: Path) -> Path:
    """Puts the mutant's objects in place of the program's own, or before
    the libraries with the originals.

    The linker takes a member of a library only for a symbol still undefined, so the original stays
    out; if it came in all the same, its symbols would be defined twice, which is a link error.
    """
    link = plan.links[program]
    words = [str(path) for word in link for path in objects.get(word, [word])]
    libraries = next((place for place, word in enumerate(words) if word.endswith(".a")), len(words))
    in_library = [
        str(path)
        for name, paths in objects.items()
        if name not in link and is_of(link, name)
        for path in paths
    ]
    words[libraries:libraries] = in_library
    words[words.index("-o") + 1] = str(overlay / program)
    make([*words[:1], *LINKER, *words[1:]], "does not link", Unusable)
    return overlay / program


LINKER = ["-fuse-ld=gold"]


def is_of(link: list[str], name: str) -> bool:
    """Whether an object belongs to one of the libraries of a link, as CMake names them:
    `verification/ CMakeFiles/oracles.dir/...` is of `verification/liboracles.a`."""
    folder, _, rest = name.partition("/CMakeFiles/")
    return f"{folder}/lib{rest.partition('.dir/')[0]}.a" in link


def make(words: list[str], failure: str, error: type[Unusable]) -> None:
    made = run(words, BUILD)
    if made.returncode:
        lines = made.stderr.strip().splitlines() or ["no message"]
        telling = (line for line in lines if re.search("error|multiple definition|undefined", line))
        raise error(f"{failure}: {next(telling, lines[-1])}")


# ---- asking a mutant -----------------------------------------------------------------------------


def ask(program: Path, arguments: list[str], key: str, clock: float | None = None) -> list[dict]:
    """One list of the program's JSON answer; raises TimeoutExpired when the clock runs out,
    ChildProcessError when it died of a signal."""
    ran = run([program, *arguments, "--json"], ROOT, clock)
    if ran.returncode < 0:
        raise ChildProcessError(f"died of signal {-ran.returncode}")
    try:
        return json.loads(ran.stdout)[key]
    except (ValueError, KeyError, TypeError) as error:
        said = (ran.stderr or ran.stdout).strip()[-400:]
        raise Unusable(
            f"`foldproof {arguments[0]}`: exit code {ran.returncode}, no {key}: {said}"
        ) from error


@functools.cache
def listed() -> dict[str, Any]:
    """All that `foldproof list --json` says. It reads every case, so the answer is kept for as long
    as the program and the cases are the same."""
    digest = hashlib.sha256(PROGRAM.read_bytes())
    for case in sorted((ROOT / "cases").rglob("*.toml")):
        digest.update(case.read_bytes())
    key = digest.hexdigest()
    kept = json.loads(LISTED.read_text(encoding="utf-8")) if LISTED.is_file() else {}
    if kept.get("key") != key:
        said = run([PROGRAM, "list", "--json"], ROOT, None).stdout
        kept = {"key": key, "listed": json.loads(said)}
        write_at_once(LISTED, json.dumps(kept))
    return kept["listed"]


def findings(
    program: Path, names: list[str], clock: float | None = None, tier: str = "quick"
) -> list[dict]:
    """Findings of the checks, studies and cases with these names (all checks, if there are none):
    rows with name, outcome, measured, bound, margin, seconds."""
    rows = [
        row
        for row in ask(program, ["check", *names, "--tier", tier], "findings", clock)
        if row["kind"] != "claim"
    ]
    keys = ("name", "outcome", "measured", "bound", "seconds")
    return [{key: row[key] for key in keys} | {"margin": margin_of(row)} for row in rows]


def margin_of(row: dict) -> float | None:
    """measured/bound; None where that says nothing."""
    if row["measured"] is None or not row["bound"]:
        return None
    margin = row["measured"] / row["bound"]
    return margin if math.isfinite(margin) else None


def unit_tests(program: Path, names: list[str], clock: float | None) -> list[dict]:
    """The outcomes of Catch2 test cases (all short ones, if there are none); those that a crash or
    an unknown name kept from running are left out."""
    escaped = ",".join(re.sub(r'([\\,\[\]"])', r"\\\1", name) for name in names)
    ran = run([program, escaped or SHORT_TESTS, "-r", "xml", "-d", "yes"], ROOT, clock)
    if ran.returncode < 0:
        raise ChildProcessError(f"died of signal {-ran.returncode}")
    try:
        cases = list(ElementTree.fromstring(ran.stdout).iter("TestCase"))
    except ElementTree.ParseError as error:
        raise Unusable(f"tests: exit code {ran.returncode}: {error}") from error
    rows = []
    for case in cases:
        result = case.find("OverallResult")
        rows.append(outcome_of_test(case.get("name"), result.get("success") == "true"))
        rows[-1]["seconds"] = float(result.get("durationInSeconds"))
    return rows


def outcome_of_test(name: str, passed: bool) -> dict:
    return {
        "name": name, "outcome": "holds" if passed else "fails", "measured": None, "bound": None,
        "margin": None
    }
