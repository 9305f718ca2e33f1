"""Drop-in replacements: for SciPy and the package triangle.

Each module is named after the package that it replaces: `delone.compat.scipy` for ``scipy.spatial``
and the interpolators of ``scipy.interpolate``, `delone.compat.triangle` for ``triangle``.
"""

from __future__ import annotations
