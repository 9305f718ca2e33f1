"""Tasks on parts of a finished output: in this process, or on a Dask cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

__all__ = ["mapped"]


def mapped(
    executor: Any, function: Callable[..., Any], tasks: Sequence[tuple[Any, ...]]
) -> Iterator[Any]:
    """Yield what a function returns for each tuple of arguments, in order.

    Functions and arguments can be pickled. On a cluster, tasks that wait for their turn to be
    yielded are at most two for each thread.
    """
    if isinstance(executor, str) and executor == "serial":
        for task in tasks:
            yield function(*task)
        return
    if not hasattr(executor, "submit") or not hasattr(executor, "nthreads"):
        raise InputError(
            f"executor must be 'serial' or a dask.distributed.Client, got {executor!r:.80}"
        )
    ahead = 2 * max(1, sum(map(int, executor.nthreads().values())))
    waiting: list[Any] = []
    for task in tasks:
        if len(waiting) == ahead:
            yield waiting.pop(0).result()
        waiting.append(executor.submit(function, *task, pure=False))
    for future in waiting:
        yield future.result()
