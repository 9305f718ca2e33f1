"""3-D plots of triangulations and convex hulls with PyVista (extra ``pyvista``).

Tetrahedra hide each other, so half of them can be left out where a plane cuts through, and each can
be shrunk about its centre. Drawn off screen where no window is wanted or there is none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_choice, as_flag, as_optional_flag
from delone.errors import InputError
from delone.extras import require

if TYPE_CHECKING:
    import os

    from numpy.typing import ArrayLike, NDArray

    from delone.delaunay import Delaunay
    from delone.hull import ConvexHull

__all__ = ["draw", "image", "plot", "unstructured"]

_AXES = {"x": 0, "y": 1, "z": 2}
# VTK's number for a tetrahedron.
_TETRA = 10
_FACE, _EDGE, _POINT = "#9ecae1", "#08306b", "#08306b"
_SIZE = (900, 760)


def unstructured(mesh: Delaunay, *, values: ArrayLike | None = None, name: str = "values") -> Any:
    """Return tetrahedra as a grid of pyvista.

    Parameters
    ----------
    mesh : Delaunay, RegularTriangulation or TetMesh
        A triangulation in space.
    values : array_like, shape (n,) or (m,), optional
        A number for each point or each tetrahedron.
    name : str, optional
        Of these numbers.

    Returns
    -------
    pyvista.UnstructuredGrid
        With the points and tetrahedra.

    Raises
    ------
    InputError
        `mesh` is no triangulation in space, or there is another number of values.
    MissingExtraError
        pyvista is not installed.

    Examples
    --------
    >>> from delone import Delaunay, datasets, scene
    >>> mesh = Delaunay(datasets.uniform(50, ndim=3))
    >>> scene.unstructured(mesh, values=mesh.volumes).n_cells == mesh.nsimplex
    True
    """
    pyvista = require("pyvista", extra="pyvista", what="drawing in space")
    _require_space(mesh, corners=(4,))
    return _grid(pyvista, mesh.points, mesh.simplices, values, name)


def plot(
    shape: Delaunay | ConvexHull,
    *,
    plotter: Any = None,
    values: ArrayLike | None = None,
    cut: str = "none",
    shrink: float = 1.0,
    points: bool = False,
    off_screen: bool | None = None,
    cmap: str = "viridis",
    bar: bool = True,
) -> Any:
    """Draw a triangulation or a mesh in space, or a convex hull, with its edges.

    Parameters
    ----------
    shape : Delaunay, RegularTriangulation, TetMesh or ConvexHull, in space
        What to draw.
    plotter : pyvista.Plotter, optional
        Where to draw; by default a new one.
    values : array_like, shape (n,) or (m,), optional
        A number for each point or each simplex, for colours. By default one colour.
    cut : {"none", "x", "y", "z"}, optional
        The axis along which the farther half of the tetrahedra is left out.
    shrink : float, optional
        How much of each tetrahedron is drawn, up to 1.
    points : bool, optional
        Whether the points are drawn as well.
    off_screen : bool, optional
        Whether a new plotter draws without a window.
    cmap : str, optional
        The colours of values.
    bar : bool, optional
        Whether a bar tells which colour is which value.

    Returns
    -------
    pyvista.Plotter
        What was drawn on: ``show()`` opens the window, ``screenshot(path)`` writes a picture.

    Raises
    ------
    InputError
        `shape` is in the plane or has no simplices, or an option is none of its choices.
    MissingExtraError
        pyvista is not installed.

    Examples
    --------
    >>> from delone import Delaunay, datasets, scene
    >>> mesh = Delaunay(datasets.uniform(50, ndim=3))
    >>> plotter = scene.plot(mesh, values=mesh.volumes, cut="x", off_screen=True)
    >>> plotter.close()
    """
    pyvista = require("pyvista", extra="pyvista", what="drawing in space")
    as_choice(cut, ("none", *_AXES), name="cut")
    dots, scale = as_flag(points, name="points"), as_flag(bar, name="bar")
    hidden = as_optional_flag(off_screen, name="off_screen")
    _require_space(shape, corners=(3, 4))
    if not 0 < shrink <= 1:
        raise InputError(f"shrink must be above 0 and at most 1, got {shrink}")
    if plotter is None:
        plotter = pyvista.Plotter(off_screen=hidden, window_size=list(_SIZE))
        plotter.set_background("white")
    rows, nsimplex = _kept(shape, cut), len(shape.simplices)
    chosen = None if values is None else np.asarray(values, dtype=np.float64)
    if chosen is not None and len(chosen) == nsimplex != len(shape.points):
        chosen = chosen[rows]
    grid = _grid(pyvista, shape.points, shape.simplices[rows], chosen, "values")
    if shrink < 1:
        grid = grid.shrink(shrink)
    colours: dict[str, Any] = {"color": _FACE}
    if values is not None:
        colours = {"scalars": "values", "cmap": cmap, "show_scalar_bar": scale}
    # Some light on all sides, so that colours are seen in the shade, too.
    plotter.add_mesh(
        grid, show_edges=shrink == 1, edge_color=_EDGE, line_width=1, ambient=0.4, **colours
    )
    if dots:
        plotter.add_points(
            np.array(shape.points), color=_POINT, point_size=6, render_points_as_spheres=True
        )
    return plotter


def draw(path: str | os.PathLike[str], shape: Delaunay | ConvexHull, **options: Any) -> None:
    """Draw into a PNG file, off screen.

    Parameters
    ----------
    path : str or path-like
        The file.
    shape : Delaunay, RegularTriangulation, TetMesh or ConvexHull, in space
        What to draw.
    **options
        As in `plot`.

    Raises
    ------
    InputError
        As in `plot`.
    MissingExtraError
        pyvista is not installed.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone import ConvexHull, datasets, scene
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "hull.png"
    ...     scene.draw(file, ConvexHull(datasets.uniform(50, ndim=3)))
    ...     file.read_bytes()[1:4]
    b'PNG'
    """
    with _quiet():
        plotter = _aimed(plot(shape, off_screen=True, **options))
        try:
            plotter.screenshot(str(path))
        finally:
            plotter.close()


def image(shape: Delaunay | ConvexHull, **options: Any) -> NDArray[np.uint8]:
    """Draw into an array, off screen.

    Parameters
    ----------
    shape : Delaunay, RegularTriangulation, TetMesh or ConvexHull, in space
        What to draw.
    **options
        As in `plot`.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        Red, green and blue, for ``matplotlib`` or whatever shows pictures.

    Raises
    ------
    InputError
        As in `plot`.
    MissingExtraError
        pyvista is not installed.

    Examples
    --------
    >>> from delone import ConvexHull, datasets, scene
    >>> scene.image(ConvexHull(datasets.uniform(50, ndim=3))).shape
    (760, 900, 3)
    """
    with _quiet():
        plotter = _aimed(plot(shape, off_screen=True, **options))
        try:
            picture: NDArray[np.uint8] = np.array(plotter.screenshot(return_img=True))
        finally:
            plotter.close()
    return picture


def _require_space(shape: Any, *, corners: tuple[int, ...]) -> None:
    """Refuse what has no simplices in space, and say what draws it."""
    if getattr(shape, "ndim", 3) != 3:
        raise InputError("a scene needs points in space: draw those in the plane by delone.plot")
    places, simplices = (np.shape(getattr(shape, each, ())) for each in ("points", "simplices"))
    if places[1:] == (3,) and simplices[1:] in ((width,) for width in corners):
        return
    name, hull = type(shape).__name__, " and no convex hull" if 3 in corners else ""
    hint = "use its own plot()" if hasattr(shape, "plot") else "draw delone.Delaunay(points)"
    raise InputError(f"a {name} is no triangulation in space{hull}: {hint}")


def _quiet() -> Any:
    """Let VTK not warn that there is no screen: none is needed."""
    return require("pyvista", extra="pyvista", what="drawing in space").vtk_verbosity("error")


def _aimed(plotter: Any) -> Any:
    """Look not along an axis, so that nothing is seen edge on."""
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 40, 20
    plotter.reset_camera()
    plotter.camera.zoom(1.25)
    return plotter


def _kept(shape: Delaunay | ConvexHull, cut: str) -> NDArray[np.intp]:
    """The simplices whose centre is on the nearer side of the middle of the box."""
    if cut == "none":
        return np.arange(len(shape.simplices))
    axis = _AXES[cut]
    along = shape.points[:, axis]
    middle = along.min() / 2 + along.max() / 2
    width = shape.simplices.shape[1]
    centre = sum(along[shape.simplices[:, k]] / width for k in range(width))
    return np.flatnonzero(centre <= middle)


def _grid(
    pyvista: Any,
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    values: ArrayLike | None,
    name: str,
) -> Any:
    width = simplices.shape[1]
    if width == 4:
        grid = pyvista.UnstructuredGrid({_TETRA: simplices}, np.array(points))
    else:
        grid = pyvista.PolyData.from_regular_faces(np.array(points), simplices)
    if values is not None:
        array = np.asarray(values, dtype=np.float64)
        if len(array) not in (len(points), len(simplices)):
            raise InputError(
                f"values must be one for each of {len(points)} points or {len(simplices)} "
                f"simplices, got {len(array)}"
            )
        data = grid.point_data if len(array) == len(points) else grid.cell_data
        data[name] = array
    return grid
