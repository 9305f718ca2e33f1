"""The memory that is free, on systems and in containers that say so in different ways."""

from __future__ import annotations

import os

import pytest

from delone import memory

MEMINFO = "MemTotal:       32000 kB\nMemFree:          100 kB\nMemAvailable:   20000 kB\n"
SECOND, FIRST = memory._GROUPS


@pytest.fixture
def files(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """The files of the system."""
    found: dict[str, str] = {}

    def lines(path: str) -> list[str]:
        return found.get(path, "").splitlines()

    monkeypatch.setattr(memory, "_lines", lines)
    return found


def test_the_real_system_says_something() -> None:
    found = memory.free_memory()
    assert found is not None and found > 1 << 20
    assert memory._lines("/nonexistent/file") == []


def test_without_a_group_it_is_what_linux_says(files: dict[str, str]) -> None:
    files["/proc/meminfo"] = MEMINFO
    assert memory.free_memory() == 20000 * 1024
    files[SECOND[0]], files[SECOND[1]] = "max\n", "123\n"
    assert memory.free_memory() == 20000 * 1024


@pytest.mark.parametrize(
    ("group", "name"), [(SECOND, "inactive_file"), (FIRST, "total_inactive_file")]
)
def test_a_container_limits_it(
    files: dict[str, str], group: tuple[str, str, str], name: str
) -> None:
    files["/proc/meminfo"] = MEMINFO
    files[group[0]], files[group[1]] = "1000000\n", "600000\n"
    assert memory.free_memory() == 400_000
    files[group[2]] = f"cache 7\n{name} 50000\nactive_file 9\n"
    assert memory.free_memory() == 450_000
    files[group[1]] = "2000000\n"
    assert memory.free_memory() == 0
    files[group[0]] = f"{2**63 - 4096}\n"
    assert memory.free_memory() == 20000 * 1024


def test_other_systems_have_physical_memory_or_nothing(
    files: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert memory.free_memory() == os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    monkeypatch.setattr(memory, "_available_on_windows", lambda: 12345)
    assert memory.free_memory() == 12345
    monkeypatch.setattr(memory, "_available_on_windows", lambda: None)
    monkeypatch.delattr(os, "sysconf")
    assert memory.free_memory() is None
