"""What is written about the package: examples that run, and pages that are up to date."""

import doctest
import inspect
import pathlib
import subprocess
import sys

import ndda
import pytest
from ndda._blocks import Blocks, BlockSelection
from ndda._law import Facets

HERE = pathlib.Path(__file__).resolve().parents[1]
CLASSES = [ndda.Scene, ndda.Simulation, ndda.Results, ndda.Page, ndda.Picture, Blocks, BlockSelection]


def public() -> list[tuple[str, object]]:
    found: list[tuple[str, object]] = []
    for name in ndda.__all__:
        thing = getattr(ndda, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            found.append((name, thing))
    for kind in [*CLASSES]:
        for name in dir(kind):
            if not name.startswith("_"):
                found.append((f"{kind.__name__}.{name}", inspect.getattr_static(kind, name)))
    for module in (ndda.builders, ndda.joint):
        found += [(f"{module.__name__}.{name}", getattr(module, name)) for name in module.__all__]
    return [*found, ("Facets", Facets)]


@pytest.mark.parametrize(("name", "thing"), public(), ids=[name for name, _ in public()])
def test_a_public_name_says_what_it_is_and_has_an_example(name: str, thing: object) -> None:
    text = thing.__doc__ or ""
    assert text.strip() and ">>>" in text, name


@pytest.mark.parametrize(("name", "thing"), public(), ids=[name for name, _ in public()])
def test_examples_of_the_native_part_run(name: str, thing: object) -> None:
    is_native = getattr(thing, "__module__", "ndda._core") in ("ndda", "ndda._core")
    if not is_native or inspect.isfunction(thing) or isinstance(thing, property):
        pytest.skip("pytest runs it with its module")
    test = doctest.DocTestParser().get_doctest(inspect.cleandoc(thing.__doc__), {}, name, None, 0)
    assert doctest.DocTestRunner().run(test).failed == 0


def test_the_reference_is_that_of_the_package() -> None:
    command = [sys.executable, str(HERE / "write_reference.py")]
    written = subprocess.run(command, check=True, capture_output=True, text=True, encoding="utf-8").stdout
    kept = (HERE.parents[1] / "docs/python/reference.md").read_text(encoding="utf-8")
    assert written == kept, "run write_reference.py"


@pytest.mark.parametrize("name", ["tutorial.md", "howto.md"])
def test_examples_of_a_page_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    root = HERE.parents[1]
    monkeypatch.chdir(root)
    names: dict[str, object] = {}
    for block in (root / "docs/python" / name).read_text(encoding="utf-8").split("```python\n")[1:]:
        exec(compile(block.split("```")[0], name, "exec"), names)
