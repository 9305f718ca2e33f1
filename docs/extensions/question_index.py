"""Entries of the index on the page "How do I ...?" lead to the section of the question.

Sphinx lets them lead to a target of its own inside it, for which the search has no title.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from docutils import nodes
from questions import PAGE
from sphinx import addnodes
from sphinx.transforms import SphinxTransform

if TYPE_CHECKING:
    from sphinx.application import Sphinx


class EntriesOfSections(SphinxTransform):
    """Lets the entries of the index lead to the section, whose title the search has."""

    # Before the index is collected, at 850.
    default_priority = 800

    def apply(self, **_: object) -> None:
        """Change the anchors of the entries on the page."""
        if self.env.docname != PAGE:
            return
        for part in self.document.findall(nodes.section):
            for entry in part.children:
                if isinstance(entry, addnodes.index):
                    anchor = part["ids"][0]
                    entry["entries"] = [(e[0], e[1], anchor, *e[3:]) for e in entry["entries"]]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the change of the index."""
    app.add_transform(EntriesOfSections)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
