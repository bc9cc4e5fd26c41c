"""Records of the shipped cases, one line a case: which program was asked,
and of which form of the case."""

import json
import subprocess
import sys
from datetime import datetime
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "reports"))
from data.case_digest import case_digest, case_files  # noqa: E402
from data.unreadable import Unreadable, reading  # noqa: E402
from data.whole_file import write_whole  # noqa: E402


class Rejected(Unreadable):
    """Why a file is not recorded."""


def recorded_rows(record: Path) -> dict[str, dict[str, Any]]:
    """The rows of a record, by case name; none if there is no such file."""
    if not record.is_file():
        return {}
    with reading(record):
        return {row["case"]: row for row in json.loads(record.read_text())["cases"]}


def latest(rows: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Of each case the row that was found last."""
    by_date = sorted(rows, key=lambda row: datetime.fromisoformat(row["program"]["date"]))
    return {row["case"]: row for row in by_date}


def same_scene(file: Path, row: dict[str, Any], but: str = "") -> None:
    """Throws Rejected for an answer about a changed scene; keys that begin with `but` are none."""
    if any(not but or not typed.startswith(but) for typed in row["overrides"]):
        raise Rejected(f"{file}: of {row['case']}, with --set {' '.join(row['overrides'])}, which"
                       " is another scene than the shipped one")


def origin(file: Path, case: str, program: dict[str, Any]) -> dict[str, Any]:
    """What a row says of its origin: the program, and the digest of the case as it was at the
    program's commit. Throws Rejected for a program with uncommitted changes, and for a case that is
    not shipped."""
    if program["tree"] != "clean":
        raise Rejected(f"{file}: found by a program with changes that were not committed")
    files = case_files(ROOT / "cases")
    if case not in files:
        raise Rejected(f"{case} is not a shipped case")
    kept = {key: program[key] for key in ("version", "commit", "date", "cpu")}
    digest = case_digest(files[case], lambda name: file_at(program["commit"], name))
    return {"program": kept, "digest": digest}


def file_at(commit: str, name: str) -> bytes:
    """A file of the folder cases/ as it was at the commit."""
    shown = subprocess.run(
        ["git", "-C", str(ROOT), "show", f"{commit}:cases/{name}"], capture_output=True, check=False
    )
    if shown.returncode:
        raise Rejected(f"commit {commit[:10]} has no cases/{name}")
    return shown.stdout


def command(name: str, usage: str, record: Path, rows_after: Any) -> int:
    """The command line of a script that records: rows_after(rows, files) gives all rows, old and
    new, by case."""
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(usage.strip())
        return 0 if len(sys.argv) > 1 else 2
    try:
        before = recorded_rows(record)
        rows = rows_after(before, [Path(file) for file in sys.argv[1:]])
        lines = ",\n".join(json.dumps(rows[case], sort_keys=True) for case in sorted(rows))
        write_whole(record, f'{{"schema": 1, "cases": [\n{lines}\n]}}\n'.encode())
    except (OSError, Unreadable) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    new = sum(before.get(case) != row for case, row in rows.items())
    print(f"{new} of {len(rows)} cases are new in {record.relative_to(ROOT)}")
    return 0
