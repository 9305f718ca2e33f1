"""The page of a class begins with a table of its attributes and methods, each with one sentence.

The table stands below the description of the class and above its parameters. It has what the page
has: public members with docstrings, also inherited ones, but not those of exceptions and tuples.
Classes with few members have none, and the members that `_templates/autosummary/class.rst` leaves
out are also left out here.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

FEWEST = 4
HIDDEN = {"EXTRAPOLATE", "gradients", "policies", "settled"}
# numpydoc writes the docstring at 500.
AFTER_NUMPYDOC = 900
# How the lines begin that numpydoc writes after the description.
SECTIONS = (":Parameters:", ":Attributes:", ":Returns:", ":Raises:", ".. rubric::", ".. seealso::")


def members(cls: type) -> tuple[list[str], list[str]]:
    """The names of attributes and of methods on the page of a class, in alphabetical order."""
    attributes, methods = [], []
    builtin = {name for base in (BaseException, tuple) for name in dir(base)}
    for name in sorted(dir(cls)):
        if name.startswith("_") or name in HIDDEN | builtin:
            continue
        member = inspect.getattr_static(cls, name)
        if not inspect.getdoc(getattr(cls, name, None)):
            continue
        if callable(member) or isinstance(member, classmethod | staticmethod):
            methods.append(name)
        else:
            attributes.append(name)
    return attributes, methods


def table(title: str, owner: str, names: list[str]) -> list[str]:
    """The lines of one table."""
    if not names:
        return []
    rows = [f"   ~{owner}.{name}" for name in names]
    return [f".. rubric:: {title}", "", ".. autosummary::", "   :nosignatures:", "", *rows, ""]


def _insert(*event: Any) -> None:
    app, _, name, obj, _, lines = event
    if not inspect.isclass(obj) or not app.env.docname.startswith("generated/"):
        return
    attributes, methods = members(obj)
    if len(attributes) + len(methods) < FEWEST:
        return
    # Names that begin with the current module are searched for in vain, with a warning.
    name = name.removeprefix(f"{app.env.ref_context.get('py:module')}.")
    found = [i for i, line in enumerate(lines) if line.startswith(SECTIONS)]
    at = found[0] if found else len(lines)
    lines[at:at] = [
        "",
        *table("Attributes", name, attributes),
        *table("Methods", name, methods),
    ]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the tables."""
    app.connect("autodoc-process-docstring", _insert, priority=AFTER_NUMPYDOC)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
