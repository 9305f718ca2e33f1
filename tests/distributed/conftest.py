"""What tests of tiles share: triangles in one order, a small survey."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

pytest.importorskip("pyarrow")

if TYPE_CHECKING:
    from collections.abc import Callable


@pytest.fixture
def canonical() -> Callable[[Any], Any]:
    """Triangles from their smallest corner on, in lexicographic order."""

    def canonical(simplices: Any) -> Any:
        s = np.asarray(simplices, dtype=np.int64)
        k = s.argmin(axis=1)
        turned = np.stack([s[np.arange(len(s)), (k + j) % 3] for j in range(3)], axis=1)
        return turned[np.lexsort(turned.T[::-1])]

    return canonical
