"""Saving and loading: NumPy's .npz files, with every array checked when it is read.

`file` writes and reads, `kinds` contains the layouts, `checks` the checks of their content.
"""

from delone._tiling.archive.file import read, refusal, write

__all__ = ["read", "refusal", "write"]
