"""A run from a source to tiles: the order of the stages, and resuming an interrupted run."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import agreed
from delone._base.renames import renamed
from delone.distributed.pure.hull import extreme_rows
from delone.distributed.pure.layout import Layout
from delone.distributed.pure.rows import make_rows, widen, widened
from delone.distributed.pure.tiles import plant, strips
from delone.distributed.run.stages import note_of
from delone.distributed.store.files import Store
from delone.distributed.store.layout import Slices, collect, load_layout, save_layout
from delone.distributed.store.lock import LOCK, locked
from delone.distributed.store.manifest import assemble, manifest_of
from delone.distributed.store.schema import FORMAT, check_settings, check_summary
from delone.errors import (
    DegenerateInputError,
    FileFormatError,
    InputError,
    LimitError,
    NonFiniteError,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from delone.distributed.pure.rows import Rows
    from delone.distributed.run.executors import Executor
    from delone.distributed.run.sources import Choice, Source

    Summaries = dict[int, dict[str, Any]]

__all__ = ["Progress", "Run"]

# Sampled points per tile, and in total: 64 MB of coordinates.
_SAMPLE, _SAMPLES = 4096, 1 << 22


@renamed(tiles="ntiles")
@dataclass(frozen=True)
class Progress:
    """Progress of a run.

    Parameters
    ----------
    stage : str
        ``"look"``, ``"deal"``, ``"begin"``, ``"answer-0"``, ``"proceed-0"``, ..., ``"finish"``.
    done, total : int
        Tasks of the stage.
    ntiles : int
        Number of tiles; 0 until it is known.
    open : int
        Number of tiles that still have queries.
    turn : int
        The round of queries.
    foreign : int
        Points that tiles received from other tiles.
    memory : int
        The peak memory of a process in bytes.

    Examples
    --------
    >>> import tempfile
    >>> from delone import datasets, distributed
    >>> seen = []
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = distributed.triangulate(
    ...         datasets.grid(400), folder + "/tin", tile_points=100, progress=seen.append
    ...     )
    >>> seen[-1].stage, seen[-1].done, seen[-1].total, seen[-1].ntiles
    ('finish', 4, 4, 4)
    """

    stage: str = ""
    done: int = 0
    total: int = 0
    ntiles: int = 0
    open: int = 0
    turn: int = 0
    foreign: int = 0
    memory: int = 0


@dataclass
class Run:
    """One run: the output, the source and what to read from it, and who performs the tasks.

    `nan` is ``"raise"`` or ``"drop"``; `tell` is called with the progress.
    """

    store: Store
    source: Source
    choice: Choice
    tile_points: int
    nan: str
    executor: Executor
    tell: Callable[[Progress], None]
    progress: Progress = field(default_factory=Progress)

    def go(self, resume: bool) -> None:
        """Perform all tasks that are not done yet."""
        self._refuse_others()
        if self.store.exists("manifest.json") and not self.store.exists("work"):
            # Nothing is left to do; this also works if nothing can be written.
            self._enter(resume)
            return
        with locked(self.store.root):
            self._enter(resume)
            try:
                self._go()
            except (InputError, FileFormatError):
                # No run with these arguments can succeed, so nothing is kept.
                if not self.store.exists("work/done/begin"):
                    self.store.remove("work")
                raise

    def _go(self) -> None:
        if self.store.exists("manifest.json"):
            # An earlier run was stopped before cleanup.
            self.store.remove("work")
            return
        looks = self._look()
        layout = self._lay_out(looks)
        self._say(ntiles=len(layout.tiles))
        dealt = self._stage("deal", self._pieces())
        slices, counts = collect(self.store, len(layout.tiles), sorted(dealt.items()))
        self._check_sizes(slices)
        # Points that have been distributed are not scanned again.
        self.store.remove("work/pieces")
        threads = self.executor.threads
        begun = self._stage("begin", {t: (runs, threads) for t, runs in enumerate(slices)})
        turns, told = self._ask(begun)
        finished = self._stage("finish", {t: (runs, threads) for t, runs in enumerate(slices)})
        figures = {
            "rows": self.source.count,
            "points": int(counts.sum()),
            "dropped": sum(s["bad_count"] for s in looks.values()),
            "duplicates": sum(s["twins"] for s in begun.values()),
            "rounds": turns,
            "given": sum(s["foreign"] for s in begun.values()) + told,
            "hull": len(layout.hull),
            "memory": self.progress.memory,
        }
        for left in ("vertices/.tile=*", "triangles/.tile=*", ".manifest-*"):
            self.store.sweep(left)
        settings = self._settings()
        manifest = assemble(settings, self.source.crs, layout, figures, finished)
        self.store.note("manifest.json", manifest)
        self.store.remove("work")

    def _refuse_others(self) -> None:
        """Reject anything but the folder of a run, before anything is written."""
        root = self.store.root
        if root.exists() and not root.is_dir():
            raise InputError(f"{root} exists and is not a folder")
        if self.store.exists("manifest.json") or self.store.exists("work/run.json"):
            return
        # A run that stopped before its first note left a lock and a partial note.
        others = [p for p in root.glob("*") if p.name not in ("work", LOCK)]
        others += [p for p in root.glob("work/*") if not p.name.startswith(".run-")]
        if others:
            raise InputError(f"{root} exists and does not contain a run: choose another output")

    def _enter(self, resume: bool) -> None:
        """Start in an empty folder, or resume the same run in its folder."""
        root = self.store.root
        settings = self._settings()
        if self.store.exists("manifest.json"):
            before = manifest_of(self.store)["run"]
        elif (before := self.store.noted("work/run.json")) is not None:
            check_settings(before, self.store.path("work/run.json"))
        if before is None:
            self.store.remove("work")
            self.store.note("work/run.json", settings)
        elif not resume:
            raise InputError(f"{root} already contains a run: remove it, or use resume=True")
        elif before != settings:
            wrong = [name for name in settings if before.get(name) != settings[name]]
            raise InputError(
                f"{root} contains a different run ({', '.join(wrong)} differ); runs are not "
                "mixed: choose another output, or remove this one"
            )

    def _settings(self) -> dict[str, Any]:
        """The settings that two runs must share to be the same."""
        choice = self.choice
        return json.loads(  # type: ignore[no-any-return]
            json.dumps(
                {
                    "format": FORMAT,
                    "source": self.source.identity,
                    "tile_points": self.tile_points,
                    "columns": choice.columns,
                    "classes": choice.classes,
                    "attributes": choice.attributes,
                    "nan": self.nan,
                }
            )
        )

    def _look(self) -> Summaries:
        """Scan all pieces; an array is written to disk by this process."""
        pieces = self.source.pieces
        share = min(1.0, _SAMPLE * self._tiles() / max(self.source.count, 1))
        share = min(share, _SAMPLES / max(self.source.count, 1))
        tasks = {key: (*task, share) for key, task in self._pieces().items()}
        array = self.source.array
        if array is not None:
            for key, piece in enumerate(pieces):
                if not self.store.exists(note_of("look", key)):
                    some = array[piece.start : piece.stop]
                    z = some[:, 2] if some.shape[1] == 3 else None
                    rows = make_rows(piece.start, some[:, :2], z, {})
                    self.store.save(f"work/pieces/{key:06}.npy", rows)
        looks = self._stage("look", tasks)
        bad = sum(summary["bad_count"] for summary in looks.values())
        if bad and self.nan == "raise":
            worst = [row for key in sorted(looks) for row in looks[key]["bad"]]
            raise NonFiniteError(
                f"{bad} {agreed(bad, 'point has', 'points have')} NaN or infinity for x, y or "
                f"height; nan='drop' drops {agreed(bad, 'it', 'them')}",
                rows=worst,
                count=bad,
            )
        return looks

    def _pieces(self) -> dict[int, tuple[Any, ...]]:
        """The tasks of all pieces."""
        return {key: (piece, self.choice) for key, piece in enumerate(self.source.pieces)}

    def _tiles(self) -> int:
        return max(1, -(-self.source.count // self.tile_points))

    def _lay_out(self, looks: Summaries) -> Layout:
        if self.store.exists("work/layout.npz"):
            return load_layout(self.store)
        samples = [np.empty((0, 2))]
        hulls: list[Rows] = []
        for key in sorted(looks):
            found = self.store.load_all(f"work/looks/{key:06}.npz")
            samples.append(found["sample"])
            hulls.append(found["hull"])
        if hulls:
            kind = widened([hull.dtype for hull in hulls])
            hulls = [extreme_rows(np.concatenate([widen(part, kind) for part in hulls]))]
        if not sum(summary["rows"] for summary in looks.values()):
            self._refuse_nothing(sum(summary["bad_count"] for summary in looks.values()))
        if len(hulls[0]) < 3:
            _refuse_degenerate(hulls[0]["id"].tolist())
        sample = np.concatenate(samples)
        tiles = plant(sample, self._tiles())
        layout = Layout(tiles, strips(tiles, sample, self.source.count), hulls[0])
        save_layout(self.store, layout)
        return layout

    def _refuse_nothing(self, bad: int) -> None:
        """Raise an error that says why there are no points."""
        words = "there are no points"
        if self.choice.classes is not None:
            words += f" of class {' or '.join(map(str, self.choice.classes))}"
        if bad:
            words += f" but {bad} with NaN or infinity, which are dropped"
        raise DegenerateInputError(words, reason="too few points", chain=[])

    def _check_sizes(self, slices: Sequence[Slices]) -> None:
        """Reject a tile with too many points for 32-bit numbers, because of many equal points."""
        for tile, runs in enumerate(slices):
            size = sum(stop - start for part in runs for _, start, stop in part)
            if size > 1 << 28:
                raise LimitError(
                    f"tile {tile} has {size} points, more than {1 << 28}: choose fewer tile_points"
                )

    def _ask(self, begun: Summaries) -> tuple[int, int]:
        """Run rounds of queries until no tile has any; return the numbers of rounds and points.

        Each query is answered once and for all: either its triangle is certain from then on, or
        another point is known. Therefore there are no more rounds than points.
        """
        asked = {key: s["asked"] for key, s in sorted(begun.items()) if s["asked"]}
        self._say(foreign=sum(s["foreign"] for s in begun.values()))
        turn = told = 0
        while asked:
            self._say(open=len(asked), turn=turn + 1)
            askers: dict[int, list[int]] = {}
            for key, tiles in asked.items():
                for tile in tiles:
                    askers.setdefault(tile, []).append(key)
            questions = {tile: (turn, keys) for tile, keys in sorted(askers.items())}
            self._stage(f"answer-{turn:04}", questions)
            tasks = {key: (turn, tiles) for key, tiles in asked.items()}
            found = self._stage(f"proceed-{turn:04}", tasks)
            told += sum(s["foreign"] for s in found.values())
            self._say(foreign=self.progress.foreign + sum(s["foreign"] for s in found.values()))
            asked = {key: s["asked"] for key, s in sorted(found.items()) if s["asked"]}
            turn += 1
        self._say(open=0)
        return turn, told

    def _stage(self, stage: str, tasks: Mapping[int, Sequence[Any]]) -> Summaries:
        """Perform the tasks of a stage that are not done yet; return all summaries."""
        found: Summaries = {}
        for key in tasks:
            name = note_of(stage, key)
            summary = self.store.noted(name)
            if summary is not None:
                kind, tiles = stage.partition("-")[0], self.progress.ntiles
                check_summary(kind, summary, tiles, self.store.path(name))
                found[key] = summary
                self._count(summary)
        todo = {key: arguments for key, arguments in tasks.items() if key not in found}
        self._say(stage=stage, done=len(found), total=len(tasks))
        if todo:
            for key, summary in self.executor.run(str(self.store.root.absolute()), stage, todo):
                found[key] = summary
                self._count(summary)
                self._say(done=len(found))
        return found

    def _count(self, summary: Mapping[str, Any]) -> None:
        memory = max(self.progress.memory, int(summary["memory"]))
        self.progress = replace(self.progress, memory=memory)

    def _say(self, **changes: Any) -> None:
        self.progress = replace(self.progress, **changes)
        self.tell(self.progress)


def _refuse_degenerate(ends: list[int]) -> None:
    if len(ends) < 2:
        reason, words = "too few points", "fewer than three points are distinct"
    else:
        reason, words = "collinear", f"all points lie on the line of rows {ends[0]} and {ends[1]}"
    raise DegenerateInputError(f"{words}: there are no triangles", reason=reason, chain=ends)
