"""One line of progress on standard error."""

from __future__ import annotations

import sys
import time

PAUSE = 30  # seconds between lines where standard error is a file


class Progress:
    """Says how far a run is: over the line before on a terminal, now and then on a line of its own elsewhere."""

    def __init__(self, costs: dict[str, float], shown: bool) -> None:
        self._left = dict(costs)
        self._all = sum(costs.values())
        self._count = len(costs)
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
        terminal = sys.stderr.isatty()
        if terminal:
            sys.stderr.write(f"\r\033[K{self.line()}" + ("\n" if last else ""))
        elif last or time.monotonic() - self._said > PAUSE:
            self._said = time.monotonic()
            sys.stderr.write(self.line() + "\n")
        sys.stderr.flush()

    def line(self) -> str:
        seconds = time.monotonic() - self._begun
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
