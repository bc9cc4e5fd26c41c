"""Programs that may hang: run with a clock of the processor's time. Shared by scripts/faults and
scripts/mutate.
"""

import math
import os
import signal
import subprocess
import time
from pathlib import Path

BUSY_TRIES, NOT_EXECUTED = 25, 126  # exit code of prlimit
LARGEST_FILE = 2_000_000_000  # bytes
LOOK, STILL = 5.0, 30.0  # s: how often a process is looked at; how long it may use no processor


def run(command: list, folder: Path, clock: float | None = None) -> subprocess.CompletedProcess:
    """`clock` [s] limits the processor time of each process, so that a busy machine changes
    nothing. A command is also stopped when neither it nor its children use the processor for 30 s,
    and killed when it writes a file of 2 GB. Raises TimeoutExpired."""
    if clock is None:
        return subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, errors="replace", check=False)
    most = math.ceil(clock)
    limits = [f"--cpu={most}:{most + 5}", f"--fsize={LARGEST_FILE}"]
    limited = ["prlimit", *limits, "--", *command]
    for _ in range(BUSY_TRIES):
        ran = run_until_still(limited, folder)
        if ran.returncode != NOT_EXECUTED:
            break
        time.sleep(0.2)  # a process of another thread still has the linked file open for writing
    if ran.returncode == -signal.SIGXCPU:
        raise subprocess.TimeoutExpired(command, clock)
    return ran


def run_until_still(command: list, folder: Path) -> subprocess.CompletedProcess:
    with subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, errors="replace",
                          start_new_session=True) as process:
        used, since = 0.0, time.monotonic()
        try:
            while True:
                try:
                    out, err = process.communicate(timeout=LOOK)
                    return subprocess.CompletedProcess(command, process.returncode, out, err)
                except subprocess.TimeoutExpired:
                    now = processor_time(process.pid)
                    if now == used and time.monotonic() - since > STILL:
                        raise
                    if now != used:
                        used, since = now, time.monotonic()
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)


def processor_time(session: int) -> float:
    """Of all live processes of a POSIX session, and of the children that they waited for [s]."""
    ticks = 0
    for file in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = file.read_text(encoding="utf-8").rpartition(")")[2].split()
        except OSError:
            continue  # it ended meanwhile
        if int(fields[3]) == session:
            ticks += sum(map(int, fields[11:15]))
    return ticks / os.sysconf("SC_CLK_TCK")
