"""One line of progress on standard error."""

from __future__ import annotations

import sys
import time

from .listing import Cell

PAUSE = 30  # seconds between lines where standard error is a file


class Progress:
    """Says how far a run is: over the line before on a terminal, now and then on a line of its own elsewhere."""

    def __init__(self, cells: list[Cell], kept: set[str], shown: bool) -> None:
        """`kept`: names of cells whose results are there, and which take no time."""
        self._left = {cell.name: 0.0 if cell.name in kept else cell.cost for cell in cells}
        self._all = sum(self._left.values())
        self._count = len(cells)
        self._failed = self._tries = 0
        self._shown, self._begun, self._said = shown, time.monotonic(), time.monotonic()

    def ended(self, name: str, state: str) -> None:
        """A cell has ended; "again": it is tried again."""
        if state == "again":
            self._tries += 1
            return
        self._failed += state != "done"
        del self._left[name]

    def show(self, last: bool = False) -> None:
        if not self._shown:
            return
        now = time.monotonic()
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\033[K{self.line(now - self._begun)}" + ("\n" if last else ""))
        elif last or now - self._said > PAUSE:
            self._said = now
            sys.stderr.write(self.line(now - self._begun) + "\n")
        sys.stderr.flush()

    def line(self, seconds: float) -> str:
        """After so many seconds."""
        done = self._all - sum(self._left.values())
        parts = [f"{self._count - len(self._left)} of {self._count} cells"]
        if self._failed:
            parts.append(f"{self._failed} failed")
        if self._tries:
            parts.append(f"{self._tries} lost and tried again")
        parts.append(f"{_clock(seconds)} so far")
        if self._left and done > 0:
            parts.append(f"about {_clock(seconds * (self._all - done) / done)} to go")
        return ", ".join(parts)


def _clock(seconds: float) -> str:
    minutes = int(seconds) // 60
    return f"{minutes // 60}:{minutes % 60:02}:{int(seconds) % 60:02}"
