"""A frame is an array of pixels that shows itself in a notebook, and the one that the program draws."""

import pathlib
import struct
import subprocess
import sys
import zlib

import numpy
import strandsnap

program = sys.argv[1]
run = strandsnap.run(strandsnap.Scene("strand.toml", output__snapshots=6), "run")
try:
    frame = run.frame(view="cross-section", colour="plastic-strain", width=480, height=360, theme="light")
except strandsnap.MissingError as error:
    assert not strandsnap.HAS_FRAMES or "driver" in str(error) or "adapter" in str(error), error
    print(error.what)
    sys.exit(3)
assert isinstance(frame, strandsnap.Frame) and frame.shape == (360, 480, 3) and frame.dtype == numpy.uint8
assert len(numpy.unique(frame.reshape(-1, 3), axis=0)) > 20, "the picture is empty"


def pixels(png):
    """Pixels of a PNG: RGB, eight bits."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, data, size = 8, b"", None
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        content = png[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + content) == struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0]
        if kind == b"IHDR":
            size = struct.unpack(">2I", content[:8])
        if kind == b"IDAT":
            data += content
        at += 12 + length
    (width, height), stride = size, 1 + 3 * size[0]
    lines = numpy.frombuffer(zlib.decompress(data), numpy.uint8).reshape(height, stride)
    out = numpy.zeros((height, width * 3), numpy.int64)
    for y in range(height):
        kind, line = lines[y, 0], lines[y, 1:].astype(numpy.int64)
        above = out[y - 1] if y else numpy.zeros(width * 3, numpy.int64)
        if kind == 0:
            out[y] = line
        elif kind == 2:
            out[y] = (line + above) % 256
        else:
            for x in range(width * 3):
                left, up = out[y, x - 3] if x >= 3 else 0, above[x]
                corner = above[x - 3] if x >= 3 else 0
                if kind == 1:
                    guess = left
                elif kind == 3:
                    guess = (left + up) // 2
                else:
                    p = left + up - corner
                    guess = min((left, up, corner), key=lambda one: abs(p - one))
                out[y, x] = (line[x] + guess) % 256
    return out.reshape(height, width, 3)


assert numpy.array_equal(pixels(frame._repr_png_()), frame)
assert numpy.array_equal(pixels(frame[10:20, 30:50]._repr_png_()), frame[10:20, 30:50])
assert frame[0]._repr_png_() is None
frame.save("frame.png")
look = ["--views", "cross-section", "--colour", "plastic-strain", "--theme", "light", "--size", "480x360"]
subprocess.run([program, "render", "run", "--out", "drawn", "--quiet", *look], check=True, capture_output=True)
last = sorted(pathlib.Path("drawn").glob("frame_*.png"))[-1]
assert numpy.array_equal(pixels(last.read_bytes()), frame), "the program draws another picture"
for wrong in (dict(view="front"), dict(colour="red"), dict(zoom=0.0), dict(width=5)):
    try:
        run.frame(**wrong)
    except ValueError:
        continue
    raise AssertionError(f"{wrong} was taken")
print(f"{frame.shape}")
