"""What hands a mesh over to other libraries, in their own kinds of meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.refine.meshed import Mesh

__all__ = ["HandedOver"]


class HandedOver:
    """A mesh of triangles for others; the base of `delone.Mesh`."""

    __slots__ = ()

    @property
    def _mesh(self) -> Mesh:
        return cast("Mesh", self)

    def to_meshio(self) -> Any:
        """Return the mesh as a mesh of meshio.

        Returns
        -------
        meshio.Mesh
            Triangles, and segments as lines, with ``region`` and ``marker`` as their values, and
            again as tags of gmsh: regions from 1 on, markers as they are.

        Raises
        ------
        MissingExtraError
            The library is not installed (extra ``mesh``).

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> delone.mesh(square).to_meshio().cells_dict["triangle"].shape
        (2, 3)
        """
        from delone.exchange.meshio import to_meshio

        return to_meshio(self._mesh._parts())

    def to_skfem(self) -> Any:
        """Return the mesh as a mesh of scikit-fem.

        Returns
        -------
        skfem.MeshTri
            With subdomains ``"region 0"`` and so on, and boundaries ``"marker 0"`` and so on, which
            are the segments by their markers.

        Raises
        ------
        MissingExtraError
            The library is not installed (extra ``fem``).

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> delone.mesh(square).to_skfem().nelements
        2
        """
        from delone.exchange.skfem import to_skfem

        return to_skfem(self._mesh._parts())

    def to_dolfinx_arrays(self) -> dict[str, NDArray[Any]]:
        """Return the mesh as the arrays of which DOLFINx makes one.

        Returns
        -------
        dict of ndarray
            ``cells`` and ``x`` for ``dolfinx.mesh.create_mesh``, ``cell_tags`` (regions),
            ``facets`` (segments as pairs of points) and ``facet_tags`` (markers).

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> sorted(delone.mesh(square).to_dolfinx_arrays())
        ['cell_tags', 'cells', 'facet_tags', 'facets', 'x']
        """
        from delone.exchange.dolfinx import to_dolfinx_arrays

        return to_dolfinx_arrays(self._mesh._parts())

    def to_pyvista(self) -> Any:
        """Return the mesh as a surface of PyVista.

        Returns
        -------
        pyvista.PolyData
            In the plane z = 0, with ``region`` of triangles and ``marker`` of points.

        Raises
        ------
        MissingExtraError
            The library is not installed (extra ``pyvista``).

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> delone.mesh(square).to_pyvista().n_cells
        2
        """
        from delone.exchange.pyvista import to_pyvista

        return to_pyvista(self._mesh._parts())

    def to_matplotlib(self) -> Any:
        """Return the mesh as a triangulation of matplotlib.

        Returns
        -------
        matplotlib.tri.Triangulation
            For ``tripcolor``, ``tricontour`` and their like.

        Raises
        ------
        MissingExtraError
            The library is not installed (extra ``plot``).

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> delone.mesh(square).to_matplotlib().triangles.shape
        (2, 3)
        """
        from delone.exchange.matplotlib import to_matplotlib

        return to_matplotlib(self._mesh._parts())
