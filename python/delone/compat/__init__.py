"""Drop-in replacements: the interfaces of SciPy and of the package triangle.

Each module is called after the package whose place it takes: `delone.compat.scipy` for
``scipy.spatial`` and the interpolators of ``scipy.interpolate``, `delone.compat.triangle` for
``triangle``.
"""

from __future__ import annotations
