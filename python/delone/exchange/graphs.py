"""Graphs for other libraries: SciPy, NetworkX and libpysal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.extras import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Links", "to_csr", "to_libpysal", "to_networkx"]


class Links(NamedTuple):
    """Edges with weights."""

    edges: Indices  # (m, 2), each once
    weights: Floats  # (m,)
    npoints: int
    directed: bool

    def both_ways(self) -> tuple[Indices, Indices, Floats]:
        """Return tails, heads and weights; if undirected, of each edge and its reverse."""
        tail, head = self.edges.T
        if self.directed:
            return tail, head, self.weights
        ends = np.concatenate((tail, head)), np.concatenate((head, tail))
        return *ends, np.concatenate((self.weights, self.weights))


def to_csr(links: Links) -> Any:
    """Return a `scipy.sparse.csr_array`, (n, n), with sorted columns; zeros are stored."""
    sparse = require("scipy.sparse", extra="graph", what="a sparse matrix")
    tail, head, weights = links.both_ways()
    order = np.lexsort((head, tail))
    starts = np.zeros(links.npoints + 1, dtype=np.int64)
    np.cumsum(np.bincount(tail, minlength=links.npoints), out=starts[1:])
    if len(tail) < 2**31:
        starts = starts.astype(np.int32)
    shape = links.npoints, links.npoints
    return sparse.csr_array((weights[order], head[order], starts), shape=shape)


def to_networkx(links: Links, points: Floats) -> Any:
    """Return a `networkx.Graph`, or a `DiGraph` if edges have a direction."""
    networkx = require("networkx", extra="graph", what="a NetworkX graph")
    graph = networkx.DiGraph() if links.directed else networkx.Graph()
    graph.add_nodes_from((i, {"pos": tuple(p)}) for i, p in enumerate(points.tolist()))
    # NetworkX algorithms read the attribute weight by default, and count edges without it.
    rows = zip(*links.edges.T.tolist(), links.weights.tolist(), strict=True)
    graph.add_edges_from((a, b, {"length": w, "weight": w}) for a, b, w in rows)
    return graph


def to_libpysal(links: Links, nodes: NDArray[np.int64]) -> Any:
    """Return a `libpysal.graph.Graph` on the given rows, which have all edges."""
    libpysal = require("libpysal.graph", extra="graph", what="spatial weights of libpysal")
    tail, head, weights = links.both_ways()
    alone = np.setdiff1d(nodes, tail)
    # An isolate has itself as neighbor, with weight 0.
    tail, head = (np.concatenate((ends, alone)) for ends in (tail, head))
    weights = np.concatenate((weights, np.zeros(len(alone))))
    order = np.lexsort((head, tail))
    return libpysal.Graph.from_arrays(tail[order], head[order], weights[order])
