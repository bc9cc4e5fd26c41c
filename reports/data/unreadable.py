"""The error for a file that cannot be read."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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
