"""Command line of the scripts in this folder: required packages, errors in one line with exit code
2, and an end without a traceback when interrupted."""
from __future__ import annotations

import argparse
import importlib.util
import shutil
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

from data.unreadable import Unreadable, one_line

# Ctrl-C ends a script, and the processes that it starts, as it ends other programs. What they write
# appears whole or not at all (whole_file.py).
signal.signal(signal.SIGINT, signal.SIG_DFL)

# Debian's package of each module that is imported, and of each program that is started.
MODULES = {
    "h5py": "python3-h5py", "numpy": "python3-numpy", "matplotlib": "python3-matplotlib",
    "jinja2": "python3-jinja2", "PIL": "python3-pil"
}


class OneLineParser(argparse.ArgumentParser):
    """A parser whose errors fit a line."""

    def error(self, message: str) -> NoReturn:
        refuse(self.prog.removesuffix(".py"), message.removeprefix("argument "))


def refuse(script: str, why: str) -> NoReturn:
    """Ends the program."""
    print(f"{script}: {why}", file=sys.stderr)
    sys.exit(2)


@contextmanager
def refusing_damage(script: str, file: Path) -> Iterator[None]:
    """Whatever goes wrong inside ends the program in one line: a damaged file may hold anything."""
    try:
        yield
    except (OSError, Unreadable) as error:
        refuse(script, str(error))
    except Exception as error:
        refuse(script, f"{file}: {one_line(error)}")


def require_modules(script: str, *modules: str) -> None:
    """Ends the program if one of the modules is not installed, and names the packages."""
    missing = [MODULES[module] for module in modules if importlib.util.find_spec(module) is None]
    if missing:
        refuse(
            script,
            f"Python packages are missing; install them with: apt install {' '.join(missing)}",
        )


def require_program(script: str, program: str) -> None:
    """Ends the program if `program`, which a Debian package of the
    same name holds, is not installed."""
    if shutil.which(program) is None:
        refuse(script, f"{program} is missing; install it with: apt install {program}")
