"""Tetrahedra inside surfaces of triangles, all of which are kept.

`filling` contains the function `tetrahedralize`, `sources` what it accepts besides arrays,
`covering` how often faces cover their parts, `inside` winding numbers of cells, `seeds` holes and
regions.
"""

from delone.solids.tetrahedra.filling import tetrahedralize

__all__ = ["tetrahedralize"]
