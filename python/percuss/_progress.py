"""Progress of long work: by a function, or by tqdm where it is installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

Told = Callable[[int, int], object]
Progress = bool | Told | None


def telling(progress: Progress, unit: str) -> AbstractContextManager[Told | None]:
    """Make the function that is told how many of all parts are done.

    Parameters
    ----------
    progress : bool or callable, optional
        True for a bar of tqdm, or a function that takes the parts that are done and all of them.
    unit : str
        What the parts are called.

    Raises
    ------
    TypeError
        What is none of these.
    ModuleNotFoundError
        True where tqdm is not installed.
    """
    if progress is None or progress is False:
        return nullcontext()
    if progress is True:
        return _bar(unit)
    if callable(progress):
        return nullcontext(progress)
    raise TypeError(f"progress = {progress!r} is not accepted: True or a function is")


@contextmanager
def _bar(unit: str) -> Iterator[Told]:
    try:
        from tqdm.auto import tqdm
    except ModuleNotFoundError:
        what = "progress=True needs tqdm: accepted without it is a function of (done, all)"
        raise ModuleNotFoundError(what, name="tqdm") from None
    bar: Any = tqdm(unit=f" {unit}")

    def told(done: int, all_parts: int) -> None:
        bar.total = all_parts
        bar.update(done - bar.n)

    try:
        yield told
    finally:
        bar.close()
