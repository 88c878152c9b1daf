# SPDX-License-Identifier: GPL-3.0-or-later
"""Point caches (PC2): positions of a mesh, frame by frame, as the program and Blender's modifier Mesh Cache read them.

The file is little-endian: a head of 32 bytes (name, version, vertices, first frame, frames a sample, samples), then
three floats a vertex and sample.
"""

import os
import pathlib
import struct

import numpy as np

HEAD = struct.Struct("<12siiffi")
NAME = b"POINTCACHE2\0"


class Writer:
    """Takes the positions of one frame after the other; the file has its name once `keep` was called."""

    def __init__(self, path, vertices):
        self.path, self.vertices, self.frames = pathlib.Path(path), vertices, 0
        self.part = self.path.with_name(self.path.name + ".part")
        self.file = open(self.part, "wb")
        self.file.write(bytes(HEAD.size))

    def add(self, x):
        """x: n x 3."""
        if len(x) != self.vertices:
            raise ValueError(f"{self.path}: {len(x)} vertices in frame {self.frames}, and {self.vertices} before")
        self.file.write(np.ascontiguousarray(x, "<f4").tobytes())
        self.frames += 1

    def keep(self):
        self.file.seek(0)
        self.file.write(HEAD.pack(NAME, 1, self.vertices, 0.0, 1.0, self.frames))
        self.file.close()
        os.replace(self.part, self.path)

    def drop(self):
        self.file.close()
        self.part.unlink(missing_ok=True)


def write(path, frames):
    """frames: F x n x 3."""
    writer = Writer(path, len(frames[0]))
    for x in frames:
        writer.add(x)
    writer.keep()


def read(path):
    """Positions F x n x 3 of float32, read when they are asked for. Raises ValueError for what is no PC2."""
    path = pathlib.Path(path)
    with open(path, "rb") as file:
        head = file.read(HEAD.size)
    if len(head) < HEAD.size or not head.startswith(NAME):
        raise ValueError(f"{path}: is no point cache (PC2)")
    _, _, vertices, _, _, frames = HEAD.unpack(head)
    if vertices < 1 or frames < 1 or path.stat().st_size < HEAD.size + 12 * vertices * frames:
        raise ValueError(f"{path}: is shorter than its head says")
    return np.memmap(path, "<f4", "r", HEAD.size, (frames, vertices, 3))
