"""Tests send Ctrl-C. A shell starts what it runs in the background with that ignored, and children inherit it."""

import signal

signal.signal(signal.SIGINT, signal.default_int_handler)
