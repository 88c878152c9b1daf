"""Short cells of the program itself, for tests of selvedge.fleet and for what measures it."""

import json

SHEET = {
    "cloths": [{"name": "sheet", "rectangle": {"size": [0.5, 0.5], "edge": "4 cm"}, "translate": [0, 0.05, 0]}],
    "obstacles": [{"name": "floor", "plane": {"size": [2, 2], "edge": 0.5}}],
    "run": {"frames": 10, "fps": 30},
}


def write_shots(folder, count):
    """A work file of as many shots c000, c001 and so on, sheets that fall from different heights. Files are JSON,
    which is YAML."""
    (folder / "sheet.yaml").write_text(json.dumps(SHEET))
    heights = [f"cloths.sheet.translate=[0, {0.03 + 0.001 * k:.3f}, 0]" for k in range(count)]
    shots = [{"name": f"c{k:03}", "scene": "sheet.yaml", "set": [height]} for k, height in enumerate(heights)]
    file = folder / "shots.yaml"
    file.write_text(json.dumps({"cells": "shots", "pages": False, "shots": shots}))
    return file
