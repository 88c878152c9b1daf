"""Reads the positions of binary PLY files."""

import numpy as np


def read_ply(path):
    """n x 3 [m]."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    vertices = int(head.split(b"element vertex ")[1].split()[0])
    assert b"binary_little_endian" in head
    return np.frombuffer(body, "<f8" if b"double x" in head else "<f4", 3 * vertices).reshape(-1, 3)
