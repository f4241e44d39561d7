"""The command `ndda`, which the package brings."""

from __future__ import annotations

import signal
import sys

from ndda import _core


def main() -> int:
    """Do what the command line asks for; returns the exit code."""
    # The command looks for Ctrl-C itself, and ends after a whole step.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core._command(["ndda", *sys.argv[1:]], [sys.executable, "-m", "ndda"])
