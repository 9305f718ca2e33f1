"""Two real surveys and the land of the Earth, with their credits in CREDITS.md.

The files contain integer columns in NumPy's format, so that only NumPy is needed to read them; the
results are the doubles nearest to the surveyed decimals.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import frozen
from delone._base.counting import counted

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import DTypeLike, NDArray

__all__ = ["Sample", "ahn3", "baja", "land"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Sample:
    """A real survey: points with heights, and their origin.

    Parameters
    ----------
    name : str
        Title of the survey.
    points : ndarray of float64, shape (n, 2)
        Horizontal coordinates, read-only.
    z : ndarray of float64, shape (n,)
        Heights in meters, read-only.
    attributes : mapping of str to ndarray
        Other values of each point.
    crs : str
        Authority and code of the coordinate reference system, such as ``"EPSG:28992"``.
    credit : str
        The required credit, and the license.

    Notes
    -----
    A Sample can be passed wherever points are expected; NumPy converts it to `points`.
    """

    name: str
    points: NDArray[np.float64]
    z: NDArray[np.float64]
    attributes: Mapping[str, NDArray[Any]]
    crs: str
    credit: str

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """The horizontal coordinates."""
        found = self.points if dtype is None else self.points.astype(dtype, copy=False)
        return found.copy() if copy else found

    def __repr__(self) -> str:
        return f"<Sample {self.name!r} of {counted(len(self.points), 'point')}, {self.crs}>"


def ahn3() -> Sample:
    """Return airborne lidar points of 100 m by 100 m of the Dutch coast.

    Returns
    -------
    Sample
        212,550 points, all distinct in 2-D; coordinates are whole millimeters, as nearest doubles.
        Attribute ``classification``: 2 ground, 6 building.

    Examples
    --------
    >>> from delone.datasets import ahn3
    >>> sample = ahn3()
    >>> sample.points.shape, sample.crs
    ((212550, 2), 'EPSG:28992')
    """
    columns = _columns("ahn3.npz")
    return Sample(
        name="AHN3, a crop of 100 m by 100 m",
        points=frozen(np.column_stack((columns["x"], columns["y"])) / 1000),
        z=frozen(columns["z"] / 1000),
        attributes=MappingProxyType({"classification": frozen(columns["classification"])}),
        crs="EPSG:28992",
        credit="Actueel Hoogtebestand Nederland (AHN3), CC0; crop by Hugo Ledoux (sst), MIT",
    )


def baja() -> Sample:
    """Return ship soundings off Baja California: dense along the tracks, empty between.

    Returns
    -------
    Sample
        82,970 points in degrees east and north, 80,983 of them distinct; heights are negative
        depths. No attributes.

    Examples
    --------
    >>> from delone.datasets import baja
    >>> sample = baja()
    >>> sample.points.shape, float(sample.z.min())
    ((82970, 2), -7708.0)
    """
    columns = _columns("baja.npz")
    return Sample(
        name="Soundings off Baja California",
        points=frozen(np.column_stack((columns["x"], columns["y"])) / 100_000),
        z=frozen(columns["z"].astype(np.float64)),
        attributes=MappingProxyType({}),
        crs="EPSG:4326",
        credit="NOAA and the GMT tutorial, public domain; file by the Verde Developers, BSD-3",
    )


def land() -> dict[str, Any]:
    """Return the land of the Earth at 1:110 million, from Natural Earth (public domain).

    Returns
    -------
    dict
        A GeoJSON-like multipolygon, which shapely and `delone.sphere.from_geometry` accept:
        ``"coordinates"`` contains for each polygon its rings of (longitude, latitude) in degrees,
        the outer one counter-clockwise. Polygons end at the date line; Antarctica also has an edge
        at the pole. The largest ones come first.

    Examples
    --------
    >>> from delone.datasets import land
    >>> polygons = land()["coordinates"]
    >>> len(polygons), [len(ring) for ring in polygons[0]]
    (127, [1303, 52])
    """
    columns = _columns("land.npz")
    corners = (np.column_stack((columns["x"], columns["y"])) / 1000).tolist()
    starts = columns["starts"].tolist()
    polygons: list[list[list[list[float]]]] = []
    for begin, end, outer in zip(starts[:-1], starts[1:], columns["outer"], strict=True):
        if outer:
            polygons.append([])
        polygons[-1].append([*corners[begin:end], corners[begin]])
    return {"type": "MultiPolygon", "coordinates": polygons}


def _columns(name: str) -> dict[str, NDArray[np.integer]]:
    """Read integer columns; x, y and z are stored as differences, which compress better."""
    with (files(__package__) / name).open("rb") as file, np.load(file) as archive:
        columns: dict[str, NDArray[np.integer]] = {key: archive[key] for key in archive.files}
    for key in columns.keys() & set("xyz"):
        columns[key] = np.cumsum(columns[key], dtype=np.int64)
    return columns
