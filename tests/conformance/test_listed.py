"""The guide to the drop-ins lists the tests of SciPy that cannot hold: these and no others."""

from __future__ import annotations

import re
from pathlib import Path

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs/guide/compat.rst"
# A table of this folder's tests, and the names of tests in it.
TABLE = re.compile(r"^CANNOT_HOLD \|?= \{\n(.*?)^\}", re.DOTALL | re.MULTILINE)
KEY = re.compile(r'^    "(?:(Test\w+)::)?(test_\w+)', re.MULTILINE)
# A class of tests on the page, or a test, which belongs to the last class before it in its cell.
NAME = re.compile(r"``((?:Test_?|test_)\w+)``")


def test_the_page_lists_each_test_that_cannot_hold() -> None:
    names = set()
    for path in HERE.glob("test_scipy*.py"):
        for table in TABLE.findall(path.read_text(encoding="utf-8")):
            names |= set(KEY.findall(table))
    assert len(names) > 10
    section = PAGE.read_text(encoding="utf-8").split("Tests of SciPy that cannot pass\n")[1]
    rows = section.split("\n\n.. list-table::")[1].split("\n\nThree kinds")[0]
    listed = set()
    for row in rows.split("   * - ")[1:]:
        owner = ""
        for name in NAME.findall(row):
            if name.startswith("test_"):
                listed.add((owner, name))
            else:
                owner = name
    assert listed == names
