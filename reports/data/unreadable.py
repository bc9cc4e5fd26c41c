"""The error for a file that cannot be read, and files of JSON."""
from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")


class Unreadable(Exception):
    """A file that is not there, not what it is taken for, or damaged."""


def one_line(error: BaseException) -> str:
    """An error in one line, with its kind where it says little itself."""
    return " ".join(f"{type(error).__name__}: {error}".split())


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Whatever goes wrong inside is told as that the file cannot be read: a
    damaged one may hold anything."""
    try:
        yield
    except Unreadable:
        raise
    except FileNotFoundError as error:
        raise Unreadable(f"{path}: there is no such file") from error
    except Exception as error:
        raise Unreadable(f"{path}: {one_line(error)}") from error


def read_json(path: Path, make: Callable[[Any], T]) -> T | None:
    """The content of a file of JSON, as `make` takes it; None if there is no such file. Throws
    Unreadable, which names the file, also for what `make` cannot take."""
    if not path.is_file():
        return None
    with reading(path):
        return make(json.loads(path.read_text(encoding="utf-8")))
