"""Threads, processes that are forked, and what refers to a simulation."""

import gc
import multiprocessing
import pathlib
import threading
import weakref

import ndda
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"
BOUNCE = ndda.load(SCENES / "bounce.ron", **{"time.end_s": 0.12})


def end_of(threads: int | None) -> str:
    simulation = ndda.Simulation(BOUNCE, threads=threads)
    simulation.run()
    return simulation.state_crc32


def goes_on(simulation: ndda.Simulation) -> str:
    simulation.run()
    return simulation.state_crc32


def in_a_fork(work: object, *args: object) -> object:
    """What a process answers that is forked here."""
    queue = multiprocessing.get_context("fork").Queue()
    child = multiprocessing.get_context("fork").Process(target=lambda: queue.put(work(*args)))
    child.start()
    try:
        return queue.get(timeout=60)
    finally:
        child.kill()
        child.join()


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
def test_a_process_that_is_forked_after_threads_were_used_has_threads_of_its_own() -> None:
    expected = end_of(None)
    half = [ndda.Simulation(BOUNCE, threads=threads) for threads in (None, 2)]
    for simulation in half:
        simulation.run(until=0.1)
    for threads in (None, 1, 2):
        assert in_a_fork(end_of, threads) == expected
    for simulation in half:
        assert in_a_fork(goes_on, simulation) == expected
    assert in_a_fork(lambda: ndda.run(BOUNCE)["state_crc32"]) == expected
    # The parent is as it was.
    assert [goes_on(simulation) for simulation in half] == [expected] * 2


def test_a_simulation_that_steps_in_another_thread_says_so() -> None:
    endless = {"time.end_s": 1e7, "output.history_rows": 1, "gravity_m_s2": (0, 0, 0)}
    simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE, **endless))
    worker = threading.Thread(target=simulation.step, args=(200_000,))
    worker.start()
    refused = None
    while worker.is_alive() and refused is None:
        try:
            simulation.step()
        except RuntimeError as error:
            refused = error
    worker.join()
    assert "this simulation is stepping in another thread: wait for it" in str(refused)


def test_a_law_that_refers_to_its_simulation_is_freed_with_it() -> None:
    class Zero:
        stiffness_pa_m = 1e8

        def __call__(self, facets: object) -> np.ndarray:
            return 0.0 * facets.slip

    law = Zero()
    simulation = ndda.Simulation(BOUNCE, law=law)
    law.simulation = simulation
    simulation.run()
    both = weakref.ref(law), weakref.ref(simulation)
    del law, simulation
    gc.collect()
    assert [one() for one in both] == [None, None]
