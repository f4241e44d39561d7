"""Writes python/ndda/builders.py from the schema of scenes.

Usage: ndda schema > schema.json && python write_builders.py schema.json > python/ndda/builders.py
"""

import json
import keyword
import re
import sys
import textwrap
import types
from pathlib import Path

HEAD = '''"""Scenes as objects, with completion; what is left out has the scene's default.

Written by `write_builders.py` from the schema of scenes, and not by hand.

>>> rock = Material(name="rock", density_kg_m3=2600.0, young_pa=1e9, poisson=0.25)
>>> block = Block(name="block", material="rock", shape=Shape.Box(size_m=(1, 1, 1), cells=(1, 1, 1)), body=Body.Rigid)
>>> scene = Scene(title="A block", time=Time(step_s=0.01, end_s=1.0), materials=[rock], blocks=[block])
>>> import ndda
>>> ndda.parse(scene).steps
100
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, TypeAlias

from ndda._builder import Builder
'''

WORDS = {"num": "float", "int": "int", "str": "str", "bool": "bool"}
SAMPLES = {"num": "1.0", "int": "1", "str": '"name"', "bool": "True"}


def kind_of(schema):
    """The kind of a value, as ndda._builder has it."""
    if "$ref" in schema:
        return schema["$ref"].rsplit("/", 1)[1]
    if "anyOf" in schema:
        return kind_of(next(one for one in schema["anyOf"] if one.get("type") != "null"))
    kinds = schema["type"]
    name = next(kind for kind in kinds if kind != "null") if isinstance(kinds, list) else kinds
    if name == "array":
        inner = kind_of(schema["prefixItems"][0] if "prefixItems" in schema else schema["items"])
        is_fixed = "minItems" in schema and schema.get("minItems") == schema.get("maxItems")
        return f"({inner})" if is_fixed else f"[{inner}]"
    if name == "object":
        return f"{{{kind_of(schema['additionalProperties'])}}}"
    return {"number": "num", "integer": "int", "string": "str", "boolean": "bool"}[name]


def type_of(kind, choices):
    """The type of a field in Python."""
    if kind[0] in "[(":
        inner = type_of(kind[1:-1], choices)
        return f"list[{inner}]" if kind[0] == "[" and kind[1:-1] in choices["all"] else f"Sequence[{inner}]"
    if kind[0] == "{":
        return f"Mapping[str, {type_of(kind[1:-1], choices)}]"
    if kind in choices["unions"]:
        return f"{kind}Choice"
    return WORDS.get(kind, kind)


def safe(word):
    """The word as a name in Python; a scene's None is a word like the others."""
    return f"{word}_" if keyword.iskeyword(word) else word


def wrapped(text, indent):
    lines = textwrap.wrap(" ".join(text.split()), 110 - indent, break_long_words=False) or [""]
    return "\n".join(" " * indent + line for line in lines)


def summary(text, indent):
    """The beginning of a docstring: the first sentence, and the others below it."""
    first, found, rest = " ".join(text.split()).partition(". ")
    head = wrapped('"""' + first + (found and "."), indent)
    return head + ("\n\n" + wrapped(rest, indent) if rest else "")


class Writer:
    def __init__(self, schema):
        self.schema, self.types = schema, schema["$defs"] | {"Scene": schema}
        self.unions = [name for name, one in self.types.items() if "oneOf" in one]
        self.choices = {"unions": self.unions, "all": list(self.types)}

    def sample(self, kind, length=3):
        """An example of a value, with no more in it than must be."""
        if kind[0] == "(":
            return f"({', '.join([self.sample(kind[1:-1])] * length)})"
        if kind[0] == "[":
            return f"[{self.sample(kind[1:-1])}]"
        if kind[0] == "{":
            return "{}"
        if kind in SAMPLES:
            return SAMPLES[kind]
        if kind in self.unions:
            first = self.types[kind]["oneOf"][0]
            if "const" in first:
                return f"{kind}.{safe(first['const'])}"
            ((name, inner),) = first["properties"].items()
            return self.sample_of(f"{kind}.{name}", inner)
        return self.sample_of(kind, self.types[kind])

    def sample_of(self, name, definition):
        if "properties" not in definition:
            return f"{name}({self.sample(kind_of(definition), definition.get('minItems', 3))})"
        required = definition.get("required", [])
        fields = [f"{field}={self.sample_field(definition['properties'][field])}" for field in required]
        return f"{name}({', '.join(fields)})"

    def sample_field(self, field):
        kind = kind_of(field)
        return self.sample(kind, field.get("minItems", 3))

    def struct(self, name, definition, path, description, indent=0):
        """A class with fields."""
        pad = " " * indent
        fields = definition.get("properties")
        is_value = fields is None
        if is_value:
            fields = {"value": definition | {"description": definition.get("description", description)}}
        required = ["value"] if is_value else definition.get("required", [])
        order = sorted(fields, key=lambda field: field not in required)
        lines = [f"{pad}@dataclass{'' if is_value else '(kw_only=True)'}", f"{pad}class {name}(Builder):"]
        doc = [summary(description, indent + 4), "", f"{pad}    Parameters", f"{pad}    ----------"]
        for field in order:
            kind = kind_of(fields[field])
            optional = "" if field in required else ", optional"
            doc.append(f"{pad}    {field} : {type_of(kind, self.choices)}{optional}")
            doc.append(wrapped(fields[field].get("description", description), indent + 8))
        sample = self.sample_of(path, definition)
        doc += ["", f"{pad}    Examples", f"{pad}    --------"]
        doc += [f"{pad}    >>> {sample}.to_ron()", f"{pad}    @@{sample}.to_ron()@@"]
        lines += [*doc, f'{pad}    """', ""]
        for field in order:
            hint = type_of(kind_of(fields[field]), self.choices)
            lines.append(f"{pad}    {field}: {hint}" + ("" if field in required else " | None = None"))
        kinds = ", ".join(f'"{field}": "{kind_of(fields[field])}"' for field in fields)
        if is_value and "prefixItems" in definition:
            kinds = kinds.replace("(", "<").replace(")", ">")
        lines.append(f"{pad}    _kinds: ClassVar[Mapping[str, str]] = {{{kinds}}}")
        if path != name:
            lines.append(f'{pad}    _variant: ClassVar[str] = "{name}"')
        return lines

    def union(self, name, definition):
        """A class that holds the choices, and the type of what may be chosen."""
        lines = [f"class {name}:", summary(definition.get("description", name), 4), "", "    Examples", "    --------"]
        first = definition["oneOf"][0]
        if "const" in first:
            lines += [f"    >>> {name}.{safe(first['const'])}", f"    '{first['const']}'"]
        else:
            lines += [f"    >>> {self.sample(name)}.to_ron()", f"    @@{self.sample(name)}.to_ron()@@"]
        lines += ['    """', ""]
        members = []
        for one in definition["oneOf"]:
            if "const" in one:
                word = one["const"]
                lines.append(wrapped("# " + one["description"], 4).replace("\n    ", "\n    # "))
                lines.append(f'    {safe(word)}: ClassVar[Literal["{word}"]] = "{word}"')
                members.append(f'Literal["{word}"]')
            else:
                ((word, inner),) = one["properties"].items()
                lines += ["", *self.struct(word, inner, f"{name}.{word}", one["description"], 4), ""]
                members.append(f"{name}.{word}")
        alias = f"{name}Choice: TypeAlias = {' | '.join(members)}"
        return lines, alias

    def text(self):
        parts, aliases = [HEAD], []
        for name in sorted(self.types):
            definition = self.types[name]
            if name in self.unions:
                lines, alias = self.union(name, definition)
                aliases.append(alias)
            else:
                lines = self.struct(name, definition, name, definition["description"])
            parts.append("\n".join(lines).rstrip() + "\n")
        parts.append("\n".join(aliases) + "\n")
        names = sorted(self.types)
        parts.append("__all__ = [\n" + "".join(f'    "{name}",\n' for name in names) + "]\n")
        text = re.sub(r"\n{3,}( +)", r"\n\n\1", "\n\n".join(parts))
        return answered(re.sub(r"\n{4,}", "\n\n\n", text))


def answered(text):
    """The text with what its examples answer, which the module itself computes."""
    here = Path(__file__).parent / "python/ndda"
    for name, file in [("ndda", None), ("ndda._builder", here / "_builder.py"), ("ndda.builders", None)]:
        sys.modules[name] = types.ModuleType(name)
        code = text if name == "ndda.builders" else file.read_text(encoding="utf-8") if file else ""
        exec(compile(code, name, "exec"), vars(sys.modules[name]))
    names = vars(sys.modules["ndda.builders"])
    return re.sub("@@(.*)@@", lambda found: repr(eval(found[1], names)), text)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        sys.stdout.write(Writer(json.load(file)).text())
