"""Points in text: CSV, TSV, TXT, XYZ, PTS, DAT, plain or compressed.

The first lines determine the delimiter, the decimal mark and whether there is a header. NumPy's
reader does the rest, in blocks, so that the memory needed is that of the columns kept. Numbers
become the nearest doubles. Rows are numbered from 0, without header, comments and blank lines;
lines are numbered from 1.
"""

from __future__ import annotations

import io
import itertools
import re
from ast import literal_eval
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import IO, TYPE_CHECKING

import numpy as np

from delone._base.files import cut_short
from delone.errors import FileFormatError
from delone.io.compressed import Bounded, corrupt_is_an_error, opened, require_expansion
from delone.io.counts import announced
from delone.io.pointset import PointSet, choose_columns, find_column
from delone.io.words import Words

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from delone._base.types import Floats

__all__ = ["line_numbers", "read_points"]

# 1,234.5 or 1'234 or 1 234,5; and 0.1D+03.
_THOUSANDS = re.compile(
    r"[+-]?\d{1,3}(?:(?:,\d{3})+(?:\.\d*)?|(?:['\u2019 \xa0]\d{3})+(?:[.,]\d*)?)"
)
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d*")
_FORTRAN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)[dD][+-]?\d+")
_DECIMALS = re.compile(r"[+-]?\d+[.,]\d+")
_COMMENTS = ("#", "//", "%", "!")
_SAMPLE_BYTES = 1 << 16
_SAMPLE_ROWS = 50
_BLOCK = 1 << 17
# Maximum length of a line in bytes: a row of numbers, and perhaps an outline in another column.
_LONGEST_LINE = 1 << 24


@dataclass(frozen=True, kw_only=True)
class _Layout:
    """The format of the lines of a file."""

    delimiter: str | None  # None: any whitespace
    decimal: str
    names: tuple[str, ...]
    named: bool
    skip: int  # lines before the first row
    claimed: int | None  # the number of rows declared by a first line with one integer
    sample: list[list[str]]  # the fields of the first rows


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    everything: bool = False,
) -> PointSet:
    """Read points from a text file; see `delone.io.read_points`.

    With `everything`, all other columns are attributes, including text.
    """
    source = str(path)
    with _no_text_is_an_error(source):
        require_expansion(path)
        layout = _layout(path, source)
        if columns is None and not layout.named:
            _refuse_point_numbers(layout.sample, source)
        chosen = choose_columns(layout.names, columns, source, named=layout.named)
        extra = [find_column(layout.names, name, source) for name in attributes]
        others = [i for i in range(len(layout.names)) if i not in chosen] if everything else []
        words = Words([layout.names[i] for i in others], others, layout.decimal, source)
        with _opened(path) as lines:
            table = _table(lines, layout, chosen + extra, path, words)
    if layout.claimed is not None and len(table) < layout.claimed:
        raise cut_short(source, f"{layout.claimed} points", len(table))
    z = np.ascontiguousarray(table[:, 2]) if len(chosen) == 3 else None
    further = dict(zip(attributes, table[:, len(chosen) :].T, strict=True)) | words.columns()
    return PointSet(
        points=np.ascontiguousarray(table[:, :2]),
        z=z,
        attributes=further,
        source=source,
        columns=tuple(layout.names[i] for i in chosen) if layout.named else (),
    )


def line_numbers(path: Path, rows: Sequence[int]) -> list[int]:
    """Return the lines of rows; see `delone.io.line_numbers`."""
    source = str(path)
    with _no_text_is_an_error(source):
        return _line_numbers(path, _layout(path, source).skip, rows)


def _line_numbers(path: Path, skip: int, rows: Sequence[int]) -> list[int]:
    """Read the file again; lines are counted only if an error message needs them."""
    found, last = {}, max(rows, default=-1)
    with _opened(path) as file:
        held = (n for n, line in enumerate(file, 1) if n > skip and _is_row(line))
        for row, number in enumerate(held):
            if row > last:
                break
            found[row] = number
    if last >= len(found):
        raise FileFormatError(f"{path} has only {len(found)} rows, and no row {last}")
    return [found[row] for row in rows]


def _is_row(line: str) -> bool:
    return bool(line.strip()) and not _is_comment(line)


@contextmanager
def _no_text_is_an_error(source: str) -> Iterator[None]:
    try:
        with corrupt_is_an_error(source):
            yield
    except UnicodeDecodeError as error:
        raise FileFormatError(f"{source} is not a text file: {error.reason}") from error


def _opened(path: Path) -> IO[str]:
    binary = opened(path)
    try:
        sample = binary.read(_SAMPLE_BYTES)
        binary.seek(0)
        text = io.BufferedReader(Bounded(binary, path, longest_line=_LONGEST_LINE), _SAMPLE_BYTES)
        return io.TextIOWrapper(text, encoding=_encoding(sample, path), newline=None)
    except BaseException:
        binary.close()
        raise


def _encoding(sample: bytes, path: Path) -> str:
    if sample[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "utf-16"
    if b"\0" in sample:
        raise FileFormatError(f"{path} is not a text file: it contains zero bytes")
    try:
        # The sample may end within a character.
        sample[: sample.rfind(b"\n") + 1].decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"  # column names in an old code page; numbers are the same in all
    return "utf-8-sig"


def _layout(path: Path, source: str) -> _Layout:
    """Determine the layout from the first lines."""
    with _opened(path) as file:
        lines = [line.rstrip("\r\n") for line in itertools.islice(file, 200)]
    comment, start = "", 0
    while start < len(lines) and (not lines[start].strip() or _is_comment(lines[start])):
        comment = lines[start].strip().lstrip("".join(_COMMENTS)).strip() or comment
        start += 1
    rows = [line for line in lines[start:] if _is_row(line)]
    if not rows:
        raise FileFormatError(f"{source} contains no rows of numbers")
    claimed = None
    if len(rows) > 1 and rows[0].strip().isdecimal() and len(re.split(r"[\s,;]+", rows[1])) > 1:
        claimed = announced(rows[0], source)
        start, rows = lines.index(rows[0], start) + 1, rows[1:]
    layout = _split(rows[:_SAMPLE_ROWS], source)
    if layout.named:
        start = lines.index(rows[0], start) + 1
    elif comment and len(named := _fields(comment, layout.delimiter)) == len(layout.names):
        # A header behind a comment mark: # x y z
        layout = replace(layout, names=tuple(named), named=True)
    return replace(layout, skip=start, claimed=claimed)


def _split(rows: list[str], source: str) -> _Layout:
    """Find the delimiter, decimal mark and header with which the rows become numbers."""
    body = rows[1:] if len(rows) > 1 else rows
    candidates = [(d, ".") for d in (",", ";", "\t", "|", None)] + [(";", ","), ("\t", ",")]
    best: tuple[tuple[int, int], str | None, str] | None = None
    for delimiter, decimal in candidates:
        split = [_fields(row, delimiter) for row in body]
        usual = Counter(map(len, split)).most_common(1)[0][0]
        numbers = sum(_is_number(field, decimal) for fields in split for field in fields)
        # Prefer more numbers, then a delimiter over whitespace, which also surrounds delimiters.
        score = (numbers, usual)
        if usual > 1 and numbers and (best is None or score > best[0]):
            best = score, delimiter, decimal
    if best is None:
        raise FileFormatError(
            f"{source}: its lines are not columns of numbers: {rows[-1][:60]!r:.80}"
        )
    _, delimiter, decimal = best
    first = _fields(rows[0], delimiter)
    named = not any(_is_number(field, decimal) for field in first)
    names = first if named else [str(i) for i in range(len(first))]
    return _Layout(
        delimiter=delimiter,
        decimal=decimal,
        names=tuple(names),
        named=named,
        skip=0,
        claimed=None,
        sample=[_fields(row, delimiter) for row in rows],
    )


def _fields(row: str, delimiter: str | None) -> list[str]:
    fields = row.split() if delimiter is None else row.split(delimiter)
    return [field.strip().strip('"').strip() for field in fields]


def _spelling(text: str) -> str:
    """Return how to change a number that NumPy does not read; empty for all others."""
    if _THOUSANDS.fullmatch(text):
        return ": remove the separators of thousands"
    if _FORTRAN.fullmatch(text):
        return f": write the exponents of Fortran with E, {re.sub('[dD]', 'E', text)}"
    return ""


def _advice(text: str) -> str:
    """Return how to change a field that is not read as a number; empty if that is not known."""
    if _DECIMAL_COMMA.fullmatch(text):
        return ": write decimals with a point, and no separators of thousands"
    return _spelling(text)


def _refuse_point_numbers(rows: list[list[str]], source: str) -> None:
    """Reject unnamed columns of which the first is probably a point number.

    That is, whole numbers that grow from row to row, before three columns with decimals.
    """
    if len(rows) < 2 or any(len(row) < 4 for row in rows):
        return
    numbers = [row[0] for row in rows]
    whole = all(number.isascii() and number.isdecimal() for number in numbers)
    if not whole or not all(_DECIMALS.fullmatch(part) for row in rows for part in row[1:4]):
        return
    if all(len(number) < 10 for number in numbers) and _grows([int(n) for n in numbers]):
        raise FileFormatError(
            f"{source}: the first of its columns without names looks like numbers of points "
            f"({numbers[0]}, {numbers[1]}, ...): choose x, y and z (--columns), 2,1,3 for "
            "number, northing, easting, height; 1,2,3 for number, x, y, z; or 0,1,2"
        )


def _grows(numbers: list[int]) -> bool:
    return all(a < b for a, b in itertools.pairwise(numbers))


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(_COMMENTS)


def _is_number(field: str, decimal: str) -> bool:
    if _spelling(field):
        return True  # reading says what to change
    if decimal != ".":
        field = field.replace(decimal, ".")
    try:
        float(field)
    except ValueError:
        return False
    return True


def _table(file: IO[str], layout: _Layout, columns: list[int], path: Path, words: Words) -> Floats:
    """Read the chosen columns, block by block."""
    for _ in range(layout.skip):
        file.readline()
    lines: Iterator[str] = filter(_is_row, file)
    blocks: list[Floats] = []
    rows = 0
    while True:
        content = list(itertools.islice(lines, _BLOCK))
        words.add(content, layout.delimiter)
        if layout.decimal != ".":
            content = [line.replace(layout.decimal, ".") for line in content]
        block = _block(content, layout, columns, rows, path)
        blocks.append(block)
        rows += len(block)
        if len(block) < _BLOCK:
            return np.concatenate(blocks)


def _block(
    content: list[str], layout: _Layout, columns: list[int], before: int, path: Path
) -> Floats:
    if not content:
        return np.empty((0, len(columns)))
    _refuse_long_rows(content, layout, before, path)
    try:
        table: Floats = np.loadtxt(
            content,
            delimiter=layout.delimiter,
            usecols=columns,
            comments=None,
            quotechar='"',
            ndmin=2,
        )
    except ValueError as error:
        raise FileFormatError(f"{path}: {_located(str(error), layout, before, path)}") from None
    return table


def _refuse_long_rows(lines: list[str], layout: _Layout, before: int, path: Path) -> None:
    """Reject fields beyond those of the first line, which NumPy would silently ignore."""
    width, delimiter = len(layout.names), layout.delimiter
    for row, line in enumerate(lines, before):
        if delimiter is not None and line.count(delimiter) < width:
            continue
        fields = line.split(delimiter)
        # A trailing delimiter adds an empty field, but a delimiter in quotes does not.
        if any(field.strip() for field in fields[width:]) and '"' not in line:
            place = _place(row, layout, path)
            raise FileFormatError(
                f"{path}: {place} has {len(fields)} columns, but the first has {width}: are there "
                "decimal commas, or another delimiter?"
            )


def _place(row: int, layout: _Layout, path: Path) -> str:
    return f"line {_line_numbers(path, layout.skip, [row])[0]} (row {row})"


def _located(message: str, layout: _Layout, before: int, path: Path) -> str:
    """Convert NumPy's error message about a block to one about the file."""
    bad = re.search(r"string ('.*'|\".*\") to float64 at row (\d+), column (\d+)", message)
    if bad:
        text, row, column = literal_eval(bad[1]), int(bad[2]) + before, int(bad[3]) - 1
        name = layout.names[column] if layout.named and column < len(layout.names) else str(column)
        what = "is empty" if not text else f"is {text!r:.60}, not a number{_advice(text)}"
        return f"{_place(row, layout, path)}, column {name} {what}"
    short = re.search(r"at row (\d+) with (\d+) columns", message)
    if short:
        # NumPy counts this row from 1.
        place = _place(int(short[1]) + before - 1, layout, path)
        return f"{place} has only {short[2]} columns: is the file truncated?"
    return message.partition("\n")[0]
