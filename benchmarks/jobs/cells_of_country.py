"""Voronoi cells of stations, cut to the border of a country, written as a GeoPackage.

python benchmarks/jobs/cells_of_country.py ne_110m_admin_0_countries.geojson --country Brazil
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from sidebyside import compare, stage

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np


def _input(given: argparse.Namespace) -> tuple[Any, np.ndarray]:
    """The largest part of a country, and stations inside it."""
    with stage("read"):
        import geopandas
        import numpy as np
        import shapely

        frame = geopandas.read_file(given.file)
        parts = shapely.get_parts(frame[given.country == frame["NAME"]].geometry.iloc[0])
        border = parts[np.argmax(shapely.area(parts))]
        low, high = np.array(border.bounds).reshape(2, 2)
        random = np.random.default_rng(0)
        points = low + (high - low) * random.random((3 * given.stations, 2))
        shapely.prepare(border)
        return border, points[shapely.contains_xy(border, points)][: given.stations]


def delone(given: argparse.Namespace, folder: Path) -> str:
    border, points = _input(given)
    with stage("import"):
        from delone import Voronoi
    with stage("cells"):
        cells = Voronoi(points, clip=border, planar=True).polygons()
    return _written(cells, folder)


def shapely(given: argparse.Namespace, folder: Path) -> str:
    border, points = _input(given)
    with stage("cells"):
        import shapely as package

        found = package.voronoi_polygons(package.MultiPoint(points), extend_to=border, ordered=True)
        cells = package.intersection(package.get_parts(found), border)
    return _written(cells, folder)


def geovoronoi(given: argparse.Namespace, folder: Path) -> str:
    border, points = _input(given)
    with stage("import"):
        from geovoronoi import voronoi_regions_from_coords
    with stage("cells"):
        found, _ = voronoi_regions_from_coords(points, border)
    return _written(list(found.values()), folder)


def _written(cells: Any, folder: Path) -> str:
    with stage("write"):
        import geopandas

        frame = geopandas.GeoDataFrame(geometry=list(cells), crs="EPSG:4326")
        frame.to_file(folder / "cells.gpkg")
    return f"{len(frame):,} cells, area {frame.geometry.values.area.sum():.6f}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("file", help="GeoJSON of countries, with their NAME")
    parser.add_argument("--country", default="Brazil")
    parser.add_argument("--stations", type=int, default=10_000)
    compare(__doc__, {"delone": delone, "shapely": shapely, "geovoronoi": geovoronoi}, parser)
