"""Writes docs/python/reference.md from the docstrings of the installed package.

Usage: python write_reference.py > ../../docs/python/reference.md
"""

import inspect
import re
import sys

import ndda
from ndda import builders, joint
from ndda._blocks import Blocks, BlockSelection
from ndda._law import Facets

HEAD = """# Reference of the Python package

Written by `apps/ndda-python/write_reference.py` from the package itself. Units are SI. The classes of `ndda.builders` have the names and fields of [the scene file](../reference/scene.md).
"""
SECTION = re.compile(r"^(Parameters|Returns|Raises|Examples|Attributes)\n-+\n", re.M)


def entry(level, name, signature, doc):
    """A name with its signature, what it does, its parameters, and an example."""
    parts = SECTION.split(inspect.cleandoc(doc or ""))
    lines = [f"{'#' * level} `{name}{signature}`", "", flowing(parts[0])]
    for title, text in zip(parts[1::2], parts[2::2], strict=True):
        if title == "Examples":
            lines += ["", "```python", text.strip(), "```"]
        else:
            lines += ["", f"*{title}*", "", *items(text)]
    return "\n".join(lines).rstrip() + "\n"


def flowing(text):
    return "\n\n".join(" ".join(part.split()) for part in text.strip().split("\n\n"))


def items(text):
    """Fields of a numpydoc section: a line each."""
    found = []
    for line in text.strip().splitlines():
        if line.startswith("    "):
            found[-1].append(line.strip())
        elif line.strip():
            name, _, kind = line.partition(" : ")
            found.append([f"* **{name.strip()}**{f' ({kind.strip()})' if kind else ''}"])
    return [one[0] + (": " + " ".join(one[1:]) if one[1:] else "") for one in found]


def signature_of(thing):
    """The signature without types, which are in the list of parameters."""
    found = inspect.signature(thing)
    plain = inspect.Parameter.POSITIONAL_OR_KEYWORD
    kept = []
    for one in found.parameters.values():
        kind = plain if one.kind is inspect.Parameter.POSITIONAL_ONLY else one.kind
        if one.name not in ("self", "cls"):
            kept.append(one.replace(annotation=inspect.Parameter.empty, kind=kind))
    return str(found.replace(parameters=kept, return_annotation=inspect.Signature.empty))


def of_class(name, kind, names):
    # The others are made by functions.
    out = [entry(2, name, signature_of(kind) if kind is ndda.Simulation else "", kind.__doc__)]
    for member in names:
        found = inspect.getattr_static(kind, member)
        if isinstance(found, property) or inspect.isgetsetdescriptor(found):
            out.append(entry(3, f"{name}.{member}", "", found.__doc__))
        else:
            out.append(entry(3, f"{name}.{member}", signature_of(getattr(kind, member)), found.__doc__))
    return out


def members(kind):
    """Public members, those of the native base included."""
    return sorted(name for name in dir(kind) if not name.startswith("_") and name not in dir(BaseException))


def text():
    parts = [HEAD]
    for name in ("load", "parse", "run", "resume", "read", "study", "certify", "safety", "stereonet", "picture"):
        thing = getattr(ndda, name)
        parts.append(entry(2, f"ndda.{name}", signature_of(thing), thing.__doc__))
    for name in ("shear", "closure"):
        thing = getattr(joint, name)
        parts.append(entry(2, f"ndda.joint.{name}", signature_of(thing), thing.__doc__))
    parts += of_class("joint.Test", joint.Test, [])
    for name in ("Scene", "Simulation", "Results", "Page", "Picture"):
        kind = getattr(ndda, name)
        parts += of_class(name, kind, members(kind))
    parts += of_class("Blocks", Blocks, [])
    parts += of_class("BlockSelection", BlockSelection, members(BlockSelection))
    parts += of_class("Facets", Facets, [])
    for name in ("SceneError", "StopError", "Snapshot"):
        parts.append(entry(2, name, "", getattr(ndda, name).__doc__))
    names = ", ".join(f"`{name}`" for name in builders.__all__)
    parts.append(f"## `ndda.builders`\n\nClasses with fields and choices of scenes: {names}.\n")
    return "\n".join(parts)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8", newline="\n")
    sys.stdout.write(text())
