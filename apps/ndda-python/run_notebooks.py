"""Runs notebooks to their end: python run_notebooks.py FILE ... Each assertion in them has to hold."""

import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

# Notebooks at a time.
WORKERS = 2


def failure(file):
    """What went wrong in a notebook, or None."""
    began = time.monotonic()
    notebook = nbformat.read(file, as_version=4)
    place = {"metadata": {"path": str(file.parent)}}
    try:
        NotebookClient(notebook, timeout=300, kernel_name="python3", resources=place).execute()
    except CellExecutionError as error:
        return f"{file}: {error}"
    print(f"{file.name}: {time.monotonic() - began:.1f} s", flush=True)
    return None


if __name__ == "__main__":
    with ThreadPoolExecutor(WORKERS) as pool:
        failed = [one for one in pool.map(failure, map(Path, sys.argv[1:])) if one]
    sys.exit("\n".join(failed) if failed else 0)
