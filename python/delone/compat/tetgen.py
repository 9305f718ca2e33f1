"""Drop-in replacement for the package ``tetgen``: its class, with `delone.tetrahedralize` inside.

That package wraps H. Si's program TetGen. Here the names are the same, but delone does the work; no
code of either is used. Coplanar triangles may be retriangulated, and triangles are divided if the
volumes of tetrahedra are bounded, except with TetGen's switch Y. Other points are only added
strictly between the triangles.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_count, as_flag, as_plain_array, as_points, wrong_shape
from delone._base.atomic import replacing
from delone._base.numbers import as_nonnegative
from delone._tiling.space.locking import cells, sides
from delone.compat.tetgen_sizes import background
from delone.compat.tetgen_switches import Wishes, of_arguments, of_switches
from delone.errors import DtypeError, FileFormatError, InputError
from delone.exchange.parts import Parts
from delone.exchange.pyvista import to_pyvista
from delone.exchange.second import of_order
from delone.io.tetgen import SECOND
from delone.solids.surface import check_surface
from delone.solids.surface.check import as_faces
from delone.solids.tetmesh.tetmesh import TetMesh
from delone.solids.tetrahedra.arguments import given
from delone.solids.tetrahedra.filling import tetrahedralize

if TYPE_CHECKING:
    import os

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["MeshNotTetrahedralizedError", "TetGen"]

# The marker of input faces and edges without a given marker.
_UNMARKED = -1


class MeshNotTetrahedralizedError(InputError, RuntimeError):
    """There is no result yet: call `TetGen.tetrahedralize` first."""


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
    tetmesh : TetMesh or None
        The result as delone's own class, after `tetrahedralize`; the package lacks this attribute.

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
    ((1, 4), [-1, -1, -1, -1])
    >>> tet.tetmesh
    <TetMesh of 4 points: 1 tetrahedron>
    """

    def __init__(self, *args: Any) -> None:
        if not 1 <= len(args) <= 3:
            raise DtypeError(
                f"give a surface, or vertices and triangles; got {len(args)} arguments"
            )
        surface, faces, markers = (*args, None, None)[:3]
        found = given(surface, faces, markers, None, None)
        self.v, self.f = as_faces(found.points, found.faces)
        self.tetmesh: TetMesh | None = None
        self._markers = found.markers
        self._holes: list[Floats] = [] if found.holes is None else list(np.asarray(found.holes))
        self._regions: list[tuple[int, Floats]] = []
        # The largest volumes in regions, by label.
        self._volumes: dict[int, float] = {}
        for x, y, z, number in () if found.regions is None else np.asarray(found.regions).tolist():
            self.add_region(int(number), (x, y, z))
        self._attributes = np.empty((0, 0))
        self._trifaces = np.empty((0, 3), dtype=np.int32)
        self._triface_markers = np.empty(0, dtype=np.int32)
        self._every_edge = False
        self._second = False

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
            The largest volume of a tetrahedron in the region; 0 for none. It has an effect with
            ``quality=True``, or with the switch ``a`` without a number.

        Raises
        ------
        InputError
            `max_vol` or the label is negative.
        ShapeError, DtypeError
            `point_in_region` is not a point.

        Examples
        --------
        See `TetGen`.
        """
        volume = as_nonnegative(max_vol, name="max_vol")
        label = as_count(id, name="id")
        self._regions.append((label, _place(point_in_region)))
        if volume:
            self._volumes[label] = min(volume, self._volumes.get(label, volume))

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
        nomergefacet: bool = False,
        **others: Any,
    ) -> tuple[Floats, Indices, Floats, Indices]:
        """Fill the surface with tetrahedra.

        Everything that the triangles enclose is filled, except holes, whatever the orientation of
        the triangles.

        Parameters
        ----------
        plc : bool, optional
            Must be True: the triangles are faces of the result.
        quality : bool, optional
            Whether points are added for shapes, and slivers are removed.
        minratio, mindihedral : float, optional
            With `quality`, the bound on the circumradius divided by the shortest edge, and the goal
            for the smallest dihedral angle in degrees; 0 for 20 degrees.
        nobisect : bool, optional
            Whether all triangles are faces of the result. Otherwise, triangles in one plane may be
            cut again, as with ``boundary="surface"`` of `delone.tetrahedralize`, and points are
            added on the surface where quality or volumes require it.
        steinerleft : int, optional
            The maximum number of points that are added for shapes and volumes, and of points
            besides the input at any earlier time; -1 for the default limit.
        order : {1, 2}, optional
            With 2, `node` also contains the midpoints of edges, and rows of `elem` have ten nodes,
            in TetGen's order; those of `grid` are in VTK's order.
        regionattrib : bool, optional
            Whether to return the label of the region of each tetrahedron.
        facesout : bool, optional
            Whether `trifaces` contains all faces of tetrahedra, instead of those of the input.
        edgesout : bool, optional
            Whether `edges` contains all edges, instead of those of input faces.
        switches : str, optional
            TetGen's switches, which replace all other arguments: p is necessary; ``q1.4/20 a0.1 Y
            A S M O o2 f e Q`` and those of output are accepted, and m with a background mesh; r is
            rejected.
        bgmesh : pyvista.UnstructuredGrid or tuple of three arrays, optional
            A background mesh: tetrahedra with the point data ``"target_size"``, or ``(points,
            simplices, lengths)`` with shapes (k, 3), (j, 4) and (k,). The lengths are used like
            `size` of `delone.tetrahedralize`: they are interpolated linearly inside each
            tetrahedron, and outside the mesh, the length at its nearest position applies. Unless
            `nobisect` is True, points are also added on the surface to reach these lengths.
        nomergefacet : bool, optional
            The same as `nobisect`: coplanar triangles are not merged.
        **others
            Further arguments of the package ``tetgen``: `bgmeshfilename`, the path of a background
            mesh without the suffixes .node, .ele and .mtr; `fixedvolume` and `maxvolume`, the
            largest volume of a tetrahedron; `varvolume`, whether those of regions apply without
            `quality`. Those for output, silence and checks, and those that choose between
            algorithms, have no effect; others must have their defaults.

        Returns
        -------
        nodes : ndarray of float64, shape (n, 3)
            The vertices in their order, then the added points; with ``order=2``, then the midpoints
            of edges.
        elems : ndarray of int32, shape (m, 4) or (m, 10)
            The tetrahedra.
        attributes : ndarray of float64, shape (m, 1) or (0, 0)
            The label of the region of each; regions without a label get numbers after the largest
            one.
        triface_markers : ndarray of int32, shape (k,)
            The marker of each triangle in `trifaces`: -1 if none were given, 0 for other faces.

        Raises
        ------
        InputError
            An argument or switch is not supported; the message says why, and what to do.
        DtypeError
            An argument is unknown.
        CrossingFacesError, OpenSurfaceError, CrowdedFacesError, BudgetExceededError
            These and others, as for `delone.tetrahedralize`.

        Examples
        --------
        See `TetGen`.
        """
        sizes = background(bgmesh, others.pop("bgmeshfilename", ""))
        wishes = (
            of_switches(switches, sized=sizes is not None)
            if switches
            else of_arguments(
                plc=plc,
                quality=quality,
                minratio=minratio,
                mindihedral=mindihedral,
                nobisect=nobisect,
                steinerleft=steinerleft,
                order=order,
                regionattrib=regionattrib,
                facesout=facesout,
                edgesout=edgesout,
                sized=sizes is not None,
                nomergefacet=nomergefacet,
                others=others,
            )
        )
        regions = [(*place, label) for label, place in self._regions]
        self.tetmesh = tetrahedralize(
            self.v,
            self.f,
            boundary="faces" if wishes.whole else "surface",
            inside="enclosed",
            holes=self._holes or None,
            regions=regions or None,
            face_markers=self._markers,
            **self._bounds(wishes) | ({"size": sizes} if wishes.sized else {}),
            max_points=wishes.limit,
        )
        made = self.tetmesh
        self._attributes = np.empty((0, 0))
        if wishes.regions:
            self._attributes = _labels(made, given=bool(regions))
        self._every_edge, self._second = wishes.edges, wishes.second
        unmarked = _UNMARKED if self._markers is None else None
        self._trifaces, self._triface_markers = _faces(made, wishes.faces, unmarked)
        return self.node, self.elem, self._attributes, self._triface_markers

    def _bounds(self, wishes: Wishes) -> dict[str, Any]:
        """Return the bounds on shapes and volumes, as arguments of `delone.tetrahedralize`."""
        volumes: Any = wishes.volume or None
        if self._volumes and (wishes.quality or wishes.by_region):
            labels = {label for label, _ in self._regions}
            every = dict.fromkeys(labels, wishes.volume) if wishes.volume else {}
            volumes = every | {
                label: min(volume, every.get(label, volume))
                for label, volume in self._volumes.items()
            }
        if not wishes.quality:
            # Volumes alone: shapes are not improved.
            return {} if volumes is None else {"max_volume": volumes}
        angle = {"min_angle": wishes.angle} if wishes.angle else {}
        return {"max_volume": volumes, "radius_edge": max(wishes.ratio, 1.0)} | angle

    @property
    def _made(self) -> TetMesh:
        if self.tetmesh is None:
            raise MeshNotTetrahedralizedError(
                "the surface has not been filled: call tetrahedralize() first"
            )
        return self.tetmesh

    @property
    def is_tetrahedralized(self) -> bool:
        """Whether `tetrahedralize` has made a mesh."""
        return self.tetmesh is not None

    @property
    def mesh(self) -> Any:
        """The given surface, a ``pyvista.PolyData`` (extra ``pyvista``)."""
        return to_pyvista(Parts(self.v, self.f))

    @property
    def node(self) -> Floats:
        """The vertices, (n, 3); with ``order=2``, also the midpoints of edges."""
        made = self._made
        return self._second_order(made).points if self._second else made.points

    @property
    def elem(self) -> Indices:
        """The tetrahedra, (m, 4) or (m, 10)."""
        made = self._made
        return self._second_order(made).simplices[:, SECOND] if self._second else made.simplices

    @staticmethod
    def _second_order(made: TetMesh) -> Parts:
        return of_order(Parts(made.points, made.simplices), 2)

    @property
    def n_nodes(self) -> int:
        """Number of rows of `node`."""
        return len(self.node)

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
        """The triangles, (k, 3): those of the input, or all with ``facesout``."""
        _ = self._made
        return self._trifaces

    @property
    def triface_markers(self) -> Indices:
        """The marker of each of `trifaces`, (k,): -1 without markers, 0 for other faces."""
        _ = self._made
        return self._triface_markers

    @property
    def face2tet(self) -> Indices:
        """The tetrahedra on both sides of each of `trifaces`, (k, 2); -1 for none."""
        return _sides(self._made, self.trifaces)

    @property
    def edges(self) -> Indices:
        """The edges of input faces, (e, 2), or all edges with ``edgesout``."""
        found = self._made.edges
        return found if self._every_edge else found[self._of_input(found)]

    @property
    def edge_markers(self) -> Indices:
        """-1 for edges of input triangles, otherwise 0, (e,)."""
        return np.where(self._of_input(self.edges), _UNMARKED, 0).astype(np.int32)

    def _of_input(self, edges: Indices) -> NDArray[np.bool_]:
        """Whether each edge belongs to a triangle of the input."""
        faces, n = self._made.input_faces, np.int64(self._made.npoints)
        pairs = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
        found: NDArray[np.bool_] = np.isin(
            edges[:, 0] * n + edges[:, 1], pairs[:, 0] * n + pairs[:, 1]
        )
        return found

    @property
    def grid(self) -> Any:
        """The mesh as a ``pyvista.UnstructuredGrid`` (extra ``pyvista``)."""
        return self._made.to_pyvista(order=2 if self._second else 1)

    def write(self, filename: str | os.PathLike[str], binary: bool = True) -> None:
        """Write `grid` to a VTK file (extra ``pyvista``).

        Parameters
        ----------
        filename : str or path-like
            A file that ends in .vtk or .vtu.
        binary : bool, optional
            Whether the file is binary instead of text.

        Raises
        ------
        MeshNotTetrahedralizedError
            There is no mesh yet.
        FileFormatError
            The file has another suffix.
        FileNotFoundError, OutputError
            There is no such folder, or the file cannot be written.
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> from delone.compat import tetgen
        >>> v = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> tet = tetgen.TetGen(v, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
        >>> _ = tet.tetrahedralize(quality=False)
        >>> tet.write("grid.vtu")  # doctest: +SKIP
        """
        path = Path(filename)
        if path.suffix.lower() not in (".vtk", ".vtu"):
            raise FileFormatError(
                f"{path}: write writes .vtk and .vtu; delone.io.write_mesh(path, tet.tetmesh) "
                "writes other formats"
            )
        grid = self.grid
        with replacing(path) as temporary:
            grid.save(temporary, binary=as_flag(binary, name="binary"))

    def plot(self, **options: Any) -> Any:
        """Display the given surface (extra ``pyvista``).

        Parameters
        ----------
        **options
            Arguments of `pyvista.plot`.

        Returns
        -------
        object
            What PyVista returns.

        Raises
        ------
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> from delone.compat import tetgen
        >>> v = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> tet = tetgen.TetGen(v, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
        >>> tet.plot(show_edges=True)  # doctest: +SKIP
        """
        return self.mesh.plot(**options)


def _place(point: ArrayLike) -> Floats:
    array = as_plain_array(point, "point")
    if array.shape != (3,):
        raise wrong_shape("a point", "(3,)", array)
    found: Floats = as_points(array[None], ndim=3, name="point")[0]
    return found


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


def _faces(mesh: TetMesh, everything: bool, unmarked: int | None) -> tuple[Indices, Indices]:
    """Return faces with their markers: those of the input first, then all others."""
    faces, markers = mesh.input_faces, mesh.face_markers
    if unmarked is not None:
        markers = np.full_like(markers, unmarked)
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
