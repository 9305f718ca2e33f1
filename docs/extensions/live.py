"""The directive ``.. live:: NAME``: a figure that the reader can change.

``docs/_static/learn/figures/NAME.js`` runs it. Before, or without scripts, the page shows a picture
drawn here. The figures run on the compiled core where `live_core` is the folder of its build; else
on the answers that `live_steps` has computed, which suffice for their sliders.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import live_steps
from docutils import nodes
from docutils.parsers.rst import directives
from live_files import FOLDER, STATIC, copy_view, figure_html, write_answers
from sphinx.util.docutils import SphinxDirective
from sphinx.util.osutil import relative_uri

if TYPE_CHECKING:
    from collections.abc import Callable

    from sphinx.application import Sphinx


class LiveFigure(nodes.General, nodes.Element):
    """A figure in the tree of a page, with the attributes `name` and `alt`."""


class Live(SphinxDirective):
    """The directive."""

    required_arguments = 1
    option_spec: ClassVar[dict[str, Callable[[str], Any]]] = {"alt": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        """Return the figure; without a text, or with an unknown name, it is an error."""
        name = self.arguments[0]
        alt = " ".join(self.options.get("alt", "").split())
        if not alt:
            raise self.error(f"the figure {name} has no :alt: that describes it")
        if name not in live_steps.FIGURES or not (STATIC / "figures" / f"{name}.js").exists():
            raise self.error(f"there is no figure {name}")
        return [LiveFigure(name=name, alt=alt)]


def visit_html(translator: Any, node: LiveFigure) -> None:
    """Write a figure."""
    builder = translator.builder
    page = builder.get_target_uri(builder.current_docname)
    folder = relative_uri(page, FOLDER)
    live = core_folder(builder.app) is not None
    translator.body.append(figure_html(node["name"], node["alt"], folder=folder, live=live))
    raise nodes.SkipNode


def visit_text(translator: Any, node: LiveFigure) -> None:
    """Write the description alone, where a page has no scripts."""
    translator.add_text(f"[{node['alt']}]")
    raise nodes.SkipNode


def core_folder(app: Sphinx) -> Path | None:
    """Return the folder of the compiled core, or None if there is no build of it."""
    folder = app.config.live_core
    return Path(folder) if folder and Path(folder).is_dir() else None


def add_scripts(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: nodes.document | None
) -> None:
    """Load styles and scripts on the pages that need them."""
    del page, template, context
    if doctree is not None and any(doctree.findall(LiveFigure)):
        app.add_css_file("learn/learn.css")
        app.add_js_file("learn/main.js", type="module")


def write_files(app: Sphinx, exception: Exception | None) -> None:
    """Write the answers, and copy the view and the compiled core, to where the pages look."""
    if exception is not None or app.builder.format != "html":
        return
    target = Path(app.outdir) / FOLDER
    write_answers(target)
    copy_view(target)
    core = core_folder(app)
    if core is not None:
        shutil.copytree(core, target / "core", dirs_exist_ok=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_config_value("live_core", None, "env", [str, type(None)])
    app.add_directive("live", Live)
    app.add_node(LiveFigure, html=(visit_html, None), text=(visit_text, None))
    app.connect("html-page-context", add_scripts)
    app.connect("build-finished", write_files)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
