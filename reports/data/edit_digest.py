"""A digest of a seeded fault: what it edits, and who must notice."""
from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable


def edit_digest(
    file: str, find: str, put: str, caught_by: Iterable[str], tests: Iterable[str]
) -> str:
    """16 hexadecimal digits of a fault's edit and of those that must notice."""
    said = json.dumps([file, find.strip(), put.strip(), sorted(caught_by), sorted(tests)])
    return hashlib.sha256(said.encode("utf-8")).hexdigest()[:16]
