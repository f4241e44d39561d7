"""What all builders of scenes share: writing RON, reading dictionaries.

The kind of a field is a word of its class's `_kinds`: ``num``, ``int``, ``str``, ``bool``, the name of a builder or a choice;
``[kind]`` is a list, ``(kind)`` a tuple of fixed length, ``<kind>`` the several values of a choice, ``{kind}`` numbers by name.
"""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Mapping
from numbers import Real
from typing import Any, ClassVar, TypeVar

_B = TypeVar("_B", bound="Builder")


class Builder:
    """A part of a scene; what is None is left out, and the scene's default counts."""

    _kinds: ClassVar[Mapping[str, str]] = {}
    # Of a choice with fields: its name in the scene; its module-level class is the choice.
    _variant: ClassVar[str] = ""

    def to_ron(self) -> str:
        """Write it as a scene has it."""
        fields = self._written()
        if list(self._kinds) == ["value"]:
            return f"{self._variant}({fields['value']})"
        return f"{self._variant}({', '.join(f'{name}: {text}' for name, text in fields.items())})"

    def _written(self) -> dict[str, str]:
        values = {name: getattr(self, name) for name in self._kinds}
        unknown = [name for name in vars(self) if name not in self._kinds]
        if unknown:
            raise AttributeError(f"{type(self).__qualname__} has no field {unknown[0]!r}: {', '.join(self._kinds)}")
        return {
            name: _ron(self._kinds[name], value, f"{type(self).__qualname__}.{name}")
            for name, value in values.items()
            if value is not None
        }

    @classmethod
    def from_dict(cls: type[_B], fields: Mapping[str, Any]) -> _B:
        """Make it of a dictionary with the same fields, choices with fields being dictionaries of one key."""
        name_of = cls.__qualname__
        unknown = [name for name in fields if name not in cls._kinds]
        if unknown:
            raise ValueError(f"{name_of} has no field {unknown[0]!r}: {', '.join(cls._kinds)}")
        values = {name: _built(cls._kinds[name], value, f"{name_of}.{name}") for name, value in fields.items()}
        try:
            return cls(**values)
        except TypeError as error:
            missing = str(error).partition("missing ")[2].partition(": ")[2]
            raise ValueError(f"{name_of} lacks {missing}" if missing else f"{name_of}: {error}") from None


def _class(kind: str) -> Any:
    return getattr(sys.modules["ndda.builders"], kind)


def _ron(kind: str, value: Any, where: str) -> str:
    if isinstance(value, Builder):
        return value.to_ron()
    if kind[0] in "[(<":
        if hasattr(value, "tolist"):
            value = value.tolist()
        inner = ", ".join(_ron(kind[1:-1], one, where) for one in _row(value, where))
        return inner if kind[0] == "<" else f"{kind[0]}{inner}{kind[-1]}"
    if kind[0] == "{":
        if not isinstance(value, Mapping):
            raise TypeError(f"{where} is {value!r}: give a dictionary of numbers")
        return f"({', '.join(f'{name}: {_ron(kind[1:-1], one, where)}' for name, one in value.items())})"
    if kind in ("num", "int", "str", "bool"):
        return _plain(kind, value, where)
    if isinstance(value, str):
        # A choice without fields.
        return value
    if isinstance(value, Mapping):
        built = _built(kind, value, where)
        return built if isinstance(built, str) else str(built.to_ron())
    raise TypeError(f"{where} is {value!r}: give a {kind} of ndda.builders")


def _row(value: Any, where: str) -> Any:
    if isinstance(value, (str, Mapping)) or not hasattr(value, "__iter__"):
        raise TypeError(f"{where} is {value!r}: give a list or a tuple")
    return value


def _plain(kind: str, value: Any, where: str) -> str:
    """Write a number, a text or a boolean; numbers of numpy count as those of Python."""
    if kind == "str":
        text = os.fspath(value) if isinstance(value, os.PathLike) else value
        if not isinstance(text, str):
            raise TypeError(f"{where} is {value!r}: give a text")
        return json.dumps(text, ensure_ascii=False)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if kind == "bool":
        if not isinstance(value, bool):
            raise TypeError(f"{where} is {value!r}: give True or False")
        return "true" if value else "false"
    if isinstance(value, str):
        return _computed(value, where)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{where} is {value!r}: give a {'whole ' if kind == 'int' else ''}number")
    if not math.isfinite(value):
        raise ValueError(f"{where} is {value!r}: give a finite number")
    if kind == "num":
        return repr(float(value))
    if not float(value).is_integer():
        raise ValueError(f"{where} is {value!r}: give a whole number")
    return str(math.trunc(value))


def _computed(text: str, where: str) -> str:
    """A number with its unit, or computed from parameters, such as ``Millimetre(3)``."""
    try:
        float(text)
    except ValueError:
        return text
    raise TypeError(f"{where} is {text!r}: give a number without quotes")


def _built(kind: str, value: Any, where: str) -> Any:
    if value is None or isinstance(value, Builder):
        return value
    if kind[0] == "[":
        return [_built(kind[1:-1], one, where) for one in _row(value, where)]
    if kind[0] in "(<":
        return tuple(_built(kind[1:-1], one, where) for one in _row(value, where))
    if not isinstance(value, Mapping) or kind[0] == "{":
        return value
    found = _class(kind)
    if isinstance(found, type) and issubclass(found, Builder):
        return found.from_dict(value)
    if len(value) != 1:
        raise ValueError(f"{kind} is {dict(value)!r}: name one choice, as {{name: fields}}")
    ((name, inner),) = value.items()
    variant = getattr(found, name, None)
    if not (isinstance(variant, type) and issubclass(variant, Builder)):
        raise ValueError(f"{kind} has no choice {name!r} with fields")
    if list(variant._kinds) == ["value"]:
        return variant(value=_built(variant._kinds["value"], inner, where))  # type: ignore[call-arg]
    return variant.from_dict(inner)
