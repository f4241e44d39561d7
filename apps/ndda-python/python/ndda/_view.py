"""Pages and pictures that show themselves in a notebook."""

from __future__ import annotations

import html
import os
from typing import Any

_HEIGHT_PX = 640


class Page:
    """A page of HTML that needs no network.

    Parameters
    ----------
    title : str
    text : str
        The page.
    frames : int
        Frames that it shows.

    Examples
    --------
    >>> page = Page("empty", "<p>Nothing</p>", 0)
    >>> page
    <ndda.Page 'empty', 0 frames>
    """

    def __init__(self, title: str, text: str, frames: int) -> None:
        self.title, self.html, self.frames = title, text, frames

    def save(self, file: str | os.PathLike[str]) -> None:
        """Write the page to a file.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "page.html"
        >>> Page("empty", "<p>Nothing</p>", 0).save(file)
        >>> file.read_text()
        '<p>Nothing</p>'
        """
        with open(file, "w", encoding="utf-8") as out:
            out.write(self.html)

    def open(self) -> None:
        """Show the page in a browser.

        Examples
        --------
        >>> Page("empty", "<p>Nothing</p>", 0).open()  # doctest: +SKIP
        """
        import tempfile
        import webbrowser
        from pathlib import Path

        handle, file = tempfile.mkstemp(suffix=".html", prefix="ndda")
        os.close(handle)
        self.save(file)
        webbrowser.open(Path(file).as_uri())

    def _repr_html_(self) -> str:
        # In a frame of its own, so that its styles and scripts leave the notebook alone.
        page = html.escape(self.html, quote=True)
        style = f"width: 100%; height: {_HEIGHT_PX}px; border: 0"
        return f'<iframe srcdoc="{page}" style="{style}" title="{html.escape(self.title)}"></iframe>'

    def __repr__(self) -> str:
        return f"<ndda.Page {self.title!r}, {self.frames} frames>"


class Picture:
    """A picture as SVG or PNG.

    Parameters
    ----------
    content : bytes
    kind : {"svg", "png"}

    Examples
    --------
    >>> Picture(b"<svg/>", "svg")
    <ndda.Picture, svg>
    """

    def __init__(self, content: bytes, kind: str) -> None:
        self.content, self.kind = content, kind

    @classmethod
    def of_file(cls, file: str) -> Picture:
        """Read a picture.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "empty.svg"
        >>> _ = file.write_bytes(b"<svg/>")
        >>> Picture.of_file(str(file)).kind
        'svg'
        """
        with open(file, "rb") as found:
            return cls(found.read(), os.path.splitext(file)[1].lstrip(".").lower())

    def save(self, file: str | os.PathLike[str]) -> None:
        """Write the picture to a file.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> Picture(b"<svg/>", "svg").save(pathlib.Path(tempfile.mkdtemp()) / "empty.svg")
        """
        with open(file, "wb") as out:
            out.write(self.content)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        if self.kind == "png":
            return {"image/png": self.content}
        return {"image/svg+xml": self.content.decode()}

    def __repr__(self) -> str:
        return f"<ndda.Picture, {self.kind}>"
