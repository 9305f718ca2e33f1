"""The widget without a browser: its traits, its messages, and its errors."""

from __future__ import annotations

import builtins
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import delone
from delone import Delaunay, InputError, MissingExtraError, explore

POINTS = np.random.default_rng(9).random((30, 2))


@pytest.fixture
def widget() -> Any:
    pytest.importorskip("anywidget")
    made = explore(POINTS, layers={"circles": True}, height=300)
    made.sent = []
    made.send = made.sent.append
    return made


def test_traits_are_what_the_view_needs(widget: Any) -> None:
    state = widget.get_state()
    assert {"scene", "layers", "height", "selected", "_esm"} <= set(state)
    assert (state["layers"], state["height"]) == ({"circles": True}, 300)
    assert isinstance(state["scene"], bytes)
    assert np.array_equal(widget.mesh.simplices, Delaunay(POINTS).simplices)
    assert repr(widget) == f"<Explorer of Delaunay of 30 points: {widget.mesh.nsimplex} triangles>"


def test_the_scene_is_sent_as_a_buffer(widget: Any) -> None:
    from ipywidgets.widgets.widget import _remove_buffers

    state, paths, buffers = _remove_buffers(widget.get_state())
    assert ["scene"] in paths
    assert "scene" not in state
    assert bytes(buffers[paths.index(["scene"])]) == widget.scene


def test_one_module_without_imports_is_sent(widget: Any) -> None:
    text = widget._esm
    assert "\nimport " not in text
    assert text.count("export default") == 1
    for name in ("class MeshView", "function unpacked", "function edgesOf", "class Painter"):
        assert text.count(name) == 1


def test_picks_come_back(widget: Any) -> None:
    seen = []
    widget.observe(lambda change: seen.append(change["new"]), "selected")
    picked = {"triangle": 3, "vertex": -1, "x": 0.5, "y": 0.25}
    widget.set_state({"selected": picked})
    assert widget.selected == picked
    assert seen == [picked]


def test_a_dragged_point_triangulates_again(widget: Any) -> None:
    before = widget.scene
    widget.set_state({"selected": {"triangle": 3, "vertex": 2, "x": 0.5, "y": 0.25}})
    message = {"kind": "move", "number": "a-1", "vertex": 4, "x": 0.5, "y": 0.125}
    widget._handle_custom_msg(message, [])
    moved = POINTS.copy()
    moved[4] = 0.5, 0.125
    assert np.array_equal(widget.mesh.points, moved)
    assert np.array_equal(widget.mesh.simplices, Delaunay(moved).simplices)
    assert widget.scene != before
    assert widget.selected == {"triangle": -1, "vertex": 2, "x": 0.5, "y": 0.25}
    assert widget.sent == [{"number": "a-1", "error": ""}]


def test_a_drag_that_fails_is_answered(widget: Any) -> None:
    before = widget.scene
    widget._handle_custom_msg({"kind": "move", "number": "b", "vertex": 99, "x": 0, "y": 0}, [])
    widget._handle_custom_msg({"kind": "move", "number": "c", "vertex": 1}, [])
    widget._handle_custom_msg({"kind": "other"}, [])
    widget._handle_custom_msg(None, [])
    assert [each["number"] for each in widget.sent] == ["b", "c"]
    assert "99" in widget.sent[0]["error"]
    assert "numbers" in widget.sent[1]["error"]
    assert widget.scene == before


def test_python_moves_points(widget: Any) -> None:
    widget.move(0, 2, 2)
    assert widget.mesh.points[0].tolist() == [2, 2]
    with pytest.raises(InputError, match="point 30"):
        widget.move(30, 0, 0)


def test_widgets_are_independent(widget: Any) -> None:
    other = explore(POINTS)
    widget.move(0, 2, 2)
    assert np.array_equal(other.mesh.points, POINTS)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"layers": {"circle": True}}, "circle"),
        ({"layers": {"circles": 1}}, "True or False"),
        ({"height": 0}, "height"),
        ({"quality": "beauty"}, "quality"),
    ],
)
def test_options_are_checked(options: dict[str, Any], text: str) -> None:
    pytest.importorskip("anywidget")
    with pytest.raises(InputError, match=text):
        explore(POINTS, **options)


def test_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *args: Any, **kwargs: Any) -> Any:
        if name.partition(".")[0] == "anywidget":
            raise ModuleNotFoundError("No module named 'anywidget'", name="anywidget")
        return real(name, *args, **kwargs)

    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtraError, match=r'pip install "delone\[explore\]"') as caught:
        explore(POINTS)
    assert caught.value.extra == "explore"


def test_nothing_of_it_is_imported_before_it_is_used() -> None:
    code = (
        "import sys, delone; delone.Delaunay([(0, 0), (1, 0), (0, 1)]); "
        "print([n for n in sys.modules if 'explore' in n or n in ('anywidget', 'http.server')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert delone.explore is explore
