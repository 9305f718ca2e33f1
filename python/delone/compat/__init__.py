"""Drop-ins: the names and habits of other packages over delone's triangulations.

Each module is called after the package whose place it takes: `delone.compat.scipy` for
``scipy.spatial`` and the interpolators of ``scipy.interpolate``, `delone.compat.triangle` for
``triangle``.
"""

from __future__ import annotations
