"""delone hull: points in, an outline out."""

import geopandas
import numpy as np
import pytest
import shapely

import delone


@pytest.fixture
def ring(tmp_path):
    random = np.random.default_rng(1)
    angles, radii = random.uniform(0, 2 * np.pi, 800), random.uniform(20, 30, 800)
    points = np.column_stack((radii * np.cos(angles), radii * np.sin(angles)))
    np.savetxt(tmp_path / "ring.csv", points, delimiter=",", fmt="%.17g", header="x,y", comments="")
    return tmp_path / "ring.csv", points


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".parquet"])
def test_outlines_are_those_of_the_package(suffix, ring, figures, tmp_path):
    source, points = ring
    path = tmp_path / f"outline{suffix}"
    options = {
        ("--concave", "--max-edge", "6"): delone.concave_hull(points, max_edge=6),
        ("--concave", "--ratio", "0.2", "--holes"): delone.concave_hull(
            points, ratio=0.2, holes=True
        ),
        ("--alpha", "9"): delone.AlphaComplex(points).shape(9),
        (): delone.concave_hull(points, ratio=1),
    }
    for given, expected in options.items():
        found = figures("hull", source, *given, "-o", path, "--crs", "EPSG:28992")
        read = geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file
        table = read(path)
        assert table.crs == "EPSG:28992"
        assert (found["points"], found["polygons"], len(table)) == (
            800,
            expected.nparts,
            expected.nparts,
        )
        assert found["area"] == expected.area
        assert shapely.area(table.geometry.values).sum() == pytest.approx(expected.area)


def test_the_best_alpha_has_all_points(ring, figures, command):
    source, points = ring
    found = figures("hull", source, "--alpha", "optimal")
    assert (found["outside"], found["polygons"]) == (0, 1)
    assert found["alpha"] == delone.AlphaComplex(points).optimal()
    code, out, _ = command("hull", source, "--alpha", "0.5")
    assert code == 0 and "outside" in out


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--concave"], "either"),
        (["--concave", "--max-edge", "1", "--ratio", "1"], "either"),
        (["--max-edge", "1"], "--concave"),
        (["--holes"], "--concave"),
        (["--concave", "--ratio", "1", "--alpha", "1"], "one of them"),
        (["--concave", "--ratio", "2"], "from 0 to 1"),
        (["--concave", "--max-edge=-1"], "at least 0"),
        (["--alpha", "wide"], "squared radius"),
        (["--alpha=-2"], "squared radius"),
        (["-o", "outline.tif"], "outlines"),
    ],
)
def test_wrong_options(options, part, ring, command):
    code, _, error = command("hull", ring[0], *options)
    assert code == 2
    assert part in error
