"""One cell by the program `selvedge`, in a process of its own. Workers on other machines get this file's functions from
the driver, so that it imports the standard library alone."""

from __future__ import annotations

import ctypes
import functools
import os
import pathlib
import signal
import subprocess
import sys
from typing import NamedTuple

GRACE = 10  # seconds that an interrupted cell has for its end
LONGEST_MESSAGE = 2000  # characters of what a program printed


class CellEnd(NamedTuple):
    """How a try at a cell ended."""

    name: str
    state: str  # "done", "failed" (its row failed, its result is there), "refused" (bad input), "lost"
    message: str  # empty where it is done


def result_folder(out: pathlib.Path, name: str) -> pathlib.Path:
    """Where the result of a cell lies, whole or not at all."""
    return out / "cells" / name


def start_cell(program: str, key: str, file: str, name: str, out: str) -> subprocess.Popen:
    """Starts one cell, with one thread. It ends with the thread that started it, also where that is killed. A
    terminal's Ctrl-C does not reach it."""
    command = [program, "cell", file, name, "--out", out, "--program", key]
    return subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=dict(os.environ, OMP_NUM_THREADS="1"),
        start_new_session=True,
        preexec_fn=_set_up_child(),
    )


def _set_up_child():
    """Run by the child before it becomes the program: unblocks SIGINT, which workers of Ray and background shells
    block, and lets the system kill it when the thread that started it ends."""
    die = None
    if sys.platform == "linux":
        on_death_of_parent = 1  # PR_SET_PDEATHSIG of sys/prctl.h
        die = functools.partial(ctypes.CDLL(None).prctl, on_death_of_parent, signal.SIGKILL)

    def set_up() -> None:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, [])
        if die:
            die()

    return set_up


def wait_for_cell(process: subprocess.Popen, name: str, out: str) -> CellEnd:
    """Waits for the end of a cell. An exception that is raised here meanwhile, as by Ctrl-C, ends the cell first."""
    try:
        while True:
            try:
                _, printed = process.communicate(timeout=0.2)  # returns at the end, and lets exceptions in before it
                break
            except subprocess.TimeoutExpired:
                continue
    except BaseException:
        stop_cells([process])
        raise
    return _judge(process.returncode, printed.decode(errors="replace").strip(), name, out)


def _judge(status: int, printed: str, name: str, out: str) -> CellEnd:
    message = printed[-LONGEST_MESSAGE:]
    if status in (0, 1) and (result_folder(pathlib.Path(out), name) / "cell.json").is_file():
        return CellEnd(name, "done", "") if status == 0 else CellEnd(name, "failed", message or "its row failed")
    if status == 2:
        return CellEnd(name, "refused", message)
    what = f"killed by signal {-status}" if status < 0 else f"ended with status {status} and left no result"
    return CellEnd(name, "lost", f"{what}\n{message}".strip())


def stop_cells(processes: list[subprocess.Popen]) -> None:
    """Interrupts cells, and kills those that are not gone after a while."""
    for process in processes:
        process.send_signal(signal.SIGINT)
    try:
        for process in processes:
            process.wait(GRACE)
    except BaseException:  # also a second Ctrl-C
        for process in processes:
            process.kill()
            process.wait()
