"""The directive ``.. try-points::``: the element on which readers triangulate their own points.

`docs/_static/learn/try/main.js` runs it, on the compiled core that `live.py` copies.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from docutils import nodes
from live import core_folder
from live_files import WITHOUT_SCRIPTS, points_html
from sphinx.util.docutils import SphinxDirective

if TYPE_CHECKING:
    from sphinx.application import Sphinx


class TryPoints(nodes.General, nodes.Element):
    """The element in the tree of a page."""


class TryPointsDirective(SphinxDirective):
    """The directive."""

    def run(self) -> list[nodes.Node]:
        """Return the element."""
        return [TryPoints()]


def visit_html(translator: Any, node: TryPoints) -> None:
    """Write the element."""
    del node
    live = core_folder(translator.builder.app) is not None
    translator.body.append(points_html(live=live))
    raise nodes.SkipNode


def visit_text(translator: Any, node: TryPoints) -> None:
    """Say what is there, where a page has no scripts."""
    del node
    translator.add_text(f"[{WITHOUT_SCRIPTS}]")
    raise nodes.SkipNode


def add_scripts(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: nodes.document | None
) -> None:
    """Load styles and scripts on the page."""
    del page, template, context
    if doctree is not None and any(doctree.findall(TryPoints)):
        app.add_css_file("learn/learn.css")
        app.add_css_file("learn/try/try.css")
        app.add_js_file("learn/try/main.js", type="module")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("try-points", TryPointsDirective)
    app.add_node(TryPoints, html=(visit_html, None), text=(visit_text, None))
    app.connect("html-page-context", add_scripts)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
