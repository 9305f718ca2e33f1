"""What the pages say is missing is still missing, and every public name is on a page.

A sentence such as "is not supported" becomes false when the feature is added, and no other test
notices. Each is listed here with the reason why it holds; a new one fails until it is listed, and
so does an entry whose sentence is gone.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone import graphs, interpolate, sphere
from delone.io import output_suffixes

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
GENERATED = {"_build", "generated", "gallery", "_templates"}
ABSENT = re.compile(
    r"not covered|not in delone|(?:build|built) (?:it )?again|(?:are|still|is) planar"
    r"|project them first|not there\b|do not exist|no release|no [\w -]+ yet\b|only available"
    r"|not (?:yet )?(?:supported|available|possible|implemented|provided|offered)"
    r"|\bno class\b|^none\b(?! of)|do(?:es)? not support\b",
    re.IGNORECASE,
)
# Sessions are run as tests, messages included.
SESSION = re.compile(r"^ *>>> .*?(?=\n *\n|\Z)", re.MULTILINE | re.DOTALL)
SENTENCE = re.compile(r"(?<=[.!?;])\s+")

# The page and a part of the sentence, and why it holds.
ABSENCES: dict[tuple[str, str], str] = {
    ("coming_from/tobler.rst", "auxiliary data, regression"): "statistics, not geometry",
    ("README.md", "There is no release yet"): "CONTRIBUTING.md says what the first release changes",
    (
        "getting_started.rst",
        "There is no release yet",
    ): "CONTRIBUTING.md says what the first release changes",
    (
        "decisions/no-crate-for-rust.rst",
        "No public crate for Rust",
    ): "the crates are not published: the page says why",
    ("index.rst", "There is no release yet"): "CONTRIBUTING.md says what the first release changes",
    (
        "coming_from/cgal.rst",
        "Meshes from images or implicit functions",
    ): "surfaces are given as triangles, and divided, not remeshed",
    (
        "coming_from/cgal.rst",
        "More than eight dimensions",
    ): "cells of each dimension are compiled, and grow a hundredfold from 4-D to 8-D",
    (
        "coming_from/cgal.rst",
        "Periodic triangulations in 3-D",
    ): "PeriodicDelaunay takes points with two coordinates",
    ("coming_from/cgal.rst", "segments and circles"): "Voronoi takes points",
    (
        "coming_from/cgal.rst",
        "Regular and surface neighbor coordinates",
    ): "NaturalNeighbor takes no weights and no surface",
    ("coming_from/cgal.rst", "Exact coordinates"): "arrays hold doubles",
    (
        "coming_from/matlab.rst",
        "no class",
    ): "a triangulation is computed from points; validate checks others, improve takes tetrahedra",
    (
        "guide/higher.rst",
        "plot, export, or measure angles",
    ): "no library plots or stores simplices of 4-D or more",
    (
        "guide/higher.rst",
        "cell volumes, clipping and weights",
    ): "cells from 4-D on have no measures, and Voronoi rejects a clip and weights there",
    (
        "guide/higher.rst",
        "Alpha shapes, graphs and ``Dynamic``",
    ): "their classes accept two or three coordinates",
    ("coming_from/matlab.rst", '"v4"'): "there are no radial basis functions",
    ("coming_from/scipy.rst", "``RBFInterpolator``"): "they need no triangulation",
    (
        "coming_from/scipy.rst",
        "more than eight coordinates",
    ): "cells of each dimension are compiled, and grow a hundredfold from 4-D to 8-D",
    (
        "coming_from/startinpy.rst",
        "insertionstrategy",
    ): "the order of insertion is chosen by the core",
    ("coming_from/startinpy.rst", "IDW"): "it needs no triangulation",
    ("coming_from/stripy.rst", "smoothing"): "sphere has neither smoothing nor regular meshes",
    ("coming_from/tetgen.rst", "``M``, ``O``: none"): "faces are kept exactly; improve optimizes",
    ("coming_from/tetgen.rst", "STEP, IGES"): "there is no geometry kernel",
    ("coming_from/tetgen.rst", "curved boundaries"): "edges are straight",
    ("coming_from/tetgen.rst", "hexahedral meshes"): "cells are triangles and tetrahedra",
    ("coming_from/tetgen.rst", "``setPeriodic``"): "mesh takes no periods",
    ("coming_from/networkx.rst", "shortest paths"): "graphs are made here, not analyzed",
    (
        "coming_from/scikit_learn.rst",
        "approximate_predict",
    ): "HDBSCAN has labels, probabilities and the condensed tree",
    ("coming_from/scikit_learn.rst", "other metrics"): "distances are Euclidean",
    ("coming_from/shapely.rst", "buffers, unions"): "geometries are triangulated, not changed",
    ("releasing.rst", "no release"): "the sentence says what the check looks for",
    ("coming_from/triangle.rst", "``X``: none"): "arithmetic is always exact",
    ("guide/compat.rst", "``QbB``"): "nothing is scaled",
    ("guide/compat.rst", "``C-0``, ``A-1``"): "there is no tolerance to merge facets",
    ("guide/compat.rst", "``QJ``"): "nothing is rounded",
    ("guide/compat.rst", "attributes ``tree``"): "they belong to SciPy's implementation",
    (
        "guide/georeference.rst",
        "Computations in delone are planar",
    ): "the sentence names the exception, delone.sphere",
    ("guide/georeference.rst", "still planar"): "a period does not change distances",
    ("guide/improve.rst", "next to the hull"): "the boundary is kept",
    ("guide/interpolate.rst", '``"sibson1"``: none'): "delone.sphere has no such class",
    ("guide/interpolate.rst", "only available in 2-D"): "the error of the interpolators says so",
    (
        "guide/space.rst",
        "``volumes`` are only available",
    ): "an area needs two coordinates, a volume three",
    (
        "guide/sphere.rst",
        "not available: project to meters",
    ): "delone.sphere has no such functions, and graphs refuse directions",
    ("guide/terrain.rst", "project them first"): "a TIN has slopes and volumes in one unit",
    ("guide/interpolate.rst", ":class:`CloughTocher`: none"): "delone.sphere has no such class",
    (
        "guide/higher.rst",
        "measures, clipping, weights or periods",
    ): "cells from 4-D on have no measures, and Voronoi rejects the arguments",
}


def pages() -> dict[str, Path]:
    """README.md and the pages, without what a build generates and without the proofs."""
    found = {"README.md": ROOT / "README.md"}
    for path in sorted(DOCS.rglob("*.rst")):
        folders = path.relative_to(DOCS).parts
        if not (GENERATED | {"mathematics"}) & set(folders):
            found[path.relative_to(DOCS).as_posix()] = path
    return found


def sentences(text: str) -> list[str]:
    """The sentences that say that something is missing, with single blanks.

    In a table, each begins with the first cell of its row. All entries under a heading "Not in
    delone" are such sentences.
    """
    text, _, rest = SESSION.sub("", text).partition("\nNot in delone\n")
    listed, _, after = rest.lstrip("-\n").partition("\n\n")
    found = [" ".join(part.split()) for part in re.split(r"^- ", listed, flags=re.M) if part]
    for block in re.split(r"\n\s*\n", text + "\n\n" + after):
        for row in re.split(r"^(?= *\* - )", block, flags=re.MULTILINE):
            first, *cells = re.split(r"^ *(?:\* )?-(?: |$)", row, flags=re.MULTILINE)
            table = row.lstrip().startswith("* -")
            title = " ".join(cells[0].split()) + ": " if table else ""
            for part in (first, *cells):
                for sentence in SENTENCE.split(" ".join(part.split())):
                    if ABSENT.search(sentence):
                        found.append(title + sentence)
    return found


FOUND = [
    (name, sentence)
    for name, path in pages().items()
    for sentence in sentences(path.read_text(encoding="utf-8"))
]


@pytest.mark.parametrize("name, sentence", FOUND)
def test_every_absence_has_a_reason(name: str, sentence: str) -> None:
    reasons = [why for (page, part), why in ABSENCES.items() if page == name and part in sentence]
    assert reasons, f"{name}: list this with the reason why it holds, or mend it: {sentence!r}"


def test_no_reason_is_left_over() -> None:
    gone = [
        key
        for key in ABSENCES
        if not any(key[0] == name and key[1] in sentence for name, sentence in FOUND)
    ]
    assert not gone


def test_an_absence_is_found() -> None:
    """Also where a line is broken, in a cell of a table, and under the heading of a list."""
    table = "   * - splines\n     - not\n       covered\n   * - lines\n     - :class:`Line`"
    text = f"A page.\n\n{table}\n\nNot in delone\n-------------\n\n- Knots.\n\nThey are planar.\n"
    assert sentences(text) == ["Knots.", "splines: not covered", "They are planar."]


def test_every_public_name_is_on_a_page() -> None:
    text = "\n".join(
        path.read_text(encoding="utf-8")
        for name, path in pages().items()
        if name.startswith(("coming_from/", "guide/"))
    )
    words = set(re.findall(r"\w+", text))
    assert [name for name in delone.__all__ if name not in words | {"__version__"}] == []


@pytest.mark.parametrize(
    ("ndim", "call", "why"),
    [
        pytest.param(9, delone.Delaunay, "d from 2 to 8", id="nine-dimensions"),
        pytest.param(
            4,
            lambda p: delone.Voronoi(p, clip=((0,) * 4, (1,) * 4)),
            "clip is only available in 2-D and 3-D",
            id="clipped-cells-4-D",
        ),
        pytest.param(
            4,
            lambda p: delone.Voronoi(p, weights=np.zeros(len(p))),
            "weights are only available in 2-D and 3-D",
            id="weighted-cells-4-D",
        ),
        pytest.param(
            4,
            lambda p: delone.Delaunay(p).locate(p, tolerance=1.0),
            "tolerance",
            id="tolerance-4-D",
        ),
        pytest.param(
            4,
            lambda p: delone.concave_hull(p, ratio=0.5),
            r"\(n, 2\) or \(n, 3\)",
            id="concave-hull-4-D",
        ),
        pytest.param(4, delone.Dynamic, r"\(n, 2\) or \(n, 3\)", id="dynamic-4-D"),
        pytest.param(4, graphs.gabriel, r"\(n, 2\) or \(n, 3\)", id="graph-4-D"),
        pytest.param(
            3,
            lambda p: delone.PeriodicDelaunay(p, periods=(1, 1, 1)),
            r"shape \(n, 2\)",
            id="periodic-3-D",
        ),
        pytest.param(
            3,
            lambda p: delone.Voronoi(p, periods=(1, 1, 1)),
            "periods are only available in 2-D",
            id="periodic-cells-3-D",
        ),
        pytest.param(
            3,
            lambda p: interpolate.CloughTocher(p, p[:, 0]),
            "only available in 2-D",
            id="clough-tocher-3-D",
        ),
        pytest.param(
            3,
            lambda p: interpolate.NaturalNeighbor(p, p[:, 0]),
            "only available in 2-D",
            id="sibson-3-D",
        ),
        pytest.param(
            3,
            lambda p: graphs.gabriel(sphere.Delaunay(xyz=p)),
            "not available on the sphere",
            id="graph-on-the-sphere",
        ),
        pytest.param(
            3, lambda p: interpolate.interpolator(p, p[:, 0], "idw"), "got 'idw'", id="idw"
        ),
    ],
)
def test_what_is_said_to_be_missing_raises(
    ndim: int, call: Callable[[np.ndarray], object], why: str
) -> None:
    """For the reason that is given: another error would hide that it exists by now."""
    with pytest.raises(delone.InputError, match=why):
        call(np.random.default_rng(0).random((30, ndim)))


def test_options_that_are_said_to_be_missing_are_missing() -> None:
    assert not {"CloughTocher", "TIN", "mesh", "smooth"} & set(sphere.__all__)
    assert ".city.json" not in output_suffixes()
