"""A digest of a seeded fault: what it edits, and who must notice."""
from __future__ import annotations

import hashlib
import json


def edit_digest(fault) -> str:
    """8 hexadecimal digits of a fault's edit and of those that must notice."""
    said = json.dumps([fault.file, fault.find.strip(), fault.replace.strip(),
                       sorted(fault.caught_by), sorted(fault.caught_by_tests)])
    return hashlib.sha256(said.encode("utf-8")).hexdigest()[:8]
