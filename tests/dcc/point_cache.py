"""Point Cache 2 files, little endian, as numpy arrays."""

import pathlib
import struct
import sys

import numpy as np


def read_pc2(file):
    """Start frame and positions [frames, points, 3] in metres."""
    data = pathlib.Path(file).read_bytes()
    if data[:12] != b"POINTCACHE2\0":
        sys.exit(f"{file}: does not start with POINTCACHE2; this is no PC2 file")
    points = int(np.frombuffer(data, "<i4", 1, 16)[0])
    start = float(np.frombuffer(data, "<f4", 1, 20)[0])
    frames = int(np.frombuffer(data, "<i4", 1, 28)[0])
    return start, np.frombuffer(data, "<f4", 3 * points * frames, 32).reshape(frames, points, 3).astype(float)


def write_pc2(file, positions, start=0.0):
    """Positions [frames, points, 3]."""
    frames, points, _ = positions.shape
    header = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, points, start, 1.0, frames)
    pathlib.Path(file).write_bytes(header + positions.astype("<f4").tobytes())
