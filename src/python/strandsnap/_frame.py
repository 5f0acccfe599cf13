"""A picture as an array."""

import struct
import zlib

import numpy


class Frame(numpy.ndarray):
    """A picture: uint8 of shape (height, width, 3). Notebooks show it; parts of it are pictures too."""

    def _repr_png_(self):
        if self.dtype != numpy.uint8 or self.ndim != 3 or self.shape[2] != 3 or self.size == 0:
            return None
        height, width, _ = self.shape
        # A byte before each row says that it stands as it is.
        rows = numpy.zeros((height, 1 + 3 * width), numpy.uint8)
        rows[:, 1:] = self.reshape(height, 3 * width)
        head = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)
        parts = [(b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b"")]
        return b"\x89PNG\r\n\x1a\n" + b"".join(map(_chunk, parts))

    def save(self, path):
        """Writes it as PNG."""
        png = self._repr_png_()
        if png is None:
            raise ValueError(f"an array of {self.dtype} and shape {self.shape} is no picture")
        with open(path, "wb") as file:
            file.write(png)


def _chunk(part):
    kind, data = part
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
