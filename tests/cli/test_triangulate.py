"""delone triangulate: the report, the files, and what is refused."""

import numpy as np
import pytest

from delone import Delaunay
from delone.cli import report
from delone.io import read_mesh, read_points


def test_report_for_machines(survey, figures, tmp_path):
    out = tmp_path / "mesh.npz"
    found = figures("triangulate", survey, "-o", out, "-o", tmp_path / "mesh.vtu")
    mesh = Delaunay(read_points(survey).points)
    h = len(mesh.hull)
    assert found["points"] == 10000
    assert found["distinct"] == 9997
    assert found["duplicates"]["count"] == 3
    x, y = mesh.points[9997].tolist()
    assert found["duplicates"]["first"][0] == {"row": 9997, "same_as": 0, "x": x, "y": y}
    assert found["hull_vertices"] == h
    assert found["triangles"] == {"count": mesh.nsimplex, "expected": 2 * 9997 - h - 2}
    assert found["triangles"]["count"] == found["triangles"]["expected"]
    assert found["edges"] == {"count": len(mesh.edges), "expected": 3 * 9997 - h - 3}
    assert found["edges"]["count"] == found["edges"]["expected"]
    assert found["mean_degree"] == pytest.approx(2 * len(mesh.edges) / 9997)
    assert found["area"] == pytest.approx(mesh.areas.sum(), rel=1e-12)
    assert 0 < found["smallest_angle_degrees"] < 1
    assert found["outputs"] == [str(out), str(tmp_path / "mesh.vtu")]
    assert found["peak_memory_bytes"] > 1e6
    names = [stage["name"] for stage in found["stages"]]
    assert names[0] == "read"
    assert set(mesh.stages) < set(names)
    assert names[-3:] == ["write mesh.npz", "write mesh.vtu", "measure"]
    assert all(stage["seconds"] >= 0 for stage in found["stages"])
    assert np.array_equal(read_mesh(out).simplices, mesh.simplices)
    assert np.array_equal(read_mesh(tmp_path / "mesh.vtu").z, read_points(survey).z)


def test_report_for_people(survey, command):
    code, out, err = command("triangulate", survey)
    assert (code, err) == (0, "")
    words = ("points read", "10,000", "distinct", "9,997", "row 9997 is row 0 at", "hull", "degree")
    measures = ("= 2n - h - 2", "= 3n - h - 3", "angle", "area", "points per second", "memory")
    for word in words + measures:
        assert word in out
    assert command("triangulate", survey, "--quiet") == (0, "", "")


def test_names_of_files_are_whole(tmp_path, command):
    # Shorter than any table of a report, and longer than a line of a terminal.
    for name in ("a" * 40, "b" * 180):
        file = tmp_path / f"{name}.csv"
        file.write_text("0,0\n1,0\n0,1\n")
        out = tmp_path / f"{name}.npz"
        code, said, _ = command("triangulate", file, "-o", out)
        assert code == 0
        assert said.splitlines()[0] == str(file)
        assert any(line.endswith(f" {out}") for line in said.splitlines())


def test_the_smallest_angle(tmp_path, figures):
    (tmp_path / "a.csv").write_text("0,0\n1,0\n0.5,0.8660254037844386\n")
    found = figures("triangulate", tmp_path / "a.csv")
    assert found["smallest_angle_degrees"] == pytest.approx(60)
    (tmp_path / "a.csv").write_text("-1e300,0\n1e300,0\n-1e300,2e300\n")
    found = figures("triangulate", tmp_path / "a.csv")
    assert found["smallest_angle_degrees"] == pytest.approx(45)
    assert found["area"] is None  # beyond the range of doubles


def test_the_smallest_angle_is_that_of_all_triangles():
    # More triangles than a thread takes at once.
    mesh = Delaunay(np.random.default_rng(5).random((12_000, 2)))
    smallest = mesh.quality().smallest_angle.min()
    for simplices in (mesh.simplices, mesh.simplices[::-1], mesh.simplices[:, [0, 2, 1]]):
        found = report.geometry(mesh.points, simplices)
        assert found["smallest_angle_degrees"] == pytest.approx(smallest, rel=1e-14)


def test_options_reach_the_reader_and_the_writer(tmp_path, figures, command):
    (tmp_path / "a.csv").write_text("a,b,c\n0,0,1\n4,0,2\n4,3,3\n0,3,4\n")
    out = tmp_path / "edges.vtu"
    arguments = ("triangulate", tmp_path / "a.csv", "--columns", "b, a", "-o", out, "--edges",
                 "--workers", 1, "--method", "bowyer-watson")  # fmt: skip
    assert figures(*arguments)["edges"]["count"] == 5
    assert read_points(out).points.tolist() == [[0, 0], [0, 4], [3, 4], [3, 0]]
    assert command("check", out)[0] == 3


def test_chosen_classes(tmp_path, figures):
    import laspy

    las = laspy.LasData(laspy.LasHeader())
    las.x, las.y, las.z = [0, 1, 0, 1, 5], [0, 0, 1, 1, 5], [0, 0, 0, 0, 0]
    las.classification = [2, 2, 2, 6, 7]
    las.write(tmp_path / "a.las")
    assert figures("triangulate", tmp_path / "a.las")["points"] == 5
    assert figures("triangulate", tmp_path / "a.las", "--classes", "2")["points"] == 3
    assert figures("triangulate", tmp_path / "a.las", "--classes", "2,6")["points"] == 4


def test_the_order_of_rows_does_not_matter(tmp_path, figures):
    points = np.random.default_rng(0).integers(0, 30, (500, 2)).astype(float)
    found = []
    for order in (slice(None), slice(None, None, -1)):
        np.save(tmp_path / "a.npy", points[order])
        said = figures("triangulate", tmp_path / "a.npy")
        found.append([said[key] for key in ("triangles", "edges", "smallest_angle_degrees")])
    assert found[0] == found[1]
