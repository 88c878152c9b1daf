# SPDX-License-Identifier: GPL-3.0-or-later
"""What became of a run, in words and in frames of Blender. Blender is not asked here."""


def verdict(summary):
    """One line about summary.json (docs/files.md)."""
    done = f"{summary['frames']} of {summary['frames_wanted']} frames"
    if summary["end"] != "finished":
        done += f", {summary['end']}" + (f": {summary['reason']}" if summary["reason"] else "")
    if summary["clean"]:
        return done + ", clean"
    found = []
    for key, words in (
        ("intersecting_pairs_all_frames", "intersecting pairs over all frames"),
        ("vertex_sharing_pairs_all_frames", "pairs that cross at a vertex"),
        ("inside_vertices", "vertices inside bodies in the worst frame"),
        ("passed_through", "pairs passed through each other"),
        ("jumped", "obstacles jumped"),
        ("nonfinite", "vertices not finite"),
    ):
        if summary[key]:
            found.append(f"{summary[key]} {words}")
    return done + "".join(f"; {one}" for one in found or ["no intersecting pairs"])


def has_pairs(summary):
    """Whether some frame has intersecting pairs, so that it is worth asking which."""
    return summary["intersecting_pairs_all_frames"] > 0 or summary["vertex_sharing_pairs_all_frames"] > 0


def bad_frames(report, first, step):
    """Pairs by frame of Blender, of the frames that have some, from the report of `selvedge check`."""
    rows = zip(report["intersecting_pairs_by_frame"], report["vertex_sharing_pairs_by_frame"])
    return {first + k * step: one + other for k, (one, other) in enumerate(rows) if one + other > 0}


def ranges(frames, step):
    """Runs of bad frames: triples of first frame, last frame and most pairs."""
    found = []
    for frame in sorted(frames):
        if found and frame == found[-1][1] + step:
            found[-1] = (found[-1][0], frame, max(found[-1][2], frames[frame]))
        else:
            found.append((frame, frame, frames[frame]))
    return found


def strip(rows, place, width, height):
    """Rectangles at the bottom of a timeline: corners and triangles. rows: first and last frames; place: where a frame
    is, in pixels from the left; width: that of the timeline, beyond which nothing is drawn."""
    corners, triangles = [], []
    for first, last in rows:
        left, right = max(0, place(first - 0.5)), min(width, place(last + 0.5))
        if left >= right:
            continue
        right = max(right, left + 2)  # still seen where a frame is narrower than that
        k = len(corners)
        corners += [(left, 0), (right, 0), (right, height), (left, height)]
        triangles += [(k, k + 1, k + 2), (k, k + 2, k + 3)]
    return corners, triangles
