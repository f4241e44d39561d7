"""Measures what the package costs: calls, copies, threads, import. Usage: python costs.py"""

import pathlib
import subprocess
import sys
import threading
import time

import ndda
import numpy as np

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"


def least_s(work, times: int = 7) -> float:
    """Least time of several [s]."""
    found = []
    for _ in range(times):
        began = time.perf_counter()
        work()
        found.append(time.perf_counter() - began)
    return min(found)


def call_s(count: int = 20_000) -> float:
    """What a call of step costs beside the step [s]."""
    simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE, **{"time.end_s": 1e6, "output.history_rows": 1}))
    start = simulation.snapshot()

    def singly() -> None:
        simulation.restore(start)
        for _ in range(count):
            simulation.step()

    def together() -> None:
        simulation.restore(start)
        simulation.step(count)

    return (least_s(singly) - least_s(together)) / count


def copies_s() -> tuple[float, float, int]:
    """What a copy of about 8000 nodes costs, new and in place [s]."""
    cells = "shape: Box(size_m: (1, 1, 1), cells: (19, 19, 19))"
    scene = ndda.EXAMPLE.replace("shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))", cells)
    simulation = ndda.Simulation(ndda.parse(scene))
    room = np.empty(simulation.position.shape)
    count = 2000

    def new() -> None:
        for _ in range(count):
            _ = simulation.position

    def filled() -> None:
        for _ in range(count):
            simulation.array("position", out=room)

    # The mean of many: a single copy may find its room in the cache.
    return least_s(new, 3) / count, least_s(filled, 3) / count, len(room)


def two_threads() -> float:
    """Steps of two simulations in two threads over those of one in the same time."""

    def one(simulation: ndda.Simulation) -> None:
        simulation.run(until=0.2)

    def new() -> ndda.Simulation:
        return ndda.Simulation(ndda.load(SCENES / "bounce.ron"), threads=1)

    single, both = new(), [new(), new()]
    alone_s = least_s(lambda: one(single), 1)
    workers = [threading.Thread(target=one, args=(simulation,)) for simulation in both]
    began = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return 2 * alone_s / (time.perf_counter() - began)


def import_s(what: str) -> float:
    """Seconds of an import beside the start of Python."""
    command = [sys.executable, "-c"]
    bare = least_s(lambda: subprocess.run([*command, "pass"], check=True))
    return least_s(lambda: subprocess.run([*command, f"import {what}"], check=True)) - bare


if __name__ == "__main__":
    print(f"a call of step(): {call_s() * 1e6:.2f} µs")
    new_s, filled_s, nodes = copies_s()
    print(f"a copy of {nodes} nodes: new {new_s * 1e6:.0f} µs, in place {filled_s * 1e6:.0f} µs")
    print(f"two threads over one: {two_threads():.2f}")
    print(f"import numpy: {import_s('numpy') * 1e3:.0f} ms, ndda, which leaves numpy to its first array: {import_s('ndda') * 1e3:.0f} ms")
