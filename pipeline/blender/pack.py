# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the add-on's zip: pack.py OUT.zip. The same files give the same bytes, whoever packs them and when."""

import pathlib
import sys
import zipfile

HERE = pathlib.Path(__file__).parent
NAME = "selvedge_cloth"  # of the folder in the zip: Blender 3.4 takes it as the module's name
BEGIN_OF_TIME = (1980, 1, 1, 0, 0, 0)  # the earliest that a zip can say


def packed():
    """Files of the add-on, in the order of their names."""
    files = [*HERE.glob("*.py"), HERE / "blender_manifest.toml", HERE / "LICENSE", HERE / "README.md"]
    return sorted(file for file in files if file.name != pathlib.Path(__file__).name)


def pack(target):
    target.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(target, "w", zipfile.ZIP_STORED) as archive:  # compressed bytes depend on zlib's version
        for file in packed():
            entry = zipfile.ZipInfo(f"{NAME}/{file.name}", BEGIN_OF_TIME)
            entry.create_system, entry.external_attr = 3, 0o644 << 16  # Unix
            archive.writestr(entry, file.read_bytes())


if __name__ == "__main__":
    pack(pathlib.Path(sys.argv[1]))
    print(sys.argv[1])
