"""Ctrl-C in the middle of work."""

import contextlib
import os
import signal
import threading


@contextlib.contextmanager
def interrupted_when(there):
    """Sends Ctrl-C to this process as soon as there() is true, unless the block has ended before."""
    ended = threading.Event()

    def wait():
        while not there():
            if ended.wait(0.01):
                return
        os.kill(os.getpid(), signal.SIGINT)

    waiting = threading.Thread(target=wait)
    waiting.start()
    try:
        yield
    finally:
        ended.set()
        waiting.join()
