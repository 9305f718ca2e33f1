"""The function `delone.explore`: a notebook widget that combines an exploration and the view."""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING, Any

from delone._base.arrays import as_least
from delone._base.extras import require
from delone.errors import DeloneError, InputError
from delone.explorer import script
from delone.explorer.state import Exploration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

__all__ = ["explore"]

_LAYERS = (
    *("triangles", "quality", "values", "circles"),
    *("dual", "hull", "constraints", "points"),
)
# In the order of their dependencies.
_MODULES = ("mesh.js", "colors.js", "paint.js", "view.js", "scene.js", "widget.js")


def explore(
    mesh: Any,
    *,
    values: ArrayLike | None = None,
    quality: str = "smallest_angle",
    layers: Mapping[str, bool] | None = None,
    height: int = 480,
) -> Any:
    """Show a 2-D mesh as an interactive widget in a notebook.

    Parameters
    ----------
    mesh : object or array_like, shape (n, 2)
        What to show: a 2-D `Delaunay`, `ConstrainedDelaunay`, `Mesh`, `RegularTriangulation`,
        `PeriodicDelaunay` or `Voronoi`, or points, which are triangulated.
    values : array_like, shape (n,), optional
        A number for each point, such as its height, for the layer ``"values"``. NaN for none.
    quality : {"smallest_angle", "largest_angle", "area", "radius_ratio", "edge_ratio"}, optional
        What the layer ``"quality"`` shows, an attribute of `Quality`. Angles are in degrees.
    layers : mapping of str to bool, optional
        The layers to switch on or off at first: ``"triangles"``, ``"quality"``, ``"values"``,
        ``"circles"`` (circumcircles), ``"dual"`` (Voronoi diagram), ``"hull"``, ``"constraints"``
        (segments), ``"points"``.
    height : int, optional
        Height in CSS pixels.

    Returns
    -------
    anywidget.AnyWidget
        The widget. ``widget.selected`` is a dictionary with the row of the triangle and the row of
        the point that were picked, -1 for none, and the coordinates x and y; after a point has
        moved, the rows of triangles change, and no triangle is selected. ``widget.mesh`` is the
        object that is shown, with the moved points; ``widget.layers`` the state of the layers,
        which can be set. ``widget.move(row, x, y)`` moves a point like the mouse.

    Raises
    ------
    MissingExtraError
        anywidget is not installed (extra ``explore``).
    InputError
        `mesh` is 3-D or of another class, or an option has a wrong value.
    ShapeError, DtypeError
        `values` is not one real number for each point.
    DegenerateInputError, NonFiniteError
        As for `Delaunay`, if `mesh` is points.

    See Also
    --------
    delone.plot.plot : Static plots.

    Notes
    -----
    Arrays are sent to the notebook as binary buffers, about 150 bytes per point. Moving a point
    retriangulates all points with the same options in this process, which takes about 40 ms for
    10,000 points. If a point cannot be moved there, for example because segments would cross, the
    error message is shown and the object does not change. Points of a `Mesh`, and points that a
    triangulation added, cannot be moved. The widget is for viewing; its display is rounded to
    pixels.

    Examples
    --------
    >>> from delone import Delaunay, explore
    >>> widget = explore(Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]))
    >>> widget.move(4, 2.5, 1.5)
    >>> widget.mesh.points[4].tolist()
    [2.5, 1.5]
    """
    chosen = _as_layers(layers)
    pixels = as_least(height, 1, name="height (pixels)")
    require("anywidget", extra="explore", what="exploring in a notebook")
    state = Exploration(mesh, values=values, quality=quality)
    return _widget_class()(state, layers=chosen, height=pixels)


def _as_layers(layers: Mapping[str, bool] | None) -> dict[str, bool]:
    chosen = {} if layers is None else dict(layers)
    for name, on in chosen.items():
        if name not in _LAYERS:
            raise InputError(f"{name!r:.80} is not a layer; layers are {', '.join(_LAYERS)}")
        if not isinstance(on, bool):
            raise InputError(f"layer {name!r:.80} is switched by True or False; got {on!r:.80}")
    return chosen


def source() -> str:
    """Return the modules of the view as one, without their imports, as a widget needs."""
    text = "\n".join(script(name) for name in _MODULES)
    return re.sub(r"^import \{[^}]*\} from \"\./\w+\.js\";$", "", text, flags=re.MULTILINE)


@functools.cache
def _widget_class() -> Any:
    """Return the class of widgets, whose base is in an optional library."""
    anywidget = require("anywidget", extra="explore", what="exploring in a notebook")
    traitlets = require("traitlets", extra="explore", what="exploring in a notebook")

    class Explorer(anywidget.AnyWidget):  # type: ignore[misc, name-defined]
        """An interactive view of a 2-D mesh; see `delone.explore`."""

        _esm = source()
        scene = traitlets.Bytes().tag(sync=True)
        layers = traitlets.Dict().tag(sync=True)
        height = traitlets.Int(480).tag(sync=True)
        selected = traitlets.Dict().tag(sync=True)

        def __init__(self, state: Exploration, **traits: Any) -> None:
            self._state = state
            nothing = {"triangle": -1, "vertex": -1, "x": None, "y": None}
            super().__init__(scene=state.packed(), selected=nothing, **traits)
            self.on_msg(self._received)

        @property
        def mesh(self) -> Any:
            """The object that is shown."""
            return self._state.mesh

        def move(self, row: int, x: float, y: float) -> None:
            """Move a point and retriangulate; if that is not possible, raise the error."""
            self._show(self._state.move(row, x, y))
            self.send({"number": "", "error": ""})

        def _show(self, scene: bytes) -> None:
            """Send a scene with different triangles; the picked one has no number there."""
            self.scene = scene
            self.selected = self.selected | {"triangle": -1}

        def _received(self, _: Any, content: Any, buffers: Any) -> None:
            """Answer a message of a view: a point has been moved."""
            if not isinstance(content, dict) or content.get("kind") != "move":
                return
            try:
                asked = (content.get(name) for name in ("vertex", "x", "y"))
                self._show(self._state.move(*asked))
                error = ""
            except DeloneError as failed:
                error = str(failed)
            self.send({"number": content.get("number"), "error": error})

        def __repr__(self) -> str:
            return f"<Explorer of {self._state.described()}>"

    return Explorer
