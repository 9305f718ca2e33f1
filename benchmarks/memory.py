"""How much memory a call takes at its peak, beyond what the process holds before it.

On Linux the kernel's high-water mark is set back before the call, so that an earlier peak hides
nothing; elsewhere the mark only rises, and a call below an earlier peak counts as nothing.
"""

import contextlib
import resource
import sys
from pathlib import Path

RSS_UNIT = 1 if sys.platform == "darwin" else 1024
STATUS = Path("/proc/self/status")
RESET_PEAK = "5"


def start() -> int:
    """Set the high-water mark back where that is possible; return the bytes held now."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text(RESET_PEAK)
    return peak()


def peak() -> int:
    """Return the high-water mark of this process' memory in bytes."""
    if STATUS.exists():
        for line in STATUS.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * RSS_UNIT
