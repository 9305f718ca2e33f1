"""Areas that cells share, in the plane and on the sphere, and the transfer of values."""

from delone.areal.overlaps import AreaWeights, OverlapReport, Overlaps

__all__ = ["AreaWeights", "OverlapReport", "Overlaps"]
