"""Clusters of 2-D and 3-D points by density: single linkage, DBSCAN and HDBSCAN.

Distances are compared exactly for the given doubles. Labels are numbered by the first row of each
cluster; noise is -1.
"""

from delone.cluster.dbscan import DBSCAN
from delone.cluster.hdbscan import HDBSCAN
from delone.cluster.linkage import SingleLinkage, single_linkage

__all__ = ["DBSCAN", "HDBSCAN", "SingleLinkage", "single_linkage"]
