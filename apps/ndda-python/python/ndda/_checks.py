"""Arguments that are checked before anything is done."""

from __future__ import annotations

import math
import operator
from numbers import Real
from typing import Any

_MOST_THREADS = 1024
# Steps are counted in 64 bits.
MOST_STEPS = 2**63 - 1


def whole(name: str, value: Any, least: int, most: int = MOST_STEPS) -> int:
    """The argument as a whole number, or an exception that names it."""
    try:
        if isinstance(value, bool):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}: give a whole number") from None
    if not least <= number <= most:
        limit = f"at least {least}" if number < least else f"at most {most}"
        raise ValueError(f"{name} is {number}: give {limit}")
    return number


def thread_count(value: Any) -> int | None:
    """A number of threads, or None for all processors."""
    try:
        number = None if value is None else whole("threads", value, 1, _MOST_THREADS)
    except (TypeError, ValueError) as error:
        advice = f"threads is {value!r}: give 1 to {_MOST_THREADS}, or None for all processors"
        raise type(error)(advice) from None
    return number


def names(name: str, value: Any) -> list[str]:
    """One text or several as a list, or an exception that names the argument."""
    several = [value] if isinstance(value, str) or not hasattr(value, "__iter__") else list(value)
    if not all(isinstance(one, str) for one in several):
        raise TypeError(f"{name} is {value!r}: give a text or a list of texts")
    return several


def finite(name: str, value: Any, what: str) -> float:
    """The argument as a finite number, or an exception that names it and what it should be."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name} is {value!r}: give {what}")
    if not math.isfinite(value):
        raise ValueError(f"{name} is {value}: give {what}")
    return float(value)
