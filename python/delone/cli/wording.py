"""Messages of the package in the words of the command: options instead of arguments.

Errors and notes name arguments of Python, such as ``nan='drop'``. The options of the command that
was called replace them; advice that needs an argument without an option is left out.
"""

from __future__ import annotations

import re
from contextvars import ContextVar
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

__all__ = ["ARGUMENTS", "CALLED", "Switch", "as_options", "without_layer"]

# The command line that is executed, for notes.
CALLED: ContextVar[Sequence[str]] = ContextVar("called", default=())


class Switch(NamedTuple):
    """An option, and how it is switched off."""

    option: str
    # None for an option with a value.
    off: str | None = None


# Arguments that messages mention in advice; those without an option are for Python only.
ARGUMENTS = (
    "boundary", "bounds", "cell", "cells", "chord", "clip", "coincident", "columns", "coords",
    "crossing", "degrees", "dims", "duplicates", "edges", "extrapolate", "faces", "fill", "fix",
    "flat", "height", "holes", "imprint", "include_z", "infer_bounds", "inside", "interval", "keep",
    "kind", "leave_one_out", "levels", "limiter", "lonlat", "max_edge", "max_error", "max_handles",
    "max_length", "max_points", "max_triangles", "method", "min_angle", "missing", "n_clusters",
    "name", "nan", "nodata", "order", "percentile", "planar", "polygons", "regions",
    "respect_constraints", "resume", "segments", "sides", "snap", "step", "tol", "tolerance",
    "units", "vectors", "voids", "what", "winding", "xyz",
)  # fmt: skip
# Options with a different name, where the command has none with that of the argument.
_OTHER_NAMES = {"bounds": "window", "holes": "hole", "regions": "region", "kind": "method"}
# Arguments with a value that is an option of its own.
_OTHER_VALUES = {"order='enz'": "easting_first", "faces=False": "retriangulate"}

_ATTRIBUTE = re.compile(r"; `error\.\w+` (?:ha|list|contain)[^;]*")
# The option that a message itself has for an argument: band (--layer), step=4 (--step).
_BOTH = re.compile(
    r"(?<![\w.-])(band|bounds|faces|nodata|order|step)(?:=([^\s()]+|\([^()]*\)))?"
    r" \(--([a-z][\w-]*)[^()]*\)"
)
_TEXT = r"""(?:"[\w-]+"|'[\w-]+')"""
_NUMBER = r"-?(?:\d+(?:\.\d+)?(?:e[+-]?\d+)?|inf\b)"
# The value of an argument: texts with "or" between them, several numbers or texts, or one.
_VALUE = rf"{_TEXT}(?:(?:, | or )+{_TEXT})*|[(\[][^()\[\]]*[)\]]|{_NUMBER}|\w+"
_MARKS = str.maketrans("", "", "'\"()[]")
_UNRESOLVED = re.compile(rf"(?<![\w.-])(?:{'|'.join(ARGUMENTS)})=")
# What begins a part of a message, and so a piece of advice.
_PART = re.compile(r"; |: |, or |(?<=\?) ")
# What follows an argument at the start of a message.
_WRONG = re.compile(r" must | needs | is for | is empty| has no | changes nothing|: ")
_LAYER = re.compile(r"choose (?:one|a variable)(?: with band)? \(--layer\)(?:, from 1)?")


def as_options(
    message: str,
    options: Mapping[str, Switch],
    *,
    keep: Iterable[str] = (),
    words: bool = True,
) -> str:
    """Rewrite Python arguments in a message as options: ``nan='drop'`` as ``--nan drop``.

    `options` has the option of each argument: ``max_edge`` is ``--max-edge``. An argument is a word
    with an equals sign or, if `words`, with an underscore, or the first word of what is wrong with
    it. Texts of the user (`keep`) stay. The parts that attributes of the exception contain, and
    advice for arguments without an option, are left out.
    """
    # Readers of rasters have an argument that no command has.
    plain, texts = _masked(_ATTRIBUTE.sub("", message).replace(" (max_points)", ""), keep)
    known = dict(options)
    for name, other in _OTHER_NAMES.items():
        if other in options:
            known.setdefault(name, options[other])
    if "layer" not in known:
        plain = without_layer(plain)
    if "window" in known:
        # --bounds of such a command are those of its output.
        plain = re.sub(r"(?<![\w.-])bounds=", "window=", plain)
    plain = _BOTH.sub(lambda found: _chosen(found, known), plain)
    for argument, other in _OTHER_VALUES.items():
        if other in known:
            plain = plain.replace(argument, known[other].option)
    if known:
        names = "|".join(sorted(map(re.escape, known), key=len, reverse=True))
        pattern = rf"(?<![\w.-])({names})(=(?:{_VALUE})?)?"
        plain = re.sub(pattern, lambda found: _option(found, known, words), plain)
        plain = _without_advice(plain)
    part = ", or a part with bounds"
    plain = plain.replace(part, ", or a part with --bounds" if "bounds" in options else "")
    plain = re.sub(r"(--[\w-]+ must be [^;:]*?), or None for [^,;:]*", r"\1", plain)
    plain = re.sub(r"(--[\w-]+ must be )None \([^)]*\) or ", r"\1", plain)
    return re.sub("\0(\\d+)\0", lambda found: texts[int(found[1])], plain)


def without_layer(message: str, option: str | None = None) -> str:
    """Name the option for the layer of a further file; None if there is none."""
    return _LAYER.sub(f"choose one ({option})" if option else "only one can be read", message)


def _masked(message: str, keep: Iterable[str]) -> tuple[str, list[str]]:
    """Replace texts of the user by numbers; a plain word or number is part of the message."""
    found: list[str] = []

    def number(match: re.Match[str]) -> str:
        found.append(match[0])
        return f"\0{len(found) - 1}\0"

    texts = [text for text in keep if re.search("[=_]", text) and not text.startswith("--")]
    longest = sorted(map(re.escape, texts), key=len, reverse=True)
    return (re.sub("|".join(longest), number, message) if texts else message), found


def _chosen(found: re.Match[str], known: Mapping[str, Switch]) -> str:
    """Return the option that a message has for an argument, if the command has it."""
    name, value, option = found[1], found[2], found[3]
    switch = known.get(option.replace("-", "_"))
    if switch is None:
        # The argument remains, and what is not for the command is left out with it.
        return found[0].partition(" (")[0]
    if value is None or name != option.replace("-", "_"):
        return switch.option
    return f"{switch.option} {value.translate(_MARKS)}"


def _option(found: re.Match[str], known: Mapping[str, Switch], words: bool) -> str:
    """Return the option for an argument, or the text itself if it is an ordinary word."""
    name, given = found[1], found[2]
    option, off = known[name]
    rest = found.string[found.end() :]
    if given:
        value = given[1:]
        if off is not None:
            return off if value == "False" else option
        if value in ("", "True", "None"):
            return option
        if value[0] in "([":
            value = re.sub(r",\s+", ",", value)
        return f"{option} {value.translate(_MARKS)}"
    before = found.string[: found.start()]
    starts = not before or before.endswith((": ", "; ", ", so "))
    whole = not re.match(r"\w", rest)
    if words and whole and ("_" in name or (starts and _WRONG.match(rest))):
        return option
    return found[0]


def _without_advice(message: str) -> str:
    """Leave out the parts of a message that advise arguments without an option."""
    while (found := _UNRESOLVED.search(message)) is not None:
        begins = [part.start() for part in _PART.finditer(message, 0, found.start())]
        if not begins:
            break
        # Each round shortens the message, so this terminates.
        ends = message.find("; ", found.end())
        message = message[: begins[-1]] + ("" if ends < 0 else message[ends:])
    return message
