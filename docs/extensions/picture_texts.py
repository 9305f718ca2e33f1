"""Alternative texts of pictures: a thumbnail is described by the title of its example."""

from __future__ import annotations

import posixpath
from typing import TYPE_CHECKING, Any

from docutils import nodes

if TYPE_CHECKING:
    from sphinx.application import Sphinx

THUMBNAIL = ("sphx_glr_", "_thumb")


def _example(image: nodes.image) -> str:
    """Return the name of the page of a thumbnail, or an empty string."""
    folder, name = posixpath.split(image["uri"])
    start, end = THUMBNAIL
    stem = posixpath.splitext(name)[0]
    if not (folder.endswith("/thumb") and stem.startswith(start) and stem.endswith(end)):
        return ""
    page = posixpath.dirname(posixpath.dirname(folder))
    return posixpath.join(page, stem.removeprefix(start).removesuffix(end)).lstrip("/")


def describe_thumbnails(app: Sphinx, doctree: nodes.document, page: str) -> None:
    """Give each thumbnail of the gallery its text."""
    del page
    for image in doctree.findall(nodes.image):
        title = app.env.titles.get(_example(image))
        if title is not None:
            image["alt"] = f"Figure of the example: {title.astext()}"


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension."""
    app.connect("doctree-resolved", describe_thumbnails)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
