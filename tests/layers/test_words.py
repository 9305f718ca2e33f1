"""The text of the project is plain American English: phrases and spellings that it does not use.

The phrases are those of the table in phrases.md, beside this file, that cannot be right in another
sense. Only the files in `CONVERTED` are checked; add a glob when a folder is converted.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

CONVERTED = (
    "*.md",
    "architecture/*.md",
    "benchmarks/README.md",
    "examples/README.md",
    "docs/*.rst",
    "docs/api/*.rst",
    "docs/decisions/*.rst",
    "docs/guide/*.rst",
    "docs/learn/*.rst",
    "docs/mathematics/*.rst",
    "docs/tutorials/*.rst",
    "docs/coming_from/*.rst",
    "docs/README.md",
    "docs/inventories/README.md",
    "docs/extensions/*.py",
    "docs/pictures/**/*.py",
    "examples/*/*.py",
    "examples/*/*.rst",
    "python/delone/**/*.py",
    "python/delone/*.pyi",
    "crates/bindings/src/*.rs",
    "crates/core/src/**/*.rs",
    "crates/core/examples/*.rs",
    "crates/core/tests/suite/*.rs",
    "crates/predicates/src/*.rs",
    "fuzz/fuzz_targets/*.rs",
    "fuzz/src/*.rs",
)

# Each is written out in the left column of the table in phrases.md.
PHRASES = (
    "the doubles denote",
    "hangs on",
    "hang on",
    "hung on",
    "whoever knows",
    "at home in Python",
    "truth value",
    "for ever",
    "none of its choices",
    "is there in space",
    "is there in the plane",
    "triangulates anew",
    "laid anew",
    "a straight way",
    "out to the field",
    "what the input held",
    "the circle over a segment",
    "the far vertex",
    "bends upwards",
    "numbers of two doubles",
    "integers of any width",
    "has told all",
    "whom the others",
    "comes again",
    "come again",
    "what became of the input",
    "torn file",
    "appear whole",
    "in silence",
    "the core left them",
    "names the culprits",
    "is the door",
    "are the doors",
    "nanoseconds a point",
    "hand-overs",
    "kind to the cache",
    "anew",
    "whoever",
    "whither",
    "for want of",
    "has not the",
    "have not the",
    "no array of real points",
    "no array of integers",
    "comes several times",
    "come several times",
    "turned round",
    "there is but one",
    "the place of SciPy",
    "is told from time to time",
    "what is wanted of",
    "as the class takes them",
    "as the interpolator takes them",
    "the first culprits",
    "is torn",
    "torn or",
    "its options are odd",
    "told apart",
    "look at the watch",
    "looks at the watch",
    "asks the watch",
    "makes way for",
    "make way for",
    "if nothing else is said",
    "ns a point",
    "hangs into",
    "without the dice",
    "has the word",
    "of no length",
    "disturb each other",
    "in the plane and in space",
    "points of space",
    "comes to nothing",
    "come to nothing",
    "the culprits",
    "geometries of shapely",
    "usual mistake",
    "usual mistakes",
    "tables of geopandas",
    "the error has",
    "went and came",
    "has another length",
    "for good",
    "what there is",
    "each so many",
    "are outside of",
    "lie outside of",
    "strictly outside of",
    "strictly inside of",
    "what becomes of",
    "leave no doubt",
    "nearer than this",
    "as an object of",
)
# Also in the table: phrases that a pattern finds without false alarms.
PATTERNS = (
    # "is no vertex" for "is not a vertex"; "there is no vertex" and "is no larger than" are right.
    r"(?:is|are|was|were) no (?!longer|more|less|other|need|better|way|point in|one\b|\w+er than)"
    r"(?!(?:further|farther|lighter|heavier|nearer|later|earlier|fewer|larger|smaller|shorter)\b)\w+",
    # A tile of `distributed` knows points, in its mathematics, too; nothing else does.
    r"(?:class|code|object|file|mesh|caller|arc|triangle|point|page|grid|it) knows",
    r"turned (?:by|grid|grids|box|boxes|square|data|lattice|set)",
    r"(?:has|have) other \w+ than",
    r"another \w+(?: \w+){0,2} than (?!one\b)",
    r"no \w+ any ?more",
    r"(?:geometries|polygons|pipelines|tables) of (?:shapely|geopandas|scikit-learn)",
    r"one \w+ after the other",
    r"(?:mesh|meshes|graphs?|plotters?|datasets?|accessors?|axes) of (?:xarray|PyVista|NetworkX"
    r"|matplotlib|scikit-fem|trimesh|libpysal|meshio|UGRID|DOLFINx)",
)
AFTER_THERE = re.compile(r"\bthere\W*$", re.IGNORECASE)
BRITISH = (
    r"neighbour\w*",
    r"(?:circum|off-)?centre[sd]?",
    r"colour\w*",
    r"(?:kilo|centi|milli)?metres?",
    r"grey\w*",
    r"licences?",
    r"(?:behaviour|favour|artefact)\w*",
    r"(?:label|model|travel|cancel)l(?:ed|ing)",
    r"analys(?:e|ed|ing)",
    r"(?:to|after|up|down|for|back)wards",
    r"(?:character|discret|equal|factor|general|initial|linear|local|maxim|minim|normal|optim|organ"
    r"|parallel|quant|random|real|recogn|serial|special|standard|summar|symbol|synchron|util"
    r"|vector|visual)is(?:e|ed|es|ing|ation|ations)",
)

# A single word in quotes is data: what files spell, what other libraries return.
IN_CODE = re.compile(r'''``[^`]+``|`[^`]+`|"\w+"''')
SESSION = re.compile(r"^ *>>> .*?(?=\n *\n|\Z)", re.MULTILINE | re.DOTALL)
TITLE = re.compile(r'"[^"]*"')
TABLE = Path(__file__).with_name("phrases.md")


def prose(text: str) -> str:
    """The text without code and without line breaks.

    Parameters
    ----------
    text : str
        The contents of a file.

    Returns
    -------
    str
        One line for each paragraph.
    """
    text = SESSION.sub("", text.replace("```", "\n\n"))
    paragraphs = (" ".join(part.split()) for part in re.split(r"\n\s*\n", text))
    return "\n".join(IN_CODE.sub("code", part) for part in paragraphs)


def rust(text: str) -> str:
    """The comments of a Rust file without quoted titles, then its code with names as words.

    Parameters
    ----------
    text : str
        The contents of a file.

    Returns
    -------
    str
        One paragraph for each block of comments, and one for each line of code.
    """
    lines = [line.partition("//") for line in text.splitlines()]
    ends = ("\n" if code.strip() else "" for code, _, _ in lines)
    comments = "\n".join(
        end + comment.lstrip("/!") + end for (_, _, comment), end in zip(lines, ends, strict=True)
    )
    code = "\n\n".join(code.replace("_", " ") for code, _, _ in lines)
    return TITLE.sub("title", comments) + "\n\n" + code


def python(text: str) -> str:
    """The text of a Python file, with each comment of several lines in one line.

    Parameters
    ----------
    text : str
        The contents of a file.

    Returns
    -------
    str
        Lines as before, but for the marks between the lines of a comment.
    """
    lines: list[str] = []
    for line in text.splitlines():
        if line.lstrip().startswith("# ") and lines and lines[-1].lstrip().startswith("#"):
            lines[-1] += line.lstrip()[1:]
        else:
            lines.append(line)
    return "\n".join(lines)


def faults(text: str) -> list[str]:
    """The phrases and British spellings in the prose of a text, in their order."""
    pattern = "|".join([*map(re.escape, PHRASES), *PATTERNS, *BRITISH])
    plain = prose(text)
    found = re.finditer(rf"\b(?:{pattern})\b", plain, flags=re.IGNORECASE)
    # Of what follows "there", a word of the pattern may be missing: "there is no longer".
    return [each[0] for each in found if not _is_there(plain[: each.start()], each[0])]


def _is_there(before: str, phrase: str) -> bool:
    """Whether "is no" follows "there", where it is right."""
    return bool(re.match("(?:is|are|was|were) no ", phrase, re.IGNORECASE)) and bool(
        AFTER_THERE.search(before[-20:])
    )


def converted() -> list[Path]:
    """The files to check; this one, which quotes what it forbids, is not among them."""
    found = {path for pattern in CONVERTED for path in ROOT.glob(pattern)}
    return sorted(found - {Path(__file__)})


@pytest.mark.parametrize("path", converted(), ids=lambda path: path.relative_to(ROOT).as_posix())
def test_the_text_is_plain_american_english(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    read = {".rs": rust, ".py": python}.get(path.suffix)
    found = faults(read(text) if read else text)
    better = {
        phrase: write
        for phrase in found
        for given, write in instead().items()
        if phrase.lower() in given
    }
    assert found == [], f"write instead: {better}"


@pytest.mark.parametrize("pattern", CONVERTED)
def test_each_glob_finds_files(pattern: str) -> None:
    assert list(ROOT.glob(pattern))


def instead() -> dict[str, str]:
    """What to write in place of each row's phrases, in lower case."""
    rows = [row.split("|") for row in TABLE.read_text(encoding="utf-8").splitlines()]
    return {row[1].strip().lower(): row[2].strip() for row in rows if len(row) == 4}


def test_each_phrase_is_in_the_table() -> None:
    left = instead()
    assert len(left) > 50
    assert [phrase for phrase in PHRASES if not any(phrase.lower() in cell for cell in left)] == []


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("The order hangs on coordinates.", ["hangs on"]),
        ("The ridge goes on for\never.", ["for ever"]),
        ("- Torn\n  files are refused; a torn file is named.", ["torn file"]),
        ("A neighbour at the off-centre, 3 metres away.", ["neighbour", "off-centre", "metres"]),
        ("Lidar that is\nquantised, `colour`.", ["quantised"]),
        ("Points on it\nare no vertices, nor is no row an edge.", ["are no vertices", "is no row"]),
        ("The class knows its system.", ["class knows"]),
        ("A turned grid, points turned by 45 degrees.", ["turned grid", "turned by"]),
        (
            "It takes polygons of shapely, one ring after the other.",
            ["polygons of shapely", "one ring after the other"],
        ),
        ("Clusters have other numbers than in scikit-learn.", ["have other numbers than"]),
        ("Lines in another\nsystem than their points.", ["another system than "]),
        ("Afterwards, it points towards the pole.", ["Afterwards", "towards"]),
        ("The side is no edge any more.", ["is no edge", "no edge any more"][:1]),
        (
            "A graph of NetworkX, the axes of matplotlib.",
            ["graph of NetworkX", "axes of matplotlib"],
        ),
        ("Normalised, optimised and vectorised.", ["Normalised", "optimised", "vectorised"]),
    ],
)
def test_a_fault_is_found(text: str, found: list[str]) -> None:
    assert faults(text) == found


@pytest.mark.parametrize(
    "text",
    [
        "forever, exercises, otherwise, promised, raised, advertised, noise, comprises, arises",
        "There is no vertex, and there are no edges. The area is no larger, and is no longer so.",
        "# There\n# is no row. An edge is no further away. The tile knows it, turned off.",
        "See `circle.centre` and ``colours``.",
        '_UNITS = {"meters", "metres"}',
        ">>> circle.centre\nthe door is a truth value\n\nNeighbors.",
        "```python\nx = 1\n```\n\nNeighbors meet the door of a room.",
    ],
)
def test_what_is_right_passes(text: str) -> None:
    assert faults(text) == []


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("/// A chain hangs\n/// on it.\nfn f() {}", ["hangs on"]),
        ("let x = 1; // Which come\nlet y = 2; // again.", []),
        ("let with_centre = 0;", ["centre"]),
        ('Err("no neighbour")', ["neighbour"]),
        ('//! S. N. Other, "Neighbours of\n//! colours", 1980.', []),
        ("/// See `centre` and [`neighbours`].", []),
    ],
)
def test_faults_in_rust(text: str, found: list[str]) -> None:
    assert faults(rust(text)) == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("# Contours follow it, a usual\n# mistake.", ["usual mistake"]),
        ("    # A chain hangs\n    # on it.\n    on = it", ["hangs on"]),
        ("# It is there\n\n# in space", []),
    ],
)
def test_faults_in_comments_of_python(text: str, found: list[str]) -> None:
    assert faults(python(text)) == found
