"""The table "Class by capability" of the guide says of each class what it does, and no more."""

from __future__ import annotations

import pickle
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import datasets, sphere
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable

PAGE = Path(__file__).parents[2] / "docs" / "guide" / "classes.rst"
SQUARE = [(0.0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
FLAT, SOLID = datasets.uniform(40), datasets.uniform(40, ndim=3)

MAKE: dict[str, Callable[[], Any]] = {
    "Delaunay 2-D": lambda: delone.Delaunay(FLAT, workers=2),
    "Delaunay 3-D": lambda: delone.Delaunay(SOLID, workers=2),
    "ConstrainedDelaunay": lambda: delone.ConstrainedDelaunay(*SQUARE, workers=2),
    "RegularTriangulation": lambda: delone.RegularTriangulation(FLAT, FLAT[:, 0], workers=2),
    "PeriodicDelaunay": lambda: delone.PeriodicDelaunay(FLAT, (2, None), workers=2),
    "Mesh": lambda: delone.mesh(SQUARE, max_area=0.05, workers=2),
    "TIN": lambda: TIN.from_points(np.column_stack((FLAT, FLAT[:, 0])), workers=2),
    "TetMesh": lambda: delone.improve(delone.Delaunay(SOLID, workers=2)),
    "ConvexHull": lambda: delone.ConvexHull(SOLID, workers=2),
    "Voronoi 2-D": lambda: delone.Voronoi(FLAT, clip="box", workers=2),
    "Voronoi 3-D": lambda: delone.Voronoi(SOLID, clip="box", workers=2),
    "Dynamic": lambda: delone.Dynamic(FLAT, workers=2),
    "AlphaComplex": lambda: delone.AlphaComplex(FLAT, workers=2),
    "sphere.Delaunay": lambda: sphere.Delaunay(lonlat=60 * FLAT, workers=2),
    "sphere.ConstrainedDelaunay": lambda: sphere.ConstrainedDelaunay(
        lonlat=60 * FLAT, segments=[(0, 1)], workers=2
    ),
    "sphere.Voronoi": lambda: sphere.Voronoi(lonlat=60 * FLAT, workers=2),
}
# Libraries of the exports, which may be missing.
NEEDS = {
    "plot": ("matplotlib", "pyvista"),
    "to_meshio": ("meshio",),
    "to_pyvista": ("pyvista",),
    "to_geopandas": ("geopandas",),
    "to_matplotlib": ("matplotlib",),
    "to_skfem": ("skfem",),
}


def table() -> dict[tuple[str, str], str]:
    """The cells of the table by capability and class."""
    text = PAGE.read_text(encoding="utf-8")
    rows = re.split(r"\n   \* - ", text[text.index("list-table") :].split("\n\na. ")[0])[1:]
    cells = [re.split(r"\n     - ", row.strip()) for row in rows]
    classes = cells[0][1:]
    assert classes == list(MAKE)
    return {
        (capability, name): cell
        for capabilities, *marks in cells[1:]
        for capability in capabilities.split(", ")
        for name, cell in zip(classes, marks, strict=True)
    }


TABLE = table()
CASES = [pytest.param(*case, id="-".join(case)) for case in TABLE]


def exercise(made: Any, capability: str, tmp_path: Path) -> None:
    """Use a capability, and look at what comes of it."""
    # Directions are three coordinates of what is drawn in 2-D.
    d = getattr(made, "ndim", 2)
    if capability == "save":
        made.save(tmp_path / "a.npz")
        assert (tmp_path / "a.npz").stat().st_size > 100
    elif capability == "load":
        made.save(tmp_path / "a.npz")
        again = type(made).load(tmp_path / "a.npz")
        assert repr(again) == repr(made)
        assert np.array_equal(again.points, made.points)
    elif capability == "pickle":
        assert repr(pickle.loads(pickle.dumps(made))) == repr(made)
    elif capability == "workers":
        assert made.workers in (2, None)
    elif capability == "validate":
        assert made.validate(), str(made.validate())
    elif capability == "plot":
        if d == 2:
            import matplotlib as mpl

            mpl.use("Agg")
        assert made.plot() is not None
    elif capability in ("find_simplex", "nearest"):
        assert (getattr(made, capability)(made.points[:3]) >= 0).all()
    elif capability == "locate":
        assert np.allclose(made.locate(made.points[:3]).closest, made.points[:3])
    elif capability in ("edges", "boundary", "circumcenters"):
        found = getattr(made, capability)
        assert found.ndim == 2
        assert len(found)
    else:
        assert getattr(made, capability)() is not None


@pytest.mark.parametrize(("capability", "name"), CASES)
def test_each_class_does_what_the_table_says(capability: str, name: str, tmp_path: Path) -> None:
    for library in NEEDS.get(capability, ()):
        pytest.importorskip(library)
    made = MAKE[name]()
    if TABLE[capability, name] == "yes":
        exercise(made, capability, tmp_path)
    else:
        method = "__reduce__" if capability == "pickle" else capability
        assert not hasattr(made, method)


def test_each_gap_has_a_reason() -> None:
    text = PAGE.read_text(encoding="utf-8")
    reasons = set(re.findall(r"^([a-z])\. ", text, re.MULTILINE))
    assert set(TABLE.values()) == {"yes"} | reasons


def test_each_class_has_a_column() -> None:
    public = {
        f"{before}{name}"
        for module, before in ((delone, ""), (sphere, "sphere."))
        for name in module.__all__
        if isinstance(getattr(module, name), type) and hasattr(getattr(module, name), "save")
    }
    # Cells and areas have no simplices, as the list above the table says.
    public -= {"Overlaps", "sphere.Grid", "sphere.Overlaps"}
    # Results, which other classes make.
    public -= {"AlphaShape", "ConcaveHull"}
    assert public | {"TIN", "Dynamic"} == {name.split()[0] for name in MAKE}
