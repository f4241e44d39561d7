"""A bar of progress for runs that last, where tqdm is installed."""

from __future__ import annotations

import sys
import time
from importlib.util import find_spec
from types import TracebackType
from typing import Any

_QUIET_S = 1.0


class Progress:
    """Shows how many steps of a run are done, once it has lasted a second."""

    def __init__(self, steps: int, *, wanted: bool) -> None:
        self._steps, self._wanted, self._began = steps, wanted, time.monotonic()
        self._bar: Any = None

    def show(self, done: int) -> None:
        """Take the bar to so many steps."""
        if self._bar is None and self._wanted and time.monotonic() - self._began > _QUIET_S:
            self._begin(done)
        if self._bar is not None:
            self._bar.update(done - self._bar.n)

    def _begin(self, done: int) -> None:
        in_notebook = "ipykernel" in sys.modules
        try:
            if in_notebook and find_spec("ipywidgets"):
                from tqdm.notebook import tqdm
            else:
                from tqdm import tqdm
        except ImportError:
            self._wanted = False
            return
        # None: nothing is drawn where nobody looks, as in a log.
        disable = False if in_notebook else None
        self._bar = tqdm(total=self._steps, initial=done, unit="step", leave=False, disable=disable)

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()
