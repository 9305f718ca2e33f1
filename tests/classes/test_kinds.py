"""A public name is a property in all classes or a method in all, with one signature."""

from __future__ import annotations

import functools
import importlib
import inspect
from collections import defaultdict
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

import delone
from delone import distributed, interpolate, io, sphere, terrain
from delone._base.renames import Renamed
from delone._tiling import location
from delone._tiling.dimension import _Only
from delone.terrain import TIN

# Names of tuples, which named tuples have.
TUPLE = set(dir(tuple))
# Where a user finds classes; `delone.compat` has the names of other libraries.
PUBLIC = (
    "alpha",
    "cluster",
    "datasets",
    "distributed",
    "dynamic",
    "graphs",
    "interpolate",
    "io",
    "sphere",
    "terrain",
    "validation",
    "voronoi",
    "xarray",
)


def classes() -> dict[type, str]:
    """The public classes, by what a user writes."""
    found: dict[type, str] = {}
    for module in ("delone", *(f"delone.{name}" for name in PUBLIC)):
        whole = importlib.import_module(module)
        for name in whole.__all__:
            value = getattr(whole, name)
            if isinstance(value, type) and not issubclass(value, BaseException):
                found.setdefault(value, f"{module}.{name}")
    return found


CLASSES = classes()


def kind_of(owner: type, name: str) -> str | None:
    """Whether an attribute of a class is a property or a method; None if it is neither."""
    value = inspect.getattr_static(owner, name)
    if isinstance(value, Renamed):
        return None
    if isinstance(value, _Only):
        value = value._method
    if isinstance(value, property | functools.cached_property):
        return "property"
    if inspect.isdatadescriptor(value) or type(value).__name__ == "_tuplegetter":
        return "property"
    if isinstance(value, classmethod | staticmethod) or inspect.isfunction(value):
        return "method"
    return "property"


def members() -> dict[str, dict[str, list[type]]]:
    """The public names of all classes, with the classes by kind."""
    found: dict[str, dict[str, list[type]]] = defaultdict(lambda: defaultdict(list))
    for owner in CLASSES:
        declared = {each.name for each in fields(owner)} if is_dataclass(owner) else set()
        names = {name for name in dir(owner) if not name.startswith("_")}
        # `getattr` of a renamed attribute raises, so `dir` lists it and nothing else does.
        for name in names - TUPLE - declared:
            if (kind := kind_of(owner, name)) is not None:
                found[name][kind].append(owner)
        for name in declared:
            found[name]["property"].append(owner)
    return found


MEMBERS = members()


def test_the_walk_sees_the_classes() -> None:
    assert {delone.Delaunay, TIN, interpolate.Linear, sphere.Voronoi} <= set(CLASSES)
    assert all(MEMBERS[name] for name in ("save", "simplices", "closest"))
    assert len(CLASSES) > 50


def test_a_name_is_a_property_or_a_method() -> None:
    wrong = {
        name: {kind: [CLASSES[owner] for owner in owners] for kind, owners in kinds.items()}
        for name, kinds in MEMBERS.items()
        if len(kinds) > 1
    }
    assert not wrong


def signature(owner: type, name: str) -> tuple[list[str], dict[str, Any]]:
    """The positional parameters of a method, and the defaults of all that have one."""
    given = [
        each
        for each in inspect.signature(getattr(owner, name)).parameters.values()
        if each.name not in ("self", "cls")
    ]
    by_name = inspect.Parameter.KEYWORD_ONLY, inspect.Parameter.VAR_KEYWORD
    positional = [each.name for each in given if each.kind not in by_name]
    defaults = {each.name: each.default for each in given if each.default is not each.empty}
    return positional, defaults


def test_a_method_has_one_signature() -> None:
    """Positional parameters are the same; one of two classes has one default.

    A class may take further keywords, such as the `step` of arcs on the sphere.
    """
    wrong = []
    for name, kinds in MEMBERS.items():
        owners = kinds.get("method", [])
        found = {CLASSES[owner]: signature(owner, name) for owner in owners}
        if len({str(positional) for positional, _ in found.values()}) > 1:
            wrong.append((name, {each: positional for each, (positional, _) in found.items()}))
        values: dict[str, set[str]] = defaultdict(set)
        for _, defaults in found.values():
            for each, default in defaults.items():
                values[each].add(repr(default))
        wrong += [(name, each, many) for each, many in values.items() if len(many) > 1]
    assert not wrong


@pytest.mark.parametrize(
    ("owner", "old", "new"),
    [
        (TIN, "volume", "volume_to"),
        (TIN, "gradient", "gradients"),
        (delone.ConstrainedDelaunay, "polygon", "polygon_of_simplex"),
        (sphere.ConstrainedDelaunay, "polygon", "polygon_of_simplex"),
        (interpolate.Linear, "weights", "weights_at"),
        (sphere.NaturalNeighbor, "weights", "weights_at"),
        (interpolate.Grid, "cell", "cell_size"),
        (delone.Dynamic, "corners", "corners_at"),
        (distributed.TiledDelaunay, "simplices", "read_simplices"),
        (distributed.Plan, "tiles", "ntiles"),
        (distributed.Progress, "tiles", "ntiles"),
        (interpolate.Weights, "shape", "query_shape"),
        (io.GeometrySet, "coordinates", "all_points"),
        (io.GeometrySet, "heights", "feature_heights"),
        (terrain.Bands, "rings", "ring_starts"),
        (terrain.Bands, "polygons", "polygon_starts"),
        (terrain.Profile, "distance", "distances"),
        (location.Location, "nearest", "closest"),
    ],
)
def test_an_old_name_says_the_new_one(owner: type, old: str, new: str) -> None:
    assert hasattr(owner, new) or new in owner.__annotations__
    assert not hasattr(owner, old)
    with pytest.raises(AttributeError, match=f"{owner.__name__}.{old} is now .*{new}$"):
        getattr(owner, old)


def test_an_old_name_of_an_object() -> None:
    surface = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
    with pytest.raises(AttributeError, match=r"is now TIN\.volume_to"):
        surface.volume(0)  # type: ignore[attr-defined]
    assert not hasattr(surface, "volume")


def test_columns_of_tables_have_one_row_for_each_shape() -> None:
    pytest.importorskip("geopandas")
    square = np.array([(0.0, 0, 0), (4, 0, 4), (4, 4, 8), (0, 4, 4)])
    surface = TIN.from_points(square)
    made = {
        "triangles": delone.Delaunay(square[:, :2]),
        "edges": delone.graphs.Graph(square[:, :2], [(0, 1)]),
        "points": delone.Voronoi(square[:, :2], clip="box"),
        "lines": surface.contours(interval=3),
        "polygons": surface.bands([3.0]),
    }
    for of, each in made.items():
        count = len(each.to_geopandas())
        table = each.to_geopandas({"name": list("abcdef"[:count])}, crs="EPSG:28992")
        assert table["name"].tolist() == list("abcdef"[:count])
        assert table.crs.to_epsg() == 28992
        # The reference system and the index of a GeoDataFrame are kept.
        table.index = table.index + 7
        again = each.to_geopandas(table[["name", "geometry"]])
        assert again.crs == table.crs
        assert again.index.tolist() == table.index.tolist()
        with pytest.raises(delone.InputError, match=f"data has 9 rows for {count} {of}"):
            each.to_geopandas({"name": [0] * 9})
    with pytest.raises(delone.InputError, match="data has a column 'v0'"):
        made["edges"].to_geopandas({"v0": [1]})


def test_no_constructor_takes_anything() -> None:
    wrong = []
    for owner, name in CLASSES.items():
        kinds = [each.kind for each in inspect.signature(owner).parameters.values()]
        if inspect.Parameter.VAR_POSITIONAL in kinds:
            wrong.append(name)
    assert not wrong


@pytest.mark.parametrize(
    "owner", [TIN, delone.Mesh, delone.TetMesh, delone.AlphaShape, delone.ConcaveHull]
)
def test_classes_that_functions_make_say_so(owner: type) -> None:
    assert not inspect.signature(owner).parameters
    for given in ((), ([(0, 0), (1, 0), (0, 1)],)):
        with pytest.raises(delone.DtypeError, match=f"create an? {owner.__name__} with"):
            owner(*given)


def test_contours_are_lines_at_their_heights() -> None:
    hill = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)])
    contours = hill.contours(interval=1)
    parts = contours._parts()
    ends = parts.points[parts.simplices]
    assert (ends[..., 2] == parts.of_simplices["level"][:, None]).all()
    for line in range(len(contours)):
        pieces = ends[parts.of_simplices["line"] == line][..., :2]
        run = contours.coordinates(line)
        assert np.array_equal(pieces, np.stack((run[:-1], run[1:]), axis=1))
    assert not len(hill.contours([99.0])._parts().simplices)
    if pytest.importorskip("meshio"):
        assert len(contours.to_meshio().cells_dict["line"]) == len(ends)
