"""Drop-in replacements: for SciPy and the packages triangle and tetgen.

Each module is named after the package that it replaces: `delone.compat.scipy` for ``scipy.spatial``
and the interpolators of ``scipy.interpolate``, `delone.compat.triangle` for ``triangle``,
`delone.compat.tetgen` for ``tetgen``.
"""

from __future__ import annotations
