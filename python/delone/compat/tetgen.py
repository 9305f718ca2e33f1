"""Drop-in replacement for the package ``tetgen``: its class, with `delone.tetrahedralize` inside.

That package wraps H. Si's program TetGen. Here the names are the same, but delone does the work; no
code of either is used. Points are added strictly between the triangles only. Triangles in one plane
may be cut again, but not with TetGen's switch Y. Tetrahedra of bounded quality are not supported.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_count, as_flag, as_number, as_plain_array, as_points
from delone.errors import DtypeError, InputError, ShapeError
from delone.space.locking import cells, sides
from delone.surface import check_surface
from delone.surface.check import as_faces
from delone.tetmesh.tetmesh import TetMesh
from delone.tetrahedra.filling import tetrahedralize
from delone.tetrahedra.sources import given

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._types import Floats, Indices

__all__ = ["TetGen"]

_SWITCH = re.compile(r"([a-zA-Z])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?:/[\d.]+)*)?")
# Numbers from zero, silence, checks, files, and what TetGen does to coplanar triangles and to
# tetrahedra afterwards: they change nothing here, or nothing that is promised.
_WITHOUT_EFFECT = "zQVCFIJNEgkBMOfenT"
_QUALITY = (
    "tetrahedra of bounded quality and size are not supported: pass quality=False, and "
    "delone.improve removes slivers afterwards"
)
_REFUSED = {
    "q": _QUALITY,
    "a": _QUALITY,
    "m": _QUALITY,
    "o": "elements of second order are not supported: pass order=1",
    "r": "tetrahedra cannot be reconstructed or refined",
    "i": "use extra_points of delone.tetrahedralize",
    "c": "the convex hull is not kept",
    "D": "segments are not split to make tetrahedra Delaunay",
    "w": "use delone.RegularTriangulation",
    "v": "use delone.Voronoi",
    "d": "use delone.check_surface",
    "R": "vertices are not removed",
    "L": "flips have no levels",
    "K": "the format is written by delone.io.write_mesh",
    "X": "arithmetic is always exact",
    "P": "boundary facets are always returned",
    "l": "there is one algorithm",
    "s": "there is one algorithm",
    "b": "there is one order of insertion",
}


class TetGen:
    """A surface to be filled with tetrahedra.

    Parameters
    ----------
    *args : array_like, path or mesh
        Vertices (n, 3), triangles (m, 3) and, optionally, a marker for each triangle; or a surface
        or file as for `delone.tetrahedralize`.

    Attributes
    ----------
    v, f : ndarray
        The vertices and triangles.
    mesh : TetMesh or None
        The result as delone's own class, after `tetrahedralize`.

    Raises
    ------
    ShapeError, DtypeError, InputError, NonFiniteError, FileFormatError
        The arguments are not such arrays, objects or files.

    See Also
    --------
    delone.tetrahedralize : The function that does the work.

    Examples
    --------
    >>> from delone.compat import tetgen
    >>> v = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> f = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    >>> tet = tetgen.TetGen(v, f)
    >>> nodes, elems, attributes, markers = tet.tetrahedralize(quality=False)
    >>> elems.shape, markers.tolist()
    ((1, 4), [0, 0, 0, 0])
    """

    def __init__(self, *args: Any) -> None:
        if not 1 <= len(args) <= 3:
            raise DtypeError(
                f"give a surface, or vertices and triangles; got {len(args)} arguments"
            )
        surface, faces, markers = (*args, None, None)[:3]
        found = given(surface, faces, markers, None, None)
        self.v, self.f = as_faces(found.points, found.faces)
        self.mesh: TetMesh | None = None
        self._markers = found.markers
        self._holes: list[Floats] = [] if found.holes is None else list(np.asarray(found.holes))
        self._regions: list[tuple[int, Floats]] = []
        for x, y, z, number in () if found.regions is None else np.asarray(found.regions).tolist():
            self.add_region(int(number), (x, y, z))
        self._attributes = np.empty((0, 0))
        self._trifaces = np.empty((0, 3), dtype=np.int32)
        self._triface_markers = np.empty(0, dtype=np.int32)

    def __repr__(self) -> str:
        return f"<TetGen of {len(self.v)} vertices and {len(self.f)} triangles>"

    def add_region(self, id: int, point_in_region: ArrayLike, max_vol: float = 0.0) -> None:
        """Label the region around a point.

        Parameters
        ----------
        id : int
            The label, at least 0, in `attributes` with ``regionattrib=True``.
        point_in_region : array_like of float, shape (3,)
            The point.
        max_vol : float, optional
            The largest volume of a tetrahedron: not supported, only 0.

        Raises
        ------
        InputError
            `max_vol` is not 0, or the label is negative.
        ShapeError, DtypeError
            `point_in_region` is not a point.

        Examples
        --------
        See `TetGen`.
        """
        if as_number(max_vol, name="max_vol") != 0:
            raise InputError(f"max_vol: {_QUALITY}")
        self._regions.append((as_count(id, name="id"), _place(point_in_region)))

    def add_hole(self, point: ArrayLike) -> None:
        """Leave the region around a point empty.

        Parameters
        ----------
        point : array_like of float, shape (3,)
            The point.

        Raises
        ------
        ShapeError, DtypeError
            `point` is not a point.

        Examples
        --------
        See `TetGen`.
        """
        self._holes.append(_place(point))

    def make_manifold(self, verbose: bool = False) -> None:
        """Check that the surface can be filled; nothing is repaired.

        Parameters
        ----------
        verbose : bool, optional
            Whether to print the check.

        Raises
        ------
        CrossingFacesError, OpenSurfaceError, DegenerateInputError, InputError
            The surface cannot be filled. The package ``tetgen`` lets PyMeshFix change such a
            surface; here the error says what is wrong.

        Examples
        --------
        See `TetGen`.
        """
        check = check_surface(self.v, self.f)
        if as_flag(verbose, name="verbose"):
            print(check)
        check.raise_if_bad()

    def tetrahedralize(  # noqa: PLR0917
        self,
        plc: bool = True,
        quality: bool = True,
        minratio: float = 2.0,
        mindihedral: float = 0.0,
        nobisect: bool = False,
        steinerleft: int = 100_000,
        order: int = 1,
        regionattrib: bool = False,
        facesout: bool = False,
        edgesout: bool = False,
        switches: str = "",
        bgmesh: Any = None,
        **others: Any,
    ) -> tuple[Floats, Indices, Floats, Indices]:
        """Fill the surface with tetrahedra.

        Everything that the triangles enclose is filled, except holes, however they are oriented.

        Parameters
        ----------
        plc : bool, optional
            Must be True: the triangles are faces of the result.
        quality : bool, optional
            Must be False. True, the default of the package ``tetgen``, is refused: quality is not
            supported.
        minratio, mindihedral : float, optional
            Bounds on quality, without effect if `quality` is False.
        nobisect : bool, optional
            Whether all triangles are faces of the result. Otherwise, triangles in one plane may be
            cut again, as with ``boundary="surface"`` of `delone.tetrahedralize`; no point is ever
            added on the surface.
        steinerleft : int, optional
            The maximum number of points that exist besides those of the input at any time; -1 for
            no limit of one's own.
        order : int, optional
            Must be 1.
        regionattrib : bool, optional
            Whether to return the label of the region of each tetrahedron.
        facesout : bool, optional
            Whether `trifaces` has all faces of tetrahedra, instead of those of the input.
        edgesout : bool, optional
            Without effect: `edges` has all edges.
        switches : str, optional
            TetGen's switches, which replace all other arguments: p is necessary; ``Y A S M O Q``
            and output switches are accepted; q, a and o2 are refused.
        bgmesh : optional
            Must be None.
        **others
            Further arguments of the package ``tetgen``; any but False, None and 0 is refused.

        Returns
        -------
        nodes : ndarray of float64, shape (n, 3)
            The vertices in their order, then the points added.
        elems : ndarray of int32, shape (m, 4)
            The tetrahedra.
        attributes : ndarray of float64, shape (m, 1) or (0, 0)
            The label of the region of each; regions without a label follow the largest one.
        triface_markers : ndarray of int32, shape (k,)
            The marker of each triangle in `trifaces`, 0 without one.

        Raises
        ------
        InputError
            An argument or switch is not supported.
        CrossingFacesError, OpenSurfaceError, CrowdedFacesError, BudgetExceededError
            And others, as for `delone.tetrahedralize`.

        Examples
        --------
        See `TetGen`.
        """
        if switches:
            limit, regionattrib, facesout, nobisect = _switched(switches)
        else:
            _refuse_quality(quality, order, bgmesh, others)
            if not as_flag(plc, name="plc"):
                raise InputError("plc must be True: delone.Delaunay triangulates points alone")
            limit = None if steinerleft < 0 else as_count(steinerleft, name="steinerleft")
        regions = [(*place, label) for label, place in self._regions]
        self.mesh = tetrahedralize(
            self.v,
            self.f,
            boundary="faces" if as_flag(nobisect, name="nobisect") else "surface",
            inside="enclosed",
            holes=self._holes or None,
            regions=regions or None,
            face_markers=self._markers,
            max_points=limit,
        )
        wanted = as_flag(regionattrib, name="regionattrib")
        labels = _labels(self.mesh, given=bool(regions)) if wanted else np.empty((0, 0))
        self._attributes = labels
        self._trifaces, self._triface_markers = _faces(self.mesh, everything=bool(facesout))
        return self.node, self.elem, self._attributes, self._triface_markers

    @property
    def _made(self) -> TetMesh:
        if self.mesh is None:
            raise InputError("there is no mesh yet: call tetrahedralize(quality=False)")
        return self.mesh

    @property
    def node(self) -> Floats:
        """The vertices, (n, 3)."""
        return self._made.points

    @property
    def elem(self) -> Indices:
        """The tetrahedra, (m, 4)."""
        return self._made.simplices

    @property
    def n_nodes(self) -> int:
        """Number of vertices."""
        return self._made.npoints

    @property
    def n_cells(self) -> int:
        """Number of tetrahedra."""
        return self._made.nsimplex

    @property
    def attributes(self) -> Floats:
        """The label of the region of each tetrahedron, (m, 1); (0, 0) without ``regionattrib``."""
        return self._attributes

    @property
    def trifaces(self) -> Indices:
        """The triangles, (k, 3): those of the input, or with ``facesout`` all."""
        return self._trifaces

    @property
    def triface_markers(self) -> Indices:
        """The marker of each of `trifaces`, (k,); 0 for none."""
        return self._triface_markers

    @property
    def face2tet(self) -> Indices:
        """The tetrahedra on both sides of each of `trifaces`, (k, 2); -1 for none."""
        return _sides(self._made, self._trifaces)

    @property
    def edges(self) -> Indices:
        """All edges, (e, 2)."""
        return self._made.edges

    @property
    def edge_markers(self) -> Indices:
        """1 for edges of triangles of the input, else 0, (e,)."""
        faces, edges, n = self._made.input_faces, self.edges, np.int64(self._made.npoints)
        pairs = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
        on = np.isin(edges[:, 0] * n + edges[:, 1], pairs[:, 0] * n + pairs[:, 1])
        return on.astype(np.int32)

    @property
    def grid(self) -> Any:
        """The mesh as a ``pyvista.UnstructuredGrid`` (extra ``pyvista``)."""
        return self._made.to_pyvista()


def _place(point: ArrayLike) -> Floats:
    array = as_plain_array(point, "point")
    if array.shape != (3,):
        raise ShapeError(f"a point must have shape (3,), got {array.shape}")
    found: Floats = as_points(array[None], ndim=3, name="point")[0]
    return found


def _refuse_quality(quality: bool, order: int, bgmesh: Any, others: dict[str, Any]) -> None:
    """Refuse arguments that ask for what is not supported."""
    if as_flag(quality, name="quality"):
        raise InputError(_QUALITY)
    if order != 1:
        raise InputError(_REFUSED["o"])
    if bgmesh is not None:
        raise InputError(f"bgmesh: {_QUALITY}")
    for name, value in others.items():
        if value is not None and not (np.isscalar(value) and not value):
            raise InputError(f"the argument {name} is not supported")


def _switched(switches: str) -> tuple[int | None, bool, bool, bool]:
    """Return the limit on points, whether regions and all faces are wanted, and all are kept."""
    rest = _SWITCH.sub("", switches)
    if rest:
        raise InputError(f"switches has {rest!r:.80}, which is not a switch")
    limit, known = None, []
    for letter, number in _SWITCH.findall(switches):
        known.append(letter)
        if letter in _REFUSED and not (letter == "o" and number in ("", "1")):
            raise InputError(f"the switch {letter} is not supported: {_REFUSED[letter]}")
        if letter == "S":
            limit = as_count(int(float(number or 0)), name="S")
        elif letter not in "pYAo" + _WITHOUT_EFFECT:
            raise InputError(f"the switch {letter} is not known")
    if "p" not in known:
        raise InputError("switches must contain p: delone.Delaunay triangulates points alone")
    # M: facets in one plane are not merged.
    return limit, "A" in known, "f" in known, "Y" in known or "M" in known


def _labels(mesh: TetMesh, *, given: bool) -> Floats:
    """Return labels of regions; those without one get numbers above the largest, or from 1 on."""
    if not given:
        return (mesh.region.astype(np.float64) + 1)[:, None]
    labels = mesh.region.astype(np.float64)
    rest = mesh.region < 0
    face = sides(mesh.simplices, mesh.input_faces, mesh.npoints).face
    _, number = np.unique(cells(mesh.neighbors, face >= 0)[rest], return_inverse=True)
    labels[rest] = labels.max(initial=0) + 1 + number
    return labels[:, None]


def _faces(mesh: TetMesh, *, everything: bool) -> tuple[Indices, Indices]:
    """Return faces with their markers: those of the input first, then all others."""
    faces, markers = mesh.input_faces, mesh.face_markers
    if not everything:
        return faces, markers
    n = np.int64(mesh.npoints)
    both = np.sort(np.concatenate((faces, mesh.faces)), axis=1).astype(np.int64)
    keys = np.column_stack((both[:, 0] * n + both[:, 1], both[:, 2]))
    _, first = np.unique(keys, axis=0, return_index=True)
    others = np.sort(first[first >= len(faces)]) - len(faces)
    return (
        np.concatenate((faces, mesh.faces[others])),
        np.concatenate((markers, np.zeros(len(others), dtype=np.int32))),
    )


def _sides(mesh: TetMesh, faces: Indices) -> Indices:
    """Return the tetrahedra on both sides of faces, -1 where there is none."""
    found = sides(mesh.simplices, faces, mesh.npoints)
    tetrahedron, corner = np.nonzero(found.face >= 0)
    face, out = found.face[tetrahedron, corner], found.out[tetrahedron, corner]
    both = np.full((len(faces), 2), -1, dtype=np.int32)
    both[face, (out < 0).astype(np.int64)] = tetrahedron
    return both
