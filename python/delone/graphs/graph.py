"""The class Graph: points and edges as immutable arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_flag, as_segments, as_text, require_finite
from delone._base.counting import counted, listed
from delone._base.duplicates import vertices_of
from delone._base.immutable import kept, own_copy, sealed
from delone._base.numbers import as_nonnegative, as_share
from delone._base.values import as_marks
from delone._tiling.complex import Exchanged, Stored
from delone.errors import InputError
from delone.graphs.coincident import clique, repeated
from delone.graphs.lengths import lengths_of, lowest, squares, up_to

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.graphs import Links
    from delone.exchange.parts import Parts

__all__ = ["Graph"]


class Graph(Stored, Exchanged):
    """Points, and edges between them.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
        Finite coordinates, in any unit. They are copied.
    edges : array_like of int, shape (m, 2)
        Pairs of rows of `points`, in any order; an edge given several times is one edge.
    directed : bool, optional
        Whether an edge leads from its first to its second row.
    kind : str, optional
        A name for the graph, for display only.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    edges : ndarray of int32, shape (m, 2)
        Each edge once, rows ascending; the smaller row first unless `directed`.
    duplicates : ndarray of int32, shape (k, 2)
        Rows that repeat the coordinates of earlier rows, and the first row of each.
    directed : bool
        Whether edges have a direction.
    kind : str
        The name of the graph.
    ndim, npoints, nedges : int
        Numbers of coordinates, points (including duplicates) and edges.

    Raises
    ------
    InputError
        An edge has a row that does not exist, or joins a row to itself.
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, 2) or (n, 3), or `edges` not one of pairs.

    Notes
    -----
    The functions of `delone.graphs` return graphs in which coincident rows are one vertex: the
    first one has the edges, the others are in `duplicates`. `components` counts them with their
    vertex, and `with_duplicates` joins them.

    Nothing is repaired: a graph may be disconnected, and ``repr`` shows the number of components.
    All arrays are read-only; attributes that are not listed above are computed on first use and
    kept.

    Examples
    --------
    >>> from delone.graphs import Graph
    >>> graph = Graph([(0, 0), (3, 4), (3, 0), (8, 8)], [(1, 0), (1, 2)])
    >>> graph
    <Graph of 4 points: 2 edges, 2 components>
    >>> graph.lengths, graph.degrees
    (array([5., 4.]), array([1, 2, 1, 0], dtype=int32))
    """

    __slots__ = ("_directed", "_duplicates", "_edges", "_kind", "_points")

    _directed: bool
    _duplicates: Indices
    _edges: Indices
    _kind: str
    _points: Floats

    def __init__(
        self, points: ArrayLike, edges: ArrayLike, *, directed: bool = False, kind: str = ""
    ) -> None:
        own, one_way = own_copy(points, ndim=None), as_flag(directed, name="directed")
        require_finite(own)
        as_text(kind, name="kind")
        pairs = as_segments(edges, len(own), name="edges")
        loops = np.flatnonzero(pairs[:, 0] == pairs[:, 1])
        if len(loops):
            raise InputError(f"edges: rows {listed(loops, 10)} join a point to itself")
        arrays = own, _ordered(pairs, one_way), repeated(own)
        self._set(*arrays, directed=one_way, kind=kind, workers=None)
        self._refer(points)

    def _set(self, points: Floats, edges: Indices, duplicates: Indices, **others: Any) -> None:
        """Set everything, including `directed`, `kind` and `workers`; then nothing can be set."""
        self._hold(
            points=sealed(points), edges=sealed(edges), duplicates=sealed(duplicates), **others
        )

    @classmethod
    def _made(
        cls,
        points: Floats,
        edges: Indices,
        duplicates: Indices,
        *,
        directed: bool = False,
        kind: str = "",
        workers: int | None = None,
    ) -> Self:
        """Return the graph of arrays that are already in the form of the attributes."""
        made = cls.__new__(cls)
        made._set(points, edges, duplicates, directed=directed, kind=kind, workers=workers)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), self._saved(), self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return {
            "points": self._points,
            "edges": self._edges,
            "duplicates": self._duplicates,
            "directed": np.array([self._directed]),
            "kind": np.array(self._kind),
        }

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls._made(
            arrays["points"],
            arrays["edges"],
            arrays["duplicates"],
            directed=bool(arrays["directed"][0]),
            kind=str(arrays["kind"]) if "kind" in arrays else "",
        )

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d)."""
        return self._points

    @property
    def edges(self) -> Indices:
        """Each edge once, (m, 2), rows ascending; the smaller row first unless `directed`."""
        return self._edges

    @property
    def duplicates(self) -> Indices:
        """Rows that repeat the coordinates of earlier rows, and the first of each, (k, 2)."""
        return self._duplicates

    @property
    def directed(self) -> bool:
        """Whether an edge leads from its first to its second row."""
        return self._directed

    @property
    def kind(self) -> str:
        """The name of the graph."""
        return self._kind

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2 or 3."""
        return int(self._points.shape[1])

    @property
    def npoints(self) -> int:
        """Number of points, including duplicates."""
        return len(self._points)

    @property
    def nedges(self) -> int:
        """Number of edges."""
        return len(self._edges)

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same coordinates."""
        return sealed(vertices_of(self._duplicates, self.npoints))

    @property
    @kept
    def lengths(self) -> Floats:
        """Lengths of the edges, (m,), with a relative error below 1e-15; inf beyond doubles."""
        return sealed(lengths_of(self._points, self._edges))

    @property
    @kept
    def squared_lengths(self) -> Floats:
        """Squared lengths of the edges, (m,), rounded; inf or 0 beyond the range of doubles."""
        return sealed(squares(self._points, self._edges))

    @property
    @kept
    def degrees(self) -> Indices:
        """Number of edges at each point, (n,); of a directed graph, those that leave it."""
        ends = self._edges[:, 0] if self._directed else self._edges.ravel()
        return sealed(np.bincount(ends, minlength=self.npoints).astype(np.int32))

    @kept
    def components(self) -> Indices:
        """Number the connected components; directions of edges do not count.

        Returns
        -------
        ndarray of int32, shape (n,)
            The component of each point. Components are numbered from 0 by their first rows; a
            duplicate is in that of its vertex.

        Notes
        -----
        By union-find (R. E. Tarjan, 1975), in almost linear time.

        Examples
        --------
        >>> from delone.graphs import Graph
        >>> Graph([(0, 0), (5, 5), (1, 0), (5, 5)], [(0, 2)]).components()
        array([0, 1, 0, 1], dtype=int32)
        """
        pairs = np.ascontiguousarray(np.concatenate((self._edges, self._duplicates)))
        return sealed(_core.graph_components(pairs, self.npoints))

    @property
    def ncomponents(self) -> int:
        """Number of connected components."""
        return int(self.components().max(initial=-1)) + 1

    def prune(self, *, max_length: float | None = None, percentile: float | None = None) -> Self:
        """Return the graph without its long edges.

        Parameters
        ----------
        max_length : float, optional
            The largest length that remains, in the unit of the points.
        percentile : float, optional
            Above 0, up to 100: the percentile of the lengths up to which edges remain (the smallest
            length at or above this rank).

        Returns
        -------
        Graph
            The same points, and the edges that are not longer. Points may become isolated; no
            points are removed.

        Raises
        ------
        InputError
            Not exactly one of the two is given, `max_length` is negative or NaN, or `percentile`
            is out of range.

        Notes
        -----
        Exact: lengths near the limit are compared as fractions. O(m) time, plus a sort.

        Examples
        --------
        >>> from delone.graphs import Graph
        >>> graph = Graph([(0, 0), (1, 0), (3, 0), (9, 0)], [(0, 1), (1, 2), (2, 3)])
        >>> graph.prune(max_length=2).nedges, graph.prune(percentile=34).nedges
        (2, 2)
        """
        if (max_length is None) == (percentile is None):
            raise InputError("prune needs one of max_length= and percentile=")
        if max_length is not None:
            limit = as_nonnegative(max_length, name="max_length")
            return self._with(up_to(self._points, self._edges, limit, self._workers))
        share = as_share(percentile, name="percentile", most=100)
        return self._with(lowest(self._points, self._edges, self.lengths, share))

    def subgraph(self, rows: ArrayLike) -> Self:
        """Return the graph of some of the points, with the edges between them.

        Parameters
        ----------
        rows : array_like of int, shape (k,), or of bool, shape (n,)
            The rows of the points to keep, each once, or True for them.

        Returns
        -------
        Graph
            Point i is ``points[rows[i]]``. Where coincident rows are kept, the first one of them in
            the new order is the vertex and has their edges.

        Raises
        ------
        InputError
            A row does not exist, or is given twice.
        ShapeError, DtypeError
            `rows` is not a list of integers, or of one boolean for each point.

        Examples
        --------
        >>> from delone.graphs import Graph
        >>> graph = Graph([(0, 0), (1, 0), (3, 0), (9, 0)], [(0, 1), (1, 2), (2, 3)])
        >>> graph.subgraph([3, 2, 0]).edges
        array([[0, 1]], dtype=int32)
        """
        chosen = _as_rows(rows, self.npoints)
        points = np.ascontiguousarray(self._points[chosen])
        place = np.full(self.npoints, -1, dtype=np.int32)
        place[chosen] = np.arange(len(chosen), dtype=np.int32)
        # A vertex and the first of its duplicates in the new order are exchanged.
        vertex, at = np.unique(self.duplicate_of[chosen], return_index=True)
        first = chosen[at]
        place[vertex], place[first] = place[first], place[vertex]
        ends = place[self._edges]
        edges = _ordered(ends[(ends >= 0).all(axis=1)], self._directed)
        return self._made(
            points,
            edges,
            repeated(points),
            directed=self._directed,
            kind=self._kind,
            workers=self._workers,
        )._refer(self)

    def with_duplicates(self, how: str = "star") -> Self:
        """Return the graph with edges at rows that repeat the coordinates of others.

        Parameters
        ----------
        how : {"star", "clique"}, optional
            ``"star"`` joins each duplicate to its vertex, by an edge of length zero. ``"clique"``
            joins all coincident rows to each other, and all of them to the neighbors of their
            vertex.

        Returns
        -------
        Graph
            The same points and more edges, or the same graph if no rows coincide. In a directed
            graph the new edges of length zero lead in both directions.

        Raises
        ------
        InputError
            `how` is not one of its choices.

        Notes
        -----
        With ``"star"``, a spanning tree of the distinct points becomes one of all rows. With
        ``"clique"``, k coincident rows have k (k - 1) / 2 edges between them.

        Examples
        --------
        >>> from delone.graphs import minimum_spanning_tree
        >>> tree = minimum_spanning_tree([(0, 0), (1, 0), (0, 0)])
        >>> tree.edges.tolist(), tree.with_duplicates().edges.tolist()
        ([[0, 1]], [[0, 1], [0, 2]])
        """
        as_choice(how, ("star", "clique"), name="how")
        if not len(self._duplicates):
            return self
        if how == "star":
            added = self._duplicates[:, ::-1]
            if self._directed:
                added = np.concatenate((added, self._duplicates))
            return self._with(np.concatenate((self._edges, added)))
        return self._with(clique(self._edges, self.duplicate_of))

    def to_csr(self, *, weights: str = "length") -> Any:
        """Convert to a SciPy sparse matrix (extra ``graph``).

        Parameters
        ----------
        weights : {"length", "binary"}, optional
            The entries: lengths of edges, or ones. An edge of length zero is stored as an explicit
            0.

        Returns
        -------
        scipy.sparse.csr_array, shape (n, n)
            Symmetric unless the graph is directed; row i contains the neighbors of point i,
            ascending.

        Raises
        ------
        MissingExtraError
            SciPy is not installed.
        InputError
            `weights` is not one of its choices.

        Examples
        --------
        >>> from delone.graphs import Graph
        >>> Graph([(0, 0), (3, 4), (1, 0)], [(0, 1)]).to_csr().toarray()
        array([[0., 5., 0.],
               [5., 0., 0.],
               [0., 0., 0.]])
        """
        from delone.exchange.graphs import to_csr

        return to_csr(self._links(weights))

    def to_networkx(self) -> Any:
        """Convert to a NetworkX graph (extra ``graph``).

        Returns
        -------
        networkx.Graph or networkx.DiGraph
            Nodes are the rows from 0, including duplicates, with their coordinates as attribute
            ``pos``; edges have their ``length``, also as ``weight``, the default of most NetworkX
            algorithms.

        Raises
        ------
        MissingExtraError
            NetworkX is not installed.

        Examples
        --------
        >>> from delone.graphs import Graph
        >>> Graph([(0, 0), (3, 4), (1, 0)], [(0, 1)]).to_networkx().edges[0, 1]
        {'length': 5.0, 'weight': 5.0}
        """
        from delone.exchange.graphs import to_networkx

        return to_networkx(self._links("length"), self._points)

    def to_libpysal(self, *, coincident: str = "raise", weights: str = "binary") -> Any:
        """Convert to libpysal spatial weights (extra ``graph``).

        Parameters
        ----------
        coincident : {"raise", "clique", "drop"}, optional
            What to do with rows that repeat the coordinates of others: ``"raise"`` raises an error;
            ``"clique"`` joins them as in `with_duplicates`; ``"drop"`` leaves them out, and the
            identifiers of the others are still their rows.
        weights : {"binary", "length"}, optional
            The weights of neighbors: ones, or the lengths of edges.

        Returns
        -------
        libpysal.graph.Graph
            Focal and neighbor are rows of `points`; a point without edges is an isolate.

        Raises
        ------
        MissingExtraError
            libpysal is not installed.
        InputError
            Rows coincide and `coincident` is ``"raise"``; or an argument is not one of its choices.

        Examples
        --------
        >>> from delone.graphs import gabriel
        >>> graph = gabriel([(0, 0), (1, 0), (9, 1)])
        >>> w = graph.to_libpysal()  # doctest: +SKIP
        >>> w.cardinalities.tolist()  # doctest: +SKIP
        [1, 2, 1]
        """
        from delone.exchange.graphs import to_libpysal

        as_choice(coincident, ("raise", "clique", "drop"), name="coincident")
        rows = self._duplicates[:, 0]
        if coincident == "raise" and len(rows):
            raise InputError(
                f"{counted(len(rows), 'row')} of points repeat others: {listed(rows, 10)}; choose "
                "coincident='clique' or 'drop'"
            )
        graph = self.with_duplicates("clique") if coincident == "clique" else self
        nodes = np.arange(self.npoints)
        if coincident == "drop":
            graph = self._with(self._edges[~np.isin(self._edges, rows).any(axis=1)])
            nodes = np.setdiff1d(nodes, rows)
        return to_libpysal(graph._links(weights), nodes)

    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Convert to a table of lines (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each edge. The geometry of a GeoDataFrame is
            replaced; its reference system and index are kept.
        crs : optional
            Reference system of the coordinates, in any form that geopandas accepts.

        Returns
        -------
        geopandas.GeoDataFrame
            One row for each edge: the rows ``v0`` and ``v1`` of its ends, its ``length``, and a
            line.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            `data` does not have one row for each edge.

        Examples
        --------
        >>> from delone.graphs import Graph
        >>> frame = Graph([(0, 0), (3, 4)], [(0, 1)]).to_geopandas(crs="EPSG:28992")
        >>> frame.length.tolist(), str(frame.geometry[0])
        ([5.0], 'LINESTRING (0 0, 3 4)')
        """
        from delone.exchange.geopandas import to_geopandas

        return to_geopandas(self._parts(), crs, data)

    def _with(self, edges: Indices) -> Self:
        """Return the graph of other edges between the same points."""
        return self._made(
            self._points,
            _ordered(edges, self._directed),
            self._duplicates,
            directed=self._directed,
            kind=self._kind,
            workers=self._workers,
        )._refer(self)

    def _links(self, weights: str) -> Links:
        """Return the edges with weights for other libraries."""
        from delone.exchange.graphs import Links

        as_choice(weights, ("length", "binary"), name="weights")
        values = self.lengths if weights == "length" else np.ones(self.nedges)
        return Links(self._edges, values, self.npoints, self._directed)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        values = {"length": self.lengths}
        return Parts(self._points, self._edges, of_simplices=values, crs=self.crs)

    def _described(self) -> str:
        points = counted(self.npoints, "point")
        if duplicates := len(self._duplicates):
            points += f" ({counted(duplicates, 'duplicate')})"
        kind = f"{self._kind}, " if self._kind else ""
        edges = counted(self.nedges, "directed edge" if self._directed else "edge")
        return f"{points}: {kind}{edges}, {counted(self.ncomponents, 'component')}"


def _unpickled(kind: type[Graph], arrays: dict[str, NDArray[Any]], workers: int | None) -> Graph:
    made = kind._loaded(arrays)
    object.__setattr__(made, "_workers", workers)
    return made


def _ordered(pairs: Indices, directed: bool) -> Indices:
    """Return each pair once, rows ascending, the smaller row first unless directed."""
    if not directed:
        pairs = np.sort(pairs, axis=1)
    keys = pairs[:, 0].astype(np.int64) << 32 | pairs[:, 1].astype(np.int64)
    keys = np.unique(keys)
    return np.column_stack((keys >> 32, keys & 0xFFFFFFFF)).astype(np.int32)


def _as_rows(rows: ArrayLike, npoints: int) -> NDArray[np.int64]:
    """Return the rows of points to keep, each at most once."""
    marks = as_marks(rows, npoints, name="rows", of="points")
    array = np.asarray(rows)
    if array.dtype.kind == "b":
        return np.flatnonzero(marks)
    found = array.astype(np.int64)
    if np.count_nonzero(marks) < len(found):
        repeats = np.flatnonzero(np.bincount(found) > 1)
        raise InputError(f"rows are given more than once: {listed(repeats, 10)}")
    return found
