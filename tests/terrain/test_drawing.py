"""DXF drawings, read again by ezdxf and by delone: every double, layers, texts and units."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from delone import InputError
from delone.errors import FileFormatError
from delone.io import PointSet, read_surface, write_drawing
from delone.io.drawing import _nice, _ticks, chains
from delone.terrain import TIN

ezdxf = pytest.importorskip("ezdxf")

LOW = np.array((155_000.1, 463_000.3, 0))


def hill(seed: int = 3, **options) -> TIN:
    rng = np.random.default_rng(seed)
    xy = np.concatenate(([(0, 0), (100, 0), (100, 100), (0, 100)], rng.uniform(0, 100, (300, 2))))
    z = 30 * np.exp(-((xy - 50) ** 2).sum(axis=1) / 900) + xy[:, 0] / 7
    return TIN.from_points(np.column_stack((xy, z)) + LOW, **options)


def entities(path, kind, layer):
    return ezdxf.readfile(path).modelspace().query(f'{kind}[layer=="{layer}"]')


def test_a_surface_comes_back_with_all_digits(tmp_path):
    ridge = np.array([(10, 10, 25.1), (40, 35, 26.3), (60, 10, 24.7)]) + LOW
    ring = np.array([(70, 70, 9), (90, 70, 9), (90, 90, 9), (70, 90, 9), (70, 70, 9)]) + LOW
    soft = [np.array([(20, 70, 9.0), (50, 90, 9.5)]) + LOW]
    tin = hill(breaklines=[ridge, ring], soft_breaklines=soft, crs="EPSG:28992", units="m")
    path = tmp_path / "site höhe.dxf"
    write_drawing(path, tin)
    back = read_surface(path, layer="TIN")
    corners = {tuple(sorted(map(tuple, back.points[row].tolist()))) for row in back.faces}
    xyz = np.column_stack((tin.points, tin.z))
    assert corners == {tuple(sorted(map(tuple, xyz[row].tolist()))) for row in tin.simplices}
    assert back.units == "m" and ezdxf.readfile(path).header["$INSUNITS"] == 6
    for layer, some in (("BREAKLINES", ~tin.soft), ("SOFT_BREAKLINES", tin.soft)):
        found = set()
        lines = entities(path, "POLYLINE", layer)
        for line in lines:
            rows = [tuple(each) for each in line.points()]
            rows += rows[:1] * line.is_closed
            found |= {frozenset(pair) for pair in pairwise(rows)}
        edges = tin.breaklines[some]
        assert found == {frozenset(map(tuple, xyz[row].tolist())) for row in edges}
        assert len(lines) == (2 if layer == "BREAKLINES" else 1)
    assert sum(line.is_closed for line in entities(path, "POLYLINE", "BREAKLINES")) == 1


def test_contours_are_polylines_at_their_heights(tmp_path):
    contours = hill().contours(interval=2)
    path = tmp_path / "a.dxf"
    write_drawing(path, contours)
    for layer, some in (("CONTOURS", ~contours.index), ("CONTOURS_INDEX", contours.index)):
        lines = entities(path, "POLYLINE", layer)
        assert len(lines) == some.sum() > 0
        for line, k in zip(lines, np.flatnonzero(some), strict=True):
            points = np.array([tuple(each) for each in line.points()])
            assert (points[:, 2] == contours.level[k]).all()
            wanted = contours.coordinates(k)
            assert line.is_closed == bool(contours.closed[k])
            assert (points[:, :2] == wanted[: -1 if line.is_closed else None]).all()


def test_points_have_their_heights_as_text(tmp_path):
    points = PointSet(points=np.array([(1.1, 2.2), (5.0, 9.0)]), z=np.array([3.25, -4.5]))
    path = tmp_path / "a.dxf"
    write_drawing(path, points, points, text_height=0.4, units="ft")
    places = [tuple(each.dxf.location) for each in entities(path, "POINT", "POINTS")]
    assert places == [(1.1, 2.2, 3.25), (5.0, 9.0, -4.5)]
    texts = entities(path, "TEXT", "POINTS_TEXT_2")
    assert [(each.dxf.text, each.dxf.height) for each in texts] == [("3.25", 0.4), ("-4.5", 0.4)]
    assert ezdxf.readfile(path).header["$INSUNITS"] == 2
    with pytest.raises(InputError, match="not finite"):
        write_drawing(path, PointSet(points=np.array([(1.0, np.nan)]), z=np.zeros(1)))
    # The file that was there is still whole.
    assert len(entities(path, "POINT", "POINTS")) == 2


def test_profiles_are_drawn_without_their_gaps(tmp_path):
    hole = [(155_030, 463_020), (155_060, 463_020), (155_060, 463_080), (155_030, 463_080)]
    tin, other = hill(holes=[hole]), hill(4)
    line = np.array([(155_010.0, 463_050.0), (155_090.0, 463_050.0)])
    path = tmp_path / "a.dxf"
    write_drawing(path, tin.profiles(line, {"a/b": other}), exaggeration=4)
    parts = entities(path, "LWPOLYLINE", "PROFILE_surface")
    assert len(parts) == 2 and len(entities(path, "LWPOLYLINE", "PROFILE_a_b")) == 1
    x = [[point[0] for point in part.get_points()] for part in parts]
    assert (x[0][0], x[1][-1]) == (0, 80) and x[0][-1] == pytest.approx(20)
    alone = tin.profile(line)
    up = np.concatenate([[point[1] for point in part.get_points()] for part in parts])
    assert np.ptp(up) == pytest.approx(4 * (np.nanmax(alone.z) - np.nanmin(alone.z)))
    labels = [float(each.dxf.text) for each in entities(path, "TEXT", "PROFILE_TEXT")]
    assert {0.0, 20.0, 40.0, 60.0, 80.0} <= set(labels)
    write_drawing(path, alone)
    assert len(entities(path, "LWPOLYLINE", "PROFILE_surface")) == 2


def test_sections_are_in_a_column_with_their_stations(tmp_path):
    found = hill().cross_sections(
        [(155_010, 463_050), (155_150, 463_050)], interval=20, left=8, start=1200
    )
    path = tmp_path / "a.dxf"
    write_drawing(path, found)
    texts = [each.dxf.text for each in entities(path, "TEXT", "PROFILE_TEXT")]
    assert [f"{station:.0f}" in texts for station in found.stations[:5]] == [True] * 5
    # Beyond the surface there is nothing to draw, which is said.
    assert "1320: no heights" in texts and "1340: no heights" in texts
    lines = entities(path, "LWPOLYLINE", "PROFILE_surface")
    spans = [[point[1] for point in line.get_points()] for line in lines]
    assert all(min(a) > max(b) for a, b in pairwise(spans))
    assert {line.get_points()[0][0] for line in lines} == {-8}


def test_drawings_pass_the_audit_of_ezdxf(tmp_path):
    path = tmp_path / "a.dxf"
    tin = hill(units="us-ft")
    write_drawing(path, tin, tin.contours(interval=5))
    drawing = ezdxf.readfile(path)
    found = drawing.audit()
    assert not found.errors and not found.fixes and drawing.header["$INSUNITS"] == 21


def test_what_cannot_be_drawn(tmp_path):
    path, tin = tmp_path / "a.dxf", hill()
    line = [(155_010, 463_050), (155_090, 463_050)]
    with pytest.raises(InputError, match="maps and profiles are in different planes"):
        write_drawing(path, tin, tin.profile(line))
    with pytest.raises(InputError, match="got dict"):
        write_drawing(path, {})
    with pytest.raises(InputError, match="nothing to draw"):
        write_drawing(path)
    with pytest.raises(InputError, match="above 0"):
        write_drawing(path, tin, exaggeration=0)
    with pytest.raises(InputError, match="above 0"):
        write_drawing(path, tin, text_height=-1)
    with pytest.raises(FileFormatError, match=r"to \.dxf"):
        write_drawing(tmp_path / "a.dwg", tin)
    with pytest.raises(OSError):
        write_drawing(tmp_path / "no folder" / "a.dxf", tin)
    assert not path.exists()


def test_chains_have_each_edge_once():
    edges = np.array([(0, 1), (1, 2), (2, 3), (2, 4), (5, 6), (6, 7), (7, 5), (2, 8), (8, 9)])
    found = list(chains(edges))
    pairs = [frozenset(pair) for chain in found for pair in pairwise(chain)]
    assert sorted(map(sorted, pairs)) == sorted(map(sorted, edges.tolist()))
    assert sorted(len(chain) for chain in found) == [2, 2, 3, 3, 4]


def test_ticks_are_round():
    assert [_nice(each) for each in (0.03, 0.5, 0.51, 7, 0)] == [0.05, 0.5, 1, 10, 1]
    assert _ticks(-0.3, 0.3, 0.1) == [-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3]
