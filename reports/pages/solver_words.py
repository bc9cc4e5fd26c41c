"""What the report of one judged solver says of it, instead of what it says of a verification run.
Counts and looks up; decides nothing."""
from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterable

from data.results import Finding
from data.trials import Trial
from pages.sentences import Piece, Quoted, count_of, in_words

DECLINED = "the subject does not offer "  # begins the note of a law that does not apply
APART = ("not applicable", "did not run")  # outcomes of what was not judged
MOST_NAMED = 3  # laws that are named


def is_of_frames(trial: Trial) -> bool:
    """Whether frames were judged, which no solver was asked for."""
    return trial.facts["precision"] == "files"


def title_of(trial: Trial) -> str:
    """The heading of its report."""
    name = f"{trial.subject} {trial.facts['version']}".rstrip()
    return f"{name} on trial" if trial.facts["scheme"] else f"{name} did not start"


def standfirst_of(trial: Trial, count: int) -> str:
    """What was asked, below the heading."""
    if is_of_frames(trial):
        return f"{count} findings on another program's frames, taken as a run of this case."
    return (
        f"{count} laws of cloth. Bounds follow from the law and from what the solver declares: its"
        " precision, its order, its tolerance. There is no total score: the laws are not equally"
        " important."
    )


def facts_of(trial: Trial) -> list[tuple[str, str]]:
    """Labels and words of what was judged, and by what."""
    facts, program = trial.facts, trial.program
    name = f"{trial.subject} {facts['version']}".rstrip()
    judged_by = f"foldproof {program['version']}, its commit {program['commit'][:10]}"
    about = [
        ("judged by", f"{judged_by} {program['tree']}".rstrip()),
        ("on", program["date"]),
        ("machine", program["cpu"]),
    ]
    if is_of_frames(trial):
        return [("frames", name), *about]
    if not facts["scheme"]:
        return [("solver", name), *about]
    order = f"order {facts['order']} claimed" if facts["order"] else "no order claimed"
    tolerance = facts["solve_tolerance"]
    return [
        ("solver", name),
        ("scheme", f"{facts['scheme']}, {order}"),
        ("precision", facts["precision"]),
        ("level", facts["level"]),
        ("linear systems", f"to a residual of {tolerance:g}" if tolerance else "none, or exact"),
        *about,
    ]


def details_of(trial: Trial) -> list[tuple[str, str]]:
    """Labels and words of its mapping and settings, which may be long."""
    facts = trial.facts
    said = [(f"mapping of {key}", str(words)) for key, words in facts["mapping"].items()]
    if is_of_frames(trial):
        return [(label.removeprefix("mapping of "), words) for label, words in said]
    settings = [f"{key}={value}" for key, value in facts["settings"].items()]
    return [
        ("adapter", facts["command"]),
        ("settings", ", ".join(settings) or "none"),
        ("capabilities", ", ".join(facts["capabilities"]) or "none"),
        *said,
    ]


def verdict_on(trial: Trial, findings: list[Finding], quoted: dict[str, Quoted]) -> list[Piece]:
    """How many laws were judged and hold; what was not judged is counted apart."""
    judged = [one for one in findings if one.outcome not in APART]
    counted = Counter(one.outcome for one in findings)
    laws = "findings" if is_of_frames(trial) else "laws"
    said: list[Piece] = [count_of(counted["holds"], f"{laws} that hold"), " of ",
                         count_of(len(judged), f"{laws} that were judged"), f" judged {laws} hold"]
    for outcome, one, many in (("fails", "fails", "fail"),
                               ("inconclusive", "is inconclusive", "are inconclusive")):
        if counted[outcome]:
            said += [", ", *_told(counted[outcome], laws, one, many)]
    for outcome, one, many in (("not applicable", "does not apply", "do not apply"),
                               ("did not run", "did not run", "did not run")):
        if counted[outcome]:
            said += ["; ", *_told(counted[outcome], laws, one, many)]
    broken = [quoted[one.name] for one in judged if one.outcome != "holds"][:MOST_NAMED]
    return [*said, ". Look first at ", *in_words([[one] for one in broken]), "."] if broken else [
        *said, "."
    ]


def declined_by(findings: Iterable[Finding], quoted: dict[str, Quoted]) -> list[list[Piece]]:
    """What was not judged, reason by reason."""
    groups: dict[tuple[str, str], list[Quoted]] = {}
    for one in findings:
        if one.outcome in APART:
            groups.setdefault((one.outcome, one.note), []).append(quoted[one.name])
    return [[*_why(outcome, note), *_names(names), "."]
            for (outcome, note), names in groups.items()]


def _why(outcome: str, note: str) -> list[Piece]:
    if note.startswith(DECLINED):
        return ["does not offer ", Quoted(note.removeprefix(DECLINED), "note"), ": "]
    return [Quoted(note or outcome, "note"), ": "]


def _names(names: list[Quoted]) -> list[Piece]:
    shown = in_words([[name] for name in names[:MOST_NAMED]], last=", ")
    rest = len(names) - MOST_NAMED
    return [*shown, " and ", count_of(rest, "further laws"), " more"] if rest > 0 else shown


def repeats(trial: Trial, program: str, law: str) -> str:
    """The command that judges one law again."""
    if is_of_frames(trial):
        return trial.program["command"]
    settings = [f"--settings {shlex.quote(f'{key}={value}')}"
                for key, value in trial.facts["settings"].items()]
    options = [shlex.quote(word) for word in trial.facts["options"]]
    words = [program, "judge", "--solver", shlex.quote(trial.facts["command"]), *settings,
             *options, shlex.quote(law)]
    return " ".join(words)


def _told(count: int, laws: str, one: str, many: str) -> list[Piece]:
    return [count_of(count, f"{laws}, counted"), f" {one if count == 1 else many}"]
