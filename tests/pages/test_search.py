"""Words that users search for lead to a page: to a title, an entry of the index, or a cell.

The search of the site compares stems of words with the text of pages, and shows titles and entries
of the index first. Where a feature does not exist, the page "How do I ...?" says which tool has it.
`docs/check_site.py` looks the words up in the built index; here, they must be in the sources.
"""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

import delone

DOCS = Path(__file__).parents[2] / "docs"
HOWTO = (DOCS / "howto.rst").read_text(encoding="utf-8")


def load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


CHECK = load(DOCS / "check_site.py")


@pytest.fixture(scope="module")
def questions() -> ModuleType:
    return load(DOCS / "extensions" / "questions.py")


@pytest.mark.parametrize(("term", "page"), CHECK.TERMS.items(), ids=CHECK.TERMS)
def test_a_term_is_on_its_page(term: str, page: str, questions: ModuleType) -> None:
    """On the page of questions, in a title or an entry of the index."""
    text = (DOCS / page).with_suffix(".rst").read_text(encoding="utf-8")
    if page != "howto":
        assert term.lower() in text.lower()
        return
    read = questions.sections(text)
    titles = re.findall(r"^(.+)\n\^+$", read, re.MULTILINE)
    entries = re.findall(r"^\.\. index:: ! (.+)$", read, re.MULTILINE)
    assert any(term.lower() in each.lower() for each in [*titles, *entries])


def test_each_question_is_a_section_with_a_text(questions: ModuleType) -> None:
    read = questions.sections(HOWTO)
    titles = re.findall(r"^(.+)\n(\^+)$", read, re.MULTILINE)
    assert len(titles) == HOWTO.count("\n... ") > 150
    assert all(len(line) == len(title) for title, line in titles)
    assert len({title for title, _ in titles}) == len(titles)
    assert "\n... " not in read and ":index:" not in read
    bodies = re.split(r"^.+\n\^+\n", read, flags=re.MULTILINE)[1:]
    assert all(re.sub(r"^\.\. index.*$", "", body, flags=re.M).strip() for body in bodies)


def test_a_question_keeps_its_words(questions: ModuleType) -> None:
    text = (
        "... compute a :index:`!hull`\n(:class:`~delone.ConvexHull`)?\n   ``a``;\n   b\n\n"
        "   second\n\n... next?\n   c\n"
    )
    assert questions.sections(text) == (
        "Compute a hull (``ConvexHull``)\n^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\n\n.. index:: ! hull\n\n"
        "``a``;\nb\n\nsecond\n\n\nNext\n^^^^\n\n\nc\n\n"
    )


def test_the_index_is_read_as_the_search_does() -> None:
    """All words of a term on one page, in the text or in titles; or an entry with the term."""
    index = {
        "docnames": ["a", "b", "c"],
        "terms": {"geodes": 0, "accumul": [0, 1], "flow": 1, "simplifi": 0},
        "titleterms": {"gpu": 2},
        "indexentries": {"blue noise": [[2, "index-1", True]]},
    }
    assert CHECK.found(index, "geodesic") == {"a"} == CHECK.found(index, "simplify")
    assert CHECK.found(index, "flow accumulation") == {"b"}
    assert CHECK.found(index, "GPU") == {"c"} == CHECK.found(index, "blue noise")
    assert CHECK.found(index, "zarr") == CHECK.found(index, "flowing water") == set()


def test_tables_of_members_have_what_a_page_has() -> None:
    members = load(DOCS / "extensions" / "member_tables.py").members
    attributes, methods = members(delone.Delaunay)
    assert {"areas", "simplices"} <= set(attributes) and {"find_simplex", "load"} <= set(methods)
    assert not set(attributes) & set(methods) and attributes == sorted(attributes)
    error = [name for names in members(delone.InputError) for name in names]
    assert not {"args", "with_traceback", "add_note"} & set(error)
