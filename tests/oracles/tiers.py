"""Tiers: a run takes what each change must pass, or everything, or a part of the rest.

``pytest`` alone takes the test tier, ``pytest --tier=deep`` everything, ``pytest --tier=2/5`` the
second fifth of what only the deep tier has, in the same parts on every machine, and
``pytest --tier=test+2/5`` both. A test says in one of four ways what the deep tier alone takes:

- ``@pytest.mark.deep``: all of it; ``@pytest.mark.deep("600-*")``: parameters with such an id.
- ``@pytest.mark.parametrize("seed", seeds(4, deep=40))``: the seeds from 4 on.
- ``@pytest.mark.sampled(12)``: all combinations of parameters but 12, or a few more where each
  value of each of several parameters is to occur in the test tier.
- ``@settings(max_examples=examples(25, deep=400))``: more examples of Hypothesis. Where a test
  gives no number, the profile of the tier has one.
"""

from __future__ import annotations

import json
import zlib
from collections import Counter, defaultdict
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

__all__ = ["MARKERS", "Taken", "Tiers", "Times", "examples", "sample", "seeds"]

# Examples of a test of Hypothesis that gives no number of its own.
EXAMPLES = {"test": 20, "deep": 150}
# Seconds from which on a test of the test tier has to give a reason: ``@pytest.mark.slow(reason)``.
SLOW = 5.0
# How many tests and rooms the end of a run lists.
LISTED = 10

MARKERS = (
    "deep(*ids): only the deep tier takes this test, or its parameters with such an id",
    "sampled(n): the test tier takes n combinations of parameters, the deep tier all",
    "slow(reason): why a test of the test tier may take more than five seconds",
)

_tier = "test"


def seeds(usual: int, *, deep: int) -> list[Any]:
    """The seeds 0 to `usual` for the test tier, and those up to `deep` for the deep one."""
    assert 0 < usual < deep
    rare = [pytest.param(seed, marks=pytest.mark.deep) for seed in range(usual, deep)]
    return [*range(usual), *rare]


def examples(usual: int, *, deep: int) -> int:
    """How many examples Hypothesis makes in the tier of this run."""
    assert 0 < usual < deep
    return usual if _tier == "test" else deep


class Taken(NamedTuple):
    """What a run takes: the tier whose numbers of examples it uses, and a part of the rest."""

    tier: str
    part: int = 0
    parts: int = 0

    @classmethod
    def read(cls, text: str) -> Taken:
        """Read ``test``, ``deep``, ``2/5`` or ``test+2/5``."""
        if text in EXAMPLES:
            return cls(text)
        tier, plus, fraction = text.rpartition("+")
        part, slash, parts = fraction.partition("/")
        numbers = part.isdecimal() and parts.isdecimal() and 1 <= int(part) <= int(parts)
        if not (slash and numbers and (not plus or tier == "test")):
            raise pytest.UsageError(f"--tier={text}: write test, deep, 2/5 or test+2/5")
        return cls(tier or "deep", int(part), int(parts))

    def has(self, name: str, *, only_deep: bool, is_property: bool) -> bool:
        """Whether a run takes a test of this name."""
        in_part = bool(self.parts) and _digest(name) % self.parts == self.part - 1
        if self.tier == "test":
            return not only_deep or in_part
        # Tests of Hypothesis make more examples in the deep tier.
        return not self.parts or ((only_deep or is_property) and in_part)


def sample(values: Sequence[dict[str, int]], keys: Sequence[str], count: int) -> set[int]:
    """Choose `count` combinations or more, so that each value of each parameter is in one of them.

    `values` has what identifies the value of each parameter, `keys` what breaks ties: the choice
    depends on nothing else. A value that only one combination has needs not occur, as those of a
    single parameter.
    """
    order = sorted(range(len(values)), key=lambda i: (_digest(keys[i]), keys[i]))
    times = Counter(pair for each in values for pair in each.items())
    pairs = [{pair for pair in each.items() if times[pair] > 1} for each in values]
    missing = set[tuple[str, int]]().union(*pairs)
    chosen: list[int] = []
    while missing:
        best = max(order, key=lambda i: len(pairs[i] & missing))
        chosen.append(best)
        missing -= pairs[best]
    rest = [i for i in order if i not in set(chosen)]
    return {*chosen, *rest[: max(count - len(chosen), 0)]}


def _digest(text: str) -> int:
    return zlib.crc32(text.encode())


class Tiers:
    """A plugin of pytest: leaves out what the tier of the run does not take."""

    def __init__(self, tier: str) -> None:
        global _tier  # noqa: PLW0603
        self.taken = Taken.read(tier)
        _tier = self.taken.tier
        # No test asserts a time, so an example that happens to be slow is no failure.
        settings.register_profile(
            "delone", deadline=None, print_blob=True, max_examples=EXAMPLES[_tier]
        )
        settings.load_profile("delone")

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(
        self, config: pytest.Config, items: list[pytest.Item]
    ) -> None:
        only_deep = self._only_deep(items)
        taken = {
            item
            for item in items
            if self.taken.has(
                item.nodeid, only_deep=item in only_deep, is_property=_is_property(item)
            )
        }
        if len(taken) < len(items):
            config.hook.pytest_deselected(items=[item for item in items if item not in taken])
            items[:] = [item for item in items if item in taken]

    @staticmethod
    def _only_deep(items: list[pytest.Item]) -> set[pytest.Item]:
        found = {item for item in items if any(map(_means(item), item.iter_markers("deep")))}
        families: dict[tuple[str, str], list[pytest.Item]] = defaultdict(list)
        for item in items:
            if item not in found and item.get_closest_marker("sampled"):
                family = item.parent.nodeid if item.parent else "", _function(item)
                families[family].append(item)
        for family in families.values():
            marker = family[0].get_closest_marker("sampled")
            assert marker is not None
            # Equal values of one parameter are one object in all combinations.
            parameters = [getattr(item, "callspec").params for item in family]  # noqa: B009
            values = [{name: id(value) for name, value in each.items()} for each in parameters]
            chosen = sample(values, [item.nodeid for item in family], *marker.args)
            found |= {item for i, item in enumerate(family) if i not in chosen}
        return found


def _means(item: pytest.Item) -> Callable[[pytest.Mark], bool]:
    """Whether a marker `deep` means this item: it names no parameters, or those of the item."""
    own = getattr(getattr(item, "callspec", None), "id", "")
    return lambda marker: not marker.args or any(fnmatchcase(own, each) for each in marker.args)


def _function(item: pytest.Item) -> str:
    return str(getattr(item, "originalname", None) or item.name)


def _is_property(item: pytest.Item) -> bool:
    return bool(getattr(getattr(item, "obj", None), "is_hypothesis_test", False))


class Times:
    """A plugin of pytest: says at the end where the time went, by test and by room."""

    def __init__(self, file: str | None) -> None:
        self.file = file
        self.seconds: dict[str, float] = defaultdict(float)
        self.reasons: dict[str, str] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.seconds[report.nodeid] += report.duration
        for name, value in report.user_properties:
            if name == "slow":
                self.reasons[report.nodeid] = str(value)

    @staticmethod
    def pytest_runtest_setup(item: pytest.Item) -> None:
        marker = item.get_closest_marker("slow")
        if marker is not None:
            item.user_properties.append(("slow", marker.args[0]))

    def rooms(self) -> dict[str, tuple[float, int]]:
        """Seconds of each room, and the number of its tests; the slowest room first."""
        found: dict[str, list[float]] = defaultdict(list)
        for name, seconds in self.seconds.items():
            found[room(name)].append(seconds)
        rows = {name: (sum(times), len(times)) for name, times in found.items()}
        return dict(sorted(rows.items(), key=lambda row: -row[1][0]))

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        if not self.seconds:
            return
        rooms = self.rooms()
        total = sum(self.seconds.values())
        say = terminalreporter.write_line
        terminalreporter.section("where the time went")
        slowest = sorted(self.seconds.items(), key=lambda row: -row[1])[:LISTED]
        for name, seconds in slowest:
            reason = self.reasons.get(name, "no reason is given" if seconds > SLOW else "")
            say(f"{seconds:7.2f} s  {name}" + (f"  ({reason})" if reason else ""))
        for name, (seconds, count) in list(rooms.items())[:LISTED]:
            say(f"{seconds:7.1f} s  {100 * seconds / total:4.1f} %  {count:5}  {name}")
        say(f"{total:7.1f} s in all, on all processors together, for {len(self.seconds)} tests")
        if self.file:
            rows = {name: [round(s, 1), n] for name, (s, n) in sorted(rooms.items())}
            lines = ",\n".join(f'  "{name}": {json.dumps(row)}' for name, row in rows.items())
            Path(self.file).write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


def room(name: str) -> str:
    """The folder of a test: ``tests/hull``, ``docs/guide``, ``python/delone/hull`` for docs."""
    parts = name.partition("::")[0].split("/")
    depth = 3 if parts[0] == "python" else 2
    return "/".join(parts[:depth]).removesuffix(".py")
