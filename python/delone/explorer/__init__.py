"""Interactive views of 2-D meshes, in notebooks and in the browser: `delone.explore`.

`scene` turns an object into arrays for the view, `state` moves points and retriangulates, `widget`
is the notebook widget (extra ``explore``), and `server` serves the page of the command
``delone explore``. The view is JavaScript without dependencies: view.js, which begins with a
description of its interface, and the modules that it imports.
"""

from __future__ import annotations

from importlib.resources import files

__all__ = ["script"]


def script(name: str) -> str:
    """Return the text of a file of this folder, such as a JavaScript module."""
    return files("delone.explorer").joinpath(name).read_text(encoding="utf-8")
