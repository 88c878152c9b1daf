"""python -m selvedge.fleet FILE --out OUT [--engine ray]"""

from __future__ import annotations

import argparse
import signal
import sys

from . import run
from .listing import Error


def main() -> int:
    """Status 0: every cell is done; 1: some failed or are missing, or the run was stopped; 2: bad input."""
    what = "Does all cells of a file, and gathers them."
    parser = argparse.ArgumentParser(prog="python -m selvedge.fleet", description=what)
    parser.add_argument("file", help="what `selvedge cells` lists: a comparison, a suite, a work file")
    parser.add_argument("--out", required=True, help="folder of the results")
    parser.add_argument("--engine", choices=["local", "ray"], default="local")
    parser.add_argument("--program", help="selvedge; the one beside the package or on PATH otherwise")
    parser.add_argument("--workers", type=int, help="cells at a time; one a core otherwise")
    parser.add_argument("--retries", type=int, default=2, help="of a cell whose process, worker or node died")
    parser.add_argument("--address", help="of the Ray cluster; as Ray finds or starts one otherwise")
    parser.add_argument("--shared", action="store_true", help="all files have the same paths on every node")
    parser.add_argument("--quiet", action="store_true", help="no line of progress")
    given = vars(parser.parse_args())
    for stop in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(stop) == signal.SIG_DFL:  # nohup ignores SIGHUP
            signal.signal(stop, signal.default_int_handler)
    try:
        result = run(progress=not given.pop("quiet"), **given)
    except Error as why:
        print(f"error: {why}", file=sys.stderr)
        return 2
    except (KeyboardInterrupt, SystemExit):  # Ray exits at SIGTERM
        print("stopped; the same command goes on", file=sys.stderr)
        return 1
    print(result.gathered, end="")
    for name, why in {**result.failed, **result.missing}.items():
        print(f"{name}: {'failed' if name in result.failed else 'missing'}: {why}", file=sys.stderr)
    return 1 if result.failed or result.missing else 0


sys.exit(main())
