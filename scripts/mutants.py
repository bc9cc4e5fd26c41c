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
import threading
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import NamedTuple

from builds import ROOT, Unusable
from clocked import run

BUILD = ROOT / "build"
TESTS = BUILD / "tests"
SHORT_TESTS = "~[.]~[long]"  # those that ctest runs as `units`
# test class: its file; each takes --program FILE
PYTHON_TESTS = {
    name: ROOT / "scripts/tests" / f"{file}.py" for name, file in {
        "ProgramTest": "test_program", "SimulateTest": "test_simulate",
        "EvaluateTest": "test_evaluate", "ResumeTest": "test_resume",
        "CampaignTest": "test_campaign", "SlicesTest": "test_campaign", "Judge": "test_judge",
        "JudgeFrames": "test_judge_frames", "SolverTest": "test_converge_solver",
        "PrecisionSolverTest": "test_precision_solver", "Compare": "test_compare",
        "DamagedMeshes": "test_damaged_meshes"
    }.items()
} | {"IndependentTest": ROOT / "verification/independent/test_independent.py"}
SHARED_BY_TESTS = ("program_case", "judge_case", "campaign_case")
APART_FOLDER = BUILD / "faults" / "apart"
CLOCK = 240  # s: how long the processor may take for a mutant


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
    files: set[Path] = set()
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


def key_of(plan: Plan, program: str | None = None) -> str:
    """A digest of the unedited programs, or of one of them, and of what their answers depend on:
    their code without the commit's name, the cases, the claims, the scripts that test the program,
    and the independent program with its cases."""
    read = [BUILD / unit.object for unit in plan.units
            if (program is None or unit.object in plan.objects[program])
            and not any(path.name == "build_facts.h" for path in unit.made_from)]
    read += sorted((ROOT / "cases").rglob("*.*"))
    read += sorted((ROOT / "verification/claims").glob("*.toml"))
    read += [file for file in PYTHON_TESTS.values() if file.parent.name == "tests"]
    read += [ROOT / f"scripts/tests/{name}.py" for name in SHARED_BY_TESTS]
    independent = PYTHON_TESTS["IndependentTest"].parent.rglob("*.*")
    read += sorted(path for path in independent if path.suffix in (".py", ".toml", ".obj"))
    key = hashlib.sha256()
    for path in read:
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
    for number, (unit, source, others) in enumerate(units_made_from(plan, edit.file)):
        target = overlay / f"{number}.o"
        compile_unit(plan, unit, copy if source == original else source, target, overlay)
        objects[unit.object] = [target, *(compile_apart(plan, unit, other) for other in others)]
    return objects


def compile_unedited(plan: Plan, file: str) -> dict[str, list[Path]]:
    """The objects that a mutant of this file replaces, made of the unedited file with a mutant's
    flags. They are compiled once after each change."""
    return {unit.object: [compile_apart(plan, unit, one) for one in (source, *others)]
            for unit, source, others in units_made_from(plan, file)}


def units_made_from(plan: Plan, file: str) -> list[tuple[Unit, Path, list[Path]]]:
    """Each unit that reads the file, the source of it that is compiled anew, and the others that
    are compiled as one with the file itself."""
    original, touched = (ROOT / file).resolve(), []
    for unit in plan.units:
        if original not in unit.made_from:
            continue
        together = sources_of(unit)
        if original in together:
            touched.append((unit, original, [one for one in together if one != original]))
        else:
            touched.append((unit, Path(unit.command[-1]), []))
    if not touched:
        raise Unusable(f"nothing in the program is made from {file}")
    return touched


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
    """The command with -O1 in place of -O3, and with the precompiled header that was made with
    -O1."""
    words = list(command)
    if "-O3" not in words or "-O1" in words:
        return words
    header = next((unit.command for unit in plan.units
                   if "-O1" in unit.command and "-include" in unit.command), None)
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
    words[libraries:libraries] = [
        str(path) for name, paths in objects.items() if name not in link and is_of(link, name)
        for path in paths
    ]
    words[words.index("-o") + 1] = str(overlay / program)
    make([words[0], "-fuse-ld=gold", *words[1:]], "does not link", Unusable)
    return overlay / program


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


def findings(program: Path, names: list[str], clock: float | None = None,
             tier: str = "quick") -> list[dict]:
    """Findings of the checks, studies and cases with these names (all checks, if there are none):
    rows with name, outcome, measured, bound, margin, seconds."""
    rows = ask(program, ["check", *names, "--tier", tier], "findings", clock)
    keys = ("name", "outcome", "measured", "bound", "seconds")
    return [{key: row[key] for key in keys} | {"margin": margin_of(row)}
            for row in rows if row["kind"] != "claim"]


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
    outcome = "holds" if passed else "fails"
    return {"name": name, "outcome": outcome, "measured": None, "bound": None, "margin": None}
