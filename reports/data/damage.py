"""Damaged HDF5 files: the library may crash or run without end on them, so they are tried in a
process of their own."""
from __future__ import annotations

import os
import resource
import signal
from pathlib import Path

import h5py

SECONDS, BYTES_PER_SECOND = 20, 10_000_000   # of processor time that reading may take
MEMORY = 1 << 30                             # bytes beyond what is in use and twice the file


def why_unreadable(path: Path) -> str:
    """"" if all of the file can be read, else why not, in words. Throws
    OSError for a file that is not there."""
    size = path.stat().st_size
    if not path.is_file():
        return "it is no regular file"
    child = os.fork()
    if child == 0:
        _read_and_leave(path, size)
    end = os.waitpid(child, 0)[1]
    if os.WIFEXITED(end):
        return "" if os.WEXITSTATUS(end) == 0 else "it is damaged, or no HDF5 file"
    return f"it is damaged: reading it ended with {signal.Signals(os.WTERMSIG(end)).name}"


def _read_and_leave(path: Path, size: int) -> None:
    code = 1
    try:
        used = (
            int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
            * resource.getpagesize()
        )
        for what, most in (
            (resource.RLIMIT_CORE, 0), (resource.RLIMIT_CPU, SECONDS + size // BYTES_PER_SECOND),
            (resource.RLIMIT_AS, used + MEMORY + 2 * size)
        ):
            hard = resource.getrlimit(what)[1]
            resource.setrlimit(
                what, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard)
            )
        with h5py.File(path, "r") as file:
            file.visititems(_read)
            list(file.attrs.items())
        code = 0
    finally:
        os._exit(code)


def _read(_: str, item: h5py.Group | h5py.Dataset) -> None:
    list(item.attrs.items())
    if isinstance(item, h5py.Dataset):
        if item.compression is None and item.nbytes > item.file.id.get_filesize():
            raise ValueError("a dataset claims more than the file holds")
        for row in range(len(item)) if item.ndim > 1 else [()]:
            item[row]
