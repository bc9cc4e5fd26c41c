"""What the tests of `foldproof judge` and of its protocol share: the solvers that are shipped, and
one that writes down what passes the pipe."""

from pathlib import Path

from program_case import ROOT, ProgramCase

SUBJECTS = ROOT / "verification" / "subjects"
PYTHON = "exec /usr/bin/python3"
TOY = f"{PYTHON} '{SUBJECTS}/adapters/toy_solver.py'"
# settings with which the toy can run a sheet
SPRINGS = ("--set", "bending.stiffness=0", "--set", "stretch.damping=0", "--set",
           "time.step=5e-4")

# An adapter that writes down every header that comes or goes, and states its settings as its
# mapping.
LOGGING = """
import json, sys
sys.path.insert(0, {adapters!r})
from foldproof_solver import Pipe, open_pipe, serve
from toy_solver import ToySolver

class Logging(Pipe):
    def receive(self):
        message = super().receive()
        if message:
            print(json.dumps([">", message[0]]), file=log, flush=True)
        return message
    def send(self, header, arrays=None):
        print(json.dumps(["<", header]), file=log, flush=True)
        super().send(header, arrays)

class Stating(ToySolver):
    capabilities = (*ToySolver.capabilities, *{more!r})
    def prepare(self, scene):
        return {{**super().prepare(scene), **scene.header["scene"]["settings"]}}

log = open({log!r}, "a")
inner = open_pipe()
serve(Stating(), Logging(inner.source, inner.sink))
"""


def bad(program: str, kind: str) -> str:
    return f"{PYTHON} '{SUBJECTS}/bad/{program}.py' {kind}"


class JudgeCase(ProgramCase):
    def logging_solver(self, *more: str) -> tuple[str, Path]:
        """A command, and the file of its headers. It declares more capabilities, and ignores what
        it is then sent."""
        log, program = self.path / "log", self.path / "logging.py"
        program.write_text(
            LOGGING.format(adapters=str(SUBJECTS / "adapters"), log=str(log), more=more),
            encoding="utf-8"
        )
        return f"{PYTHON} '{program}'", log
