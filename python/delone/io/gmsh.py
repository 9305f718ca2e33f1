"""The part of an MSH file that meshio gets: the needed sections, with every count verified.

meshio allocates memory for what a count declares, and loops that many times, even if the file ends
before. So the other sections (periodic links, further views) are left out, and the blocks of nodes
and elements are first traversed here, in versions 2, 4.0 and 4.1, text and binary. `gmsh_groups`
reads the names of physical groups, and which entities are in them.
"""

from __future__ import annotations

import mmap
import re
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError
from delone.io.counts import announced
from delone.io.numbered import parsed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

__all__ = ["Bytes", "Checked", "Words", "needed_sections", "spans"]

# The number of nodes of an element, by Gmsh's type number.
_NODES = {
    **{1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 12: 27, 13: 18},
    **{14: 14, 15: 1, 16: 8, 17: 20, 18: 15, 19: 13, 21: 10, 23: 15, 25: 21, 26: 4, 27: 5},
    **{28: 6, 29: 20, 30: 35, 31: 56, 36: 16, 37: 25, 38: 36, 42: 28, 92: 64, 93: 125},
}
# A node in a binary file of version 2 or 4.0.
_NODE = np.dtype([("number", "<i4"), ("place", "<f8", 3)])
_LONGEST_COUNT = 1 << 8
_COUNT = re.compile(rb"\s*(\d+)\s*")
_LINE = re.compile(rb"^\$([^\n]*)\n?", re.MULTILINE)


@contextmanager
def needed_sections(path: Path, attributes: Sequence[str] | None) -> Iterator[Path]:
    """Yield a file with the needed sections: the file itself, or a temporary copy of these.

    Point values are needed if `attributes` contains their name, or is None.
    """
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        found = spans(content, path)
        named = [span for span in found if span[0] != "Comments"]
        if not named or named[0][0] != "MeshFormat":
            raise FileFormatError(f"{path} does not begin with $MeshFormat: it is not a .msh file")
        checked = Checked(path, content[named[0][2] : named[0][3]])
        kept = [(named[0][1], named[0][4])]
        for name, start, body, stop, end in named[1:]:
            wanted = name in ("Nodes", "Elements")
            if wanted:
                checked.section(name, content[body:stop])
            elif attributes != () and name == "NodeData":
                named_so = checked.view(content[body:stop])
                wanted = attributes is None or named_so in attributes
            if wanted:
                kept.append((start, end))
        if len(kept) == len(found):
            yield path
            return
        with tempfile.TemporaryDirectory(prefix="delone-") as folder:
            copy = Path(folder) / "sections.msh"
            with copy.open("wb") as target:
                for start, end in kept:
                    target.write(content[start:end])
            yield copy


def spans(content: mmap.mmap, path: Path) -> list[tuple[str, int, int, int, int]]:
    """Return the name of each section, and where it, its body, its last line and the rest begin."""
    found, at = [], 0
    # Each step advances by a section or ends with an error.
    while at < len(content):
        head = _LINE.search(content, at)
        if content[at : head.start() if head else len(content)].strip():
            raise FileFormatError(f"{path} has text between its sections: it is not a .msh file")
        if head is None:
            break
        name = head[1].decode("utf-8", errors="replace").strip()
        stop, at = _end(content, name, head.end(), path)
        found.append((name, head.start(), head.end(), stop, at))
    return found


def _end(content: mmap.mmap, name: str, at: int, path: Path) -> tuple[int, int]:
    """Return where the last line of a section begins and ends, as meshio finds it."""
    word = f"$End{name}"
    # Each step advances by a line.
    while (found := content.find(word.encode(), at)) >= 0:
        start, end = content.rfind(b"\n", 0, found) + 1, content.find(b"\n", found) + 1
        at = end or len(content)
        if content[start:at].decode("utf-8", errors="replace").strip() == word:
            return start, at
    raise FileFormatError(f"{path} has no {word:.60} at its end: it is truncated")


class Checked:
    """The version of a file, and its sections compared with what they declare."""

    def __init__(self, path: Path, head: bytes) -> None:
        self.path = path
        line = head.partition(b"\n")[0].decode("utf-8", errors="replace")
        self.version, binary, size = [*line.split(), "", "", ""][:3]
        if self.version[:1] not in ("2", "4") or binary not in ("0", "1") or size not in ("4", "8"):
            raise FileFormatError(
                f"{path} has the format {line!r:.40}; MSH files of the versions 2 and 4 are read"
            )
        self.binary, self.size = binary == "1", int(size)

    def section(self, name: str, body: bytes) -> None:
        """Traverse the blocks of a section to its end."""
        old = self.version.startswith("2")
        if old and not self.binary and name == "Elements":
            # Read line by line; a line that is missing ends it.
            self._first(body)
        elif old and self.binary:
            count, at = self._first(body)
            check = self._old_nodes if name == "Nodes" else self._old_elements
            check(body, count, at)
        elif self.binary:
            self._blocks(name, Bytes(self, body))
        else:
            self._blocks(name, Words(self, body))

    def short(self, what: str = "declares more than it contains") -> FileFormatError:
        """Return the error of a file that is too short for its counts."""
        return FileFormatError(f"{self.path} is truncated or corrupt: it {what}")

    def _first(self, body: bytes, *, room: int | None = None) -> tuple[int, int]:
        """Return the count in the first line, at most the number of bytes, and where that ends."""
        line = body[:_LONGEST_COUNT].partition(b"\n")[0]
        found = _COUNT.fullmatch(line)
        most = len(body) if room is None else room
        if found is None or (count := announced(found[1], str(self.path))) > most:
            raise self.short()
        return count, len(line) + 1

    def _numbers(self, numbers: NDArray[np.generic], size: int) -> None:
        """Reject node numbers too large for an array as large as the file."""
        if numbers.size and not 0 <= numbers.max() <= max(size, 1 << 20):
            raise self.short(f"has a node with the number {int(numbers.max())}: renumber the nodes")

    def _old_nodes(self, body: bytes, count: int, at: int) -> None:
        if count * _NODE.itemsize > len(body) - at:
            raise self.short()
        self._numbers(np.frombuffer(body, _NODE, count, at)["number"], len(body))

    def _old_elements(self, body: bytes, count: int, at: int) -> None:
        """Traverse the blocks of elements in a binary file of version 2."""
        done = 0
        while done < count:  # each block has 12 bytes or more
            if at + 12 > len(body):
                raise self.short()
            kind, some, tags = np.frombuffer(body, "<i4", 3, at).tolist()
            if some < 0 or tags < 0 or kind not in _NODES:
                raise self.short(f"has {some} elements of type {kind}, which is unknown")
            at += 12 + 4 * some * (1 + tags + _NODES[kind])
            if at > len(body):
                raise self.short()
            done += some

    def _blocks(self, name: str, items: Words | Bytes) -> None:
        """Traverse the blocks of nodes or elements of version 4, or the nodes of version 2."""
        if self.version.startswith("2"):
            (count,) = items.counts(1)
            self._numbers(items.records(count), items.size)
            return
        latest = self.version != "4.0"
        blocks, total, *_ = items.counts(4 if latest else 2)
        if max(blocks, total) > items.size:
            raise self.short()
        held = 0
        for _ in range(blocks):  # at most the size of the file
            first, second, kind = items.integers(3)
            (count,) = items.counts(1)
            held += count
            if name == "Elements":
                if kind not in _NODES:
                    raise self.short(f"has elements of type {kind}, which is unknown")
                items.skip(count, 1 + _NODES[kind], narrow=not latest)
                continue
            if latest and kind:
                raise self.short(f"has parameters of nodes (entity {first}, {second}): unsupported")
            numbers = items.numbered(count) if latest else items.records(count)
            self._numbers(numbers, items.size)
        if held != total and name == "Nodes":
            raise self.short(f"declares {total} nodes and contains {held}")

    def view(self, body: bytes) -> str:
        """Return the name of the node values, after comparing their counts with the bytes."""
        at, tags = 0, list[list[bytes]]()
        for _ in range(3):  # of strings, real numbers, integers
            count, length = self._first(body[at : at + _LONGEST_COUNT], room=len(body) - at)
            lines = body[at + length :].split(b"\n", count)[:count]
            if len(lines) < count:
                raise self.short()
            tags.append(lines)
            at += length + sum(map(len, lines)) + count
        strings, _, integers = tags
        found = map(_COUNT.fullmatch, integers[1:3])
        counts = [announced(digits[1], str(self.path)) for digits in found if digits]
        if not strings or len(counts) < 2 or not counts[0]:
            raise self.short("has values of nodes without a name or a number of components")
        item = 4 + 8 * counts[0] if self.binary else 2 * (1 + counts[0])
        if counts[1] * item > len(body) - at + 1:
            raise self.short()
        return strings[0].decode("utf-8", errors="replace").strip().replace('"', "")


class Words:
    """The numbers of a text section, in order."""

    def __init__(self, checked: Checked, body: bytes) -> None:
        self._checked, self.size, self._at = checked, len(body), 0
        self._values = parsed(body, checked.path)

    def _take(self, count: int) -> NDArray[np.float64]:
        if count > len(self._values) - self._at:
            raise self._checked.short()
        self._at += count
        return self._values[self._at - count : self._at]

    def integers(self, count: int) -> list[int]:
        """Return the next integers."""
        found = self._take(count)
        if not (np.abs(found) < 1 << 53).all() or (found != np.floor(found)).any():
            raise self._checked.short("has no integers where they are expected")
        return [int(n) for n in found]

    def counts(self, count: int) -> list[int]:
        """Return the next counts."""
        found = self.integers(count)
        if min(found) < 0:
            raise self._checked.short("has negative counts")
        return found

    def reals(self, count: int) -> None:
        """Pass real numbers."""
        self._take(count)

    def numbered(self, count: int) -> NDArray[np.float64]:
        """Return the numbers of nodes, and pass their coordinates."""
        numbers = self._take(count)
        self._take(3 * count)
        return numbers

    def records(self, count: int) -> NDArray[np.float64]:
        """Return the numbers of nodes, each of which precedes its coordinates."""
        return self._take(4 * count)[::4]

    def skip(self, count: int, width: int, *, narrow: bool) -> None:
        """Pass the numbers of elements and their nodes."""
        del narrow
        self._take(count * width)


class Bytes:
    """The numbers of a binary section, in order."""

    def __init__(self, checked: Checked, body: bytes) -> None:
        self._checked, self.size, self._at, self._body = checked, len(body), 0, body
        self._wide = f"<u{checked.size if checked.version != '4.0' else 8}"

    def _take(self, count: int, kind: np.dtype[np.void] | str) -> NDArray[Any]:
        step = count * np.dtype(kind).itemsize
        if step > self.size - self._at:
            raise self._checked.short()
        self._at += step
        return np.frombuffer(self._body, kind, count, self._at - step)

    def integers(self, count: int) -> list[int]:
        """Return the next 32-bit integers."""
        return [int(n) for n in self._take(count, "<i4").tolist()]

    def counts(self, count: int) -> list[int]:
        """Return the next counts."""
        return [int(n) for n in self._take(count, self._wide).tolist()]

    def reals(self, count: int) -> None:
        """Pass real numbers."""
        self._take(count, "<f8")

    def numbered(self, count: int) -> NDArray[np.generic]:
        """Return the numbers of nodes, and pass their coordinates."""
        numbers = self._take(count, self._wide)
        self._take(3 * count, "<f8")
        return numbers

    def records(self, count: int) -> NDArray[np.generic]:
        """Return the numbers of nodes, each of which precedes its coordinates."""
        numbers: NDArray[np.generic] = self._take(count, _NODE)["number"]
        return numbers

    def skip(self, count: int, width: int, *, narrow: bool) -> None:
        """Pass the numbers of elements and their nodes."""
        self._take(count * width, "<i4" if narrow else self._wide)
