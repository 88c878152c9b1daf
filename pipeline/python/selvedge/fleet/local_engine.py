"""Cells on this machine: a process a core."""

from __future__ import annotations

import os
import queue
import subprocess
import threading

from .cell_process import CellEnd, start_cell, stop_cells, wait_for_cell
from .listing import Cell, Listing


class LocalEngine:
    """Does each cell in a process of its own, which a thread starts and waits for."""

    def __init__(self, listing: Listing, out: str, workers: int | None) -> None:
        self.at_once = workers or _cores()
        self._listing, self._out = listing, out
        self._ended: queue.Queue[CellEnd] = queue.Queue()
        self._threads: list[threading.Thread] = []
        self._starting = threading.Lock()  # held while a process starts, so that none starts after a stop
        self._running: dict[str, subprocess.Popen] = {}
        self._stopped = False

    def start(self, cell: Cell) -> None:
        thread = threading.Thread(target=self._do, args=(cell.name,), daemon=True)
        self._threads.append(thread)
        thread.start()

    def wait(self, seconds: float) -> CellEnd | None:
        """The end of a cell that has ended, or None after so long."""
        try:
            return self._ended.get(timeout=seconds)
        except queue.Empty:
            return None

    def stop(self) -> None:
        """Interrupts all cells; none runs afterwards."""
        with self._starting:
            self._stopped = True
            running = list(self._running.values())
        stop_cells(running)

    def close(self) -> None:
        for thread in self._threads:
            thread.join()

    def _do(self, name: str) -> None:
        try:
            with self._starting:
                if self._stopped:
                    return
                process = start_cell(self._listing.program, self._listing.key, self._listing.file, name, self._out)
                self._running[name] = process
            end = wait_for_cell(process, name, self._out)
        except (OSError, subprocess.SubprocessError) as why:
            end = CellEnd(name, "lost", f"the program did not start: {why}")
        with self._starting:
            self._running.pop(name, None)
        self._ended.put(end)


def _cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
