"""A program from its start to its end: what it says, and what time it takes."""

import os
import subprocess
import tempfile
import time
from dataclasses import dataclass


@dataclass
class Ended:
    code: int
    out: str
    err: str
    cpu_s: float
    wall_s: float


def run(command, **options):
    """Runs a command; processor time is that of it and of what it started and waited for."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        wall = time.perf_counter()
        process = subprocess.Popen(command, stdout=out, stderr=err, **options)
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - wall
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        return Ended(process.returncode, out.read(), err.read(), usage.ru_utime + usage.ru_stime, wall_s)
