"""What pictures of measurements share: matplotlib wherever it is, and panels with both axes in logarithms."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
# The first is that of .ci/run, which has it already.
PLACES = [TARGET / "ci-venv" / "bin" / "python", TARGET / "plots-venv" / "bin" / "python"]


def has_matplotlib(python):
    return Path(python).exists() and subprocess.run([python, "-c", "import matplotlib"], capture_output=True).returncode == 0


def need_matplotlib():
    """Goes on with a Python that has matplotlib, installing it under target/ where there is none."""
    try:
        import matplotlib
    except ImportError:
        found = next((python for python in PLACES if has_matplotlib(python)), None)
        if not found:
            found = PLACES[-1]
            subprocess.run([sys.executable, "-m", "venv", found.parent.parent], check=True)
            subprocess.run([found, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "matplotlib>=3.8,<4"], check=True)
        os.execv(found, [str(found), *sys.argv])
    matplotlib.use("Agg")


def panels(rows, columns, size):
    """A figure and its axes, row by row."""
    import matplotlib.pyplot as plt

    figure, grid = plt.subplots(rows, columns, figsize=size, squeeze=False, constrained_layout=True)
    return figure, [axes for row in grid for axes in row]


def finish(axes, title, x, y):
    axes.set_title(title, fontsize=9)
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.tick_params(which="both", labelsize=7)
    axes.grid(alpha=0.25)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, frameon=False).set_in_layout(False)


def save(figure, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=90)
