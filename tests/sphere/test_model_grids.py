"""Grids of the sphere as models write them: every cell a vertex, fields interpolated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from delone import sphere

GRIDS = Path(__file__).parents[3] / "shared" / "data" / "climate"
pytestmark = pytest.mark.skipif(not GRIDS.is_dir(), reason="needs the grids of models")


def variables(name, *wanted):
    netcdf = pytest.importorskip("netCDF4")
    with netcdf.Dataset(GRIDS / name) as file:
        return [np.asarray(file[each][:], dtype=float) for each in wanted]


def pairs(name, *wanted):
    return np.column_stack([each.ravel() for each in variables(name, *wanted)])


def fesom():
    return np.loadtxt(GRIDS / "fesom_pi_nod2d.out", skiprows=1)[:, 1:3]


def regular():
    lon, lat = np.meshgrid(np.arange(360) + 0.5, np.arange(180) - 89.5)
    return np.column_stack((lon.ravel(), lat.ravel()))


def healpix(side=32):
    """Centers of the cells of HEALPix, ring by ring (Gorski et al., 2005)."""
    rings = []
    for ring in range(1, 4 * side):
        near = min(ring, 4 * side - ring)
        cap = near < side
        count = 4 * min(near, side)
        z = 1 - near**2 / (3 * side**2) if cap else 4 / 3 - 2 * near / (3 * side)
        shift = 0.5 if cap or (near - side) % 2 == 0 else 0.0
        lon = (np.arange(count) + shift) * 360 / count
        lat = np.degrees(np.arcsin(z)) * (1 if ring <= 2 * side else -1)
        rings.append(np.column_stack((lon, np.full(count, lat))))
    return np.vstack(rings)


MPAS = "mpas_QU_mesh.QU.1920km.151026.nc"
CENTERS = ("grid_center_lon", "grid_center_lat")
DEGREES = {
    "ESMF ne30pg3": lambda: variables("esmf_ne30_ne30pg3.grid.nc", "centerCoords")[0],
    "SCRIP ne30pg2": lambda: pairs("scrip_ne30pg2_grid.nc", *CENTERS),
    "SCRIP ne8": lambda: pairs("scrip_outCSne8_outCSne8.nc", *CENTERS),
    "UGRID ne30": lambda: pairs("ugrid_outCSne30_outCSne30.ug", "Mesh2_node_x", "Mesh2_node_y"),
    "FESOM": fesom,
    "RLL 1 degree": regular,
    "HEALPix 32": healpix,
}
RADIANS = {
    "MPAS cells": lambda: pairs(MPAS, "lonCell", "latCell"),
    "MPAS vertices": lambda: pairs(MPAS, "lonVertex", "latVertex"),
}
KINDS = (sphere.Linear, sphere.NaturalNeighbor, sphere.Nearest)


def harmonic(xyz):
    x, y, z = np.asarray(xyz).T
    return 1.0 + x * y + z * (x * x - y * y) + 0.5 * (3 * z * z - 1)


def scattered(count):
    xyz = np.random.default_rng(0).normal(size=(count, 3))
    return xyz / np.linalg.norm(xyz, axis=1, keepdims=True)


@pytest.mark.parametrize("name", [*DEGREES, *RADIANS])
def test_all_cells_are_vertices_and_cover_the_sphere(name):
    sites = (DEGREES | RADIANS)[name]()
    mesh = sphere.Delaunay(lonlat=sites, degrees=name in DEGREES)
    assert not len(mesh.duplicates) and mesh.covers_sphere
    assert (np.unique(mesh.simplices) == np.arange(len(sites))).all()
    assert mesh.nsimplex == 2 * len(sites) - 4
    assert (mesh.areas > 0).all()
    assert mesh.areas.sum() == pytest.approx(4 * np.pi, rel=1e-13)


@pytest.mark.parametrize("name", [*DEGREES, *RADIANS])
@pytest.mark.deep("RLL 1 degree")
@pytest.mark.sampled(4)
def test_a_harmonic_is_interpolated(name):
    sites = (DEGREES | RADIANS)[name]()
    mesh = sphere.Delaunay(lonlat=sites, degrees=name in DEGREES)
    values, queries = harmonic(mesh.points), scattered(1500)
    ends = mesh.points[mesh.edges]
    longest = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).max()
    for kind in KINDS:
        made = kind(mesh, values)
        assert (made(sites) == values).all()
        gap = np.abs(made(queries) - harmonic(queries))
        if kind is sphere.Nearest:
            # The gradient of the harmonic is nowhere longer than 4.16.
            far = made.distance(queries)
            assert (gap <= 4.16 * (far if name in RADIANS else np.radians(far))).all()
        else:
            assert gap.max() < longest**2


@pytest.mark.parametrize("name", DEGREES)
def test_both_conventions_of_longitudes_are_one(name):
    sites = DEGREES[name]()
    assert sites[:, 0].min() >= 0 and sites[:, 0].max() > 180
    # The difference is exact from 180 on.
    moved = np.where(sites[:, :1] >= 180, sites - (360, 0), sites)
    one, other = sphere.Delaunay(lonlat=sites), sphere.Delaunay(lonlat=moved)
    assert (one.vectors == other.vectors).all()
    assert (one.simplices == other.simplices).all()
    values = np.sin(np.arange(len(sites)))
    assert (sphere.Linear(one, values)(moved) == values).all()


@pytest.mark.parametrize(
    ("name", "nodes"), [("scrip_outCSne8_outCSne8.nc", 386), ("scrip_ne30pg2_grid.nc", 21602)]
)
def test_corners_are_written_several_times(name, nodes):
    corners = pairs(name, "grid_corner_lon", "grid_corner_lat")
    mesh = sphere.Delaunay(lonlat=corners)
    # Names of a corner that differ in the last bits are directions of their own.
    distinct = mesh.npoints - len(mesh.duplicates)
    assert nodes <= distinct < len(corners)
    assert mesh.nsimplex == 2 * distinct - 4
    assert mesh.areas.sum() == pytest.approx(4 * np.pi, rel=1e-13)
    values = np.random.default_rng(1).normal(size=distinct)[
        np.unique(mesh.duplicate_of, return_inverse=True)[1]
    ]
    assert (sphere.Linear(mesh, values)(corners) == values).all()


def test_a_field_of_one_model_on_the_cells_of_another():
    (field,) = variables("ugrid_outRLL1deg_outRLL1deg_vortex.nc", "psi")
    nodes = sphere.Delaunay(lonlat=DEGREES["UGRID ne30"]()).points
    (faces,) = variables("ugrid_outCSne30_outCSne30.ug", "Mesh2_face_nodes")
    (truth,) = variables("ugrid_outCSne30_outCSne30_vortex.nc", "psi")
    first = int(faces.min())
    centers = nodes[faces.astype(int) - first].sum(axis=1)
    found = sphere.Linear(regular(), field.ravel())(centers)
    assert np.isfinite(found).all()
    assert np.abs(found - truth).max() < 0.03 * np.ptp(truth)
