"""The page "How do I ...?": each question becomes a section, so that the search finds it by itself.

In the source the questions are the terms of definition lists, ``... compute a convex hull?``, with
roles ``:index:`` for the words that users look for. Sphinx shows sections, not terms, as results of
a search, with a title and the text below it. So before the page is read, ``... compute a convex
hull?`` becomes the title "Compute a convex hull", and the words become entries of the index, which
lead to the section itself (`question_index.py`); `_static/search_titles.js` names results of the
search after it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PAGE = "howto"
# A term may be broken; its answer is indented.
QUESTION = re.compile(
    r"^\.\.\. (?P<term>(?:.+\n)+?)(?P<answer>(?: {3}.*\n|\n(?= {3}\S))+)", re.MULTILINE
)
WORD = re.compile(r":index:`!?([^`]+)`")
OTHER_ROLE = re.compile(r":(?:class|mod|meth|func):`~?(?:delone\.)?([^`]+)`")


def section(match: re.Match[str]) -> str:
    """A question and its answer as a section."""
    term = " ".join(match["term"].split())
    title = OTHER_ROLE.sub(r"``\1``", WORD.sub(r"\1", term)).removesuffix("?")
    title = title[0].upper() + title[1:]
    words = "".join(f".. index:: ! {word}\n" for word in WORD.findall(term))
    answer = re.sub(r"^ {3}", "", match["answer"], flags=re.MULTILINE)
    return f"{title}\n{'^' * len(title)}\n\n{words}\n{answer}\n"


def sections(text: str) -> str:
    """The source of the page with a section for each question."""
    return QUESTION.sub(section, text)


def _read(app: Sphinx, page: str, source: list[str]) -> None:
    if page == PAGE:
        source[0] = sections(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the change of the page."""
    app.connect("source-read", _read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
