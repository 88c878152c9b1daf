"""How long work goes on: a bar of tqdm, where that is installed."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator


@contextlib.contextmanager
def progress_bar(unit: str, wanted: bool | None) -> Iterator[Callable[[int, int], None] | None]:
    """Yields a function that is told how much is done, and of how much; None where there is no bar. wanted: None: a bar
    where tqdm is installed, in a notebook or on a terminal; True: also elsewhere; False: none."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        tqdm = None
    if tqdm is None or wanted is False:
        yield None
        return
    with tqdm(unit=unit, disable=None if wanted is None else False) as bar:

        def show(done: int, total: int) -> None:
            if bar.total != total:
                bar.reset(total)
            bar.update(done - bar.n)

        yield show
