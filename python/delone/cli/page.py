"""A page of pictures and numbers in one HTML file that loads nothing.

Every text is escaped, because names of files and reference systems are not under our control, and
the page forbids scripts and everything that is not part of it.
"""

from __future__ import annotations

import base64
from html import escape
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import quote

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["Section", "page"]

_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; margin: 2rem auto;
  max-width: 60rem; padding: 0 1rem; }
h1 { font-size: 1.6rem; overflow-wrap: anywhere; } h2 { font-size: 1.2rem; margin-top: 2.5rem; }
table { border-collapse: collapse; margin: 1rem 0; }
th, td { text-align: left; padding: .2rem 1.5rem .2rem 0; border-bottom: 1px solid #ddd;
  vertical-align: top; overflow-wrap: anywhere; }
th { font-weight: normal; color: #555; white-space: nowrap; }
img { max-width: 100%; height: auto; } footer { margin-top: 3rem; color: #555; }
@media print { body { margin: 0; } section { break-inside: avoid; } }
"""
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


class Section(NamedTuple):
    """A part of a page: numbers, a picture with its alt text, and files next to the page."""

    title: str
    rows: Sequence[tuple[str, str]]
    picture: bytes | None = None
    alt: str = ""
    files: Sequence[str] = ()


def page(title: str, sections: Sequence[Section], foot: str) -> str:
    """Return the page as text that can be encoded in UTF-8."""
    parts = [
        "<!doctype html>",
        '<html lang="en">',
        "<head>",
        '<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{_text(title)}</title>",
        f"<style>{_STYLE}</style>",
        "</head>",
        "<body>",
        f"<h1>{_text(title)}</h1>",
        *(line for each in sections for line in _section(each)),
        f"<footer>{_text(foot)}</footer>",
        "</body>",
        "</html>",
    ]
    return "\n".join(parts) + "\n"


def _section(section: Section) -> list[str]:
    parts = ["<section>", f"<h2>{_text(section.title)}</h2>"]
    if section.picture is not None:
        data = base64.b64encode(section.picture).decode("ascii")
        parts.append(f'<img src="data:image/png;base64,{data}" alt="{_text(section.alt)}">')
    parts.append("<table>")
    parts += [
        f"<tr><th>{_text(name)}</th><td>{_text(value)}</td></tr>" for name, value in section.rows
    ]
    parts += [
        f'<tr><th>file</th><td><a href="./{_link(name)}">{_text(name)}</a></td></tr>'
        for name in section.files
    ]
    return [*parts, "</table>", "</section>"]


def _plain(text: str) -> str:
    """Replace what is not Unicode, such as bytes in file names."""
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def _text(text: str) -> str:
    return escape(_plain(text))


def _link(name: str) -> str:
    return escape(quote(name.encode("utf-8", "surrogateescape"), safe=""))
