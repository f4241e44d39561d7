"""Arguments that are checked before anything is done."""

from __future__ import annotations

import math
import operator
from numbers import Real
from typing import Any

# Steps are counted in 64 bits.
MOST_STEPS = 2**63 - 1


def whole(name: str, value: Any, least: int, most: int = MOST_STEPS) -> int:
    """The argument as a whole number, or an exception that names it."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}: give a whole number") from None
    if not least <= number <= most:
        limit = f"at least {least}" if number < least else f"at most {most}"
        raise ValueError(f"{name} is {number}: give {limit}")
    return number


def finite(name: str, value: Any, what: str) -> float:
    """The argument as a finite number, or an exception that names it and what it should be."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name} is {value!r}: give {what}")
    if not math.isfinite(value):
        raise ValueError(f"{name} is {value}: give {what}")
    return float(value)
