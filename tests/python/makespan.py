"""How long cells take on many workers, by the order in which they are given out: makespan.py [WORKERS] [ROWS.csv].

ROWS.csv has the columns vertices, frames and milliseconds (a frame); it is docs/garments/wardrobe.csv otherwise. The
table is in docs/results/cells.md.
"""

import csv
import heapq
import pathlib
import random
import statistics
import sys

WARDROBE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "garments" / "wardrobe.csv"
COLUMNS = ("vertices", "frames", "milliseconds")
ORDERS = 200  # at random


def makespan(seconds, workers):
    """When the last cell ends, where each worker takes the next cell of the list as soon as it is free [s]."""
    free = [0.0] * workers
    for cell in seconds:
        heapq.heapreplace(free, free[0] + cell)
    return max(free)


def ideal(seconds, workers):
    """No order can end before [s]."""
    return max(max(seconds), sum(seconds) / workers)


def table(rows, workers):
    """Lines (order, makespan [s], over the ideal). `rows`: (what a listing can know of a cell's cost, its seconds)."""
    seconds = [s for _, s in rows]
    best = ideal(seconds, workers)
    rough = [s for _, s in sorted(rows, key=lambda row: -row[0])]
    mixed = random.Random(0)
    at_random = sorted(makespan(mixed.sample(seconds, len(seconds)), workers) for _ in range(ORDERS))
    orders = {
        "ideal": best,
        "by falling measured time": makespan(sorted(seconds, reverse=True), workers),
        "by falling vertices x frames": makespan(rough, workers),
        "as listed": makespan(seconds, workers),
        f"at random, median of {ORDERS}": statistics.median(at_random),
        f"at random, worst of {ORDERS}": at_random[-1],
    }
    return [(order, span, span / best) for order, span in orders.items()]


def main():
    workers = int(sys.argv[1]) if len(sys.argv) > 1 else 64
    with open(sys.argv[2] if len(sys.argv) > 2 else WARDROBE) as text:
        cells = [[float(row[column]) for column in COLUMNS] for row in csv.DictReader(text)]
    rows = [(vertices * frames, frames * milliseconds / 1000) for vertices, frames, milliseconds in cells]
    seconds = [s for _, s in rows]
    print(f"{len(rows)} cells, {sum(seconds):.0f} s in all, the longest {max(seconds):.0f} s, {workers} workers")
    for order, span, over in table(rows, workers):
        print(f"| {order} | {span:.0f} s | {over:.3f} |")


if __name__ == "__main__":
    main()
