"""Scenes as files, and folders for results, where a tool reads a file and writes to a folder."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ndda import _core
from ndda._scene import name_of, path_of, scene_of

if TYPE_CHECKING:
    from ndda._scene import SceneLike

_TEXT = r'"(?:[^"\\]|\\.)*"'
# Where a scene names files: in fields `file`, and in `include`, one or a list.
_FILES = re.compile(rf"\b(?:file\s*:\s*{_TEXT}|include\s*:\s*(?:{_TEXT}|\[[^\]]*\]))")


@contextmanager
def folder_of(out: str | os.PathLike[str] | None) -> Iterator[str]:
    """The folder of results, or one that is removed afterwards."""
    if out is not None:
        yield os.fspath(out)
        return
    import tempfile

    with tempfile.TemporaryDirectory(prefix="ndda") as folder:
        yield os.path.join(folder, "out")


@contextmanager
def file_of(given: SceneLike) -> Iterator[str]:
    """The file of a scene, or what else a path names; a changed scene, or one of a text, is written for the time being."""
    if isinstance(given, (str, os.PathLike)):
        yield path_of(given)
        return
    scene = scene_of(given)
    if is_file_of(scene):
        yield scene.file
        return
    import tempfile

    with tempfile.TemporaryDirectory(prefix="ndda") as folder:
        file = Path(folder) / f"{name_of(scene)}.ron"
        file.write_text(_anywhere(scene), encoding="utf-8")
        yield str(file)


def findable(scene: _core.Scene) -> _core.Scene:
    """The scene, or the same one with files that are found from any folder, where it is not that of its own file."""
    return scene if is_file_of(scene) else _core.Scene._parse(_anywhere(scene), [], scene.folder)


def is_file_of(scene: _core.Scene) -> bool:
    """Whether the scene is as its file has it."""
    file = Path(scene.file)
    is_beside = file.is_file() and file.resolve().parent == Path(scene.folder).resolve()
    return is_beside and file.read_text(encoding="utf-8") == scene.text


def _anywhere(scene: _core.Scene) -> str:
    """The text of a scene with the whole paths of the files that it names."""
    folder = Path(scene.folder).resolve()

    def whole(name: re.Match[str]) -> str:
        try:
            path = folder / json.loads(name[0])
        except ValueError:
            # An escape of RON that JSON lacks: the tool says that it finds no such file.
            return name[0]
        return json.dumps(str(path), ensure_ascii=False)

    return _FILES.sub(lambda field: re.sub(_TEXT, whole, field[0]), scene.text)
