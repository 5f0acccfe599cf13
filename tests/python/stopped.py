"""Ctrl-C, an exception in a callback and a time limit end a run as Ctrl-C ends the command line."""

import os
import pathlib
import signal
import subprocess
import sys
import threading

import strandsnap

program = sys.argv[1]
scene = strandsnap.Scene("strand.toml", stop__strain="15 %", output__samples=400)
whole = strandsnap.run(scene, "whole")
files = ["curve.csv", "wires.csv", "ruptures.csv", "trajectory.bin"]


def goes_on(folder):
    """Goes on with what was stopped, and finds what the run that was not stopped found."""
    assert strandsnap.Run(folder).summary["stopped"]["kind"] == "interrupted"
    kept = len(strandsnap.Run(folder).curve["step"])
    assert 0 < kept < len(whole.curve["step"]), kept
    rows = []
    strandsnap.resume(folder, on_row=lambda row: rows.append(row["step"]))
    assert rows == list(whole.curve["step"])
    for name in files:
        assert pathlib.Path(folder, name).read_bytes() == pathlib.Path("whole", name).read_bytes(), name


seen = []


def press(row):
    seen.append(row["step"])
    if len(seen) == 40:
        os.kill(os.getpid(), signal.SIGINT)


try:
    strandsnap.run(scene, "pressed", on_row=press)
    raise AssertionError("Ctrl-C raised nothing")
except KeyboardInterrupt as error:
    assert sys.version_info < (3, 11) or "strandsnap.resume" in error.__notes__[0]
assert len(seen) == 40, len(seen)
goes_on("pressed")

# Nothing is called here, and the signal comes from outside.
slow = strandsnap.Scene("ka4")
timer = threading.Timer(1.0, os.kill, [os.getpid(), signal.SIGINT])
timer.start()
try:
    strandsnap.run(slow, "alone")
    raise AssertionError("Ctrl-C raised nothing")
except KeyboardInterrupt:
    pass
assert strandsnap.Run("alone").summary["stopped"]["kind"] == "interrupted" and pathlib.Path("alone/curve.csv").is_file()
assert list(pathlib.Path("alone").glob("checkpoint-*.bin"))


class Mine(Exception):
    pass


def raises(row):
    if row["strain_percent"] > 1:
        raise Mine("enough")


try:
    strandsnap.run(scene, "raised", on_row=raises)
    raise AssertionError("the callback's exception was lost")
except Mine as error:
    assert str(error) == "enough"
last = strandsnap.Run("raised").curve["strain_percent"]
assert last[-2] <= 1 < last[-1] or last[-3] <= 1 < last[-2], last[-3:]
goes_on("raised")


def closed(share):
    raise Mine("no more")


try:
    strandsnap.run(scene, "progress", progress=closed)
    raise AssertionError("the exception of progress was lost")
except Mine:
    pass

limited = strandsnap.run(slow, "limited", time_limit=0.5)
assert limited.summary["stopped"]["kind"] == "interrupted"
# What Python has begun the command line ends, and the other way round.
strandsnap.run(scene, "begun", time_limit=0.05)
if strandsnap.Run("begun").summary["stopped"]["kind"] == "interrupted":
    subprocess.run([program, "resume", "begun", "--quiet"], check=True, capture_output=True)
    assert pathlib.Path("begun/curve.csv").read_bytes() == pathlib.Path("whole/curve.csv").read_bytes()
print(f"{len(whole.curve['step'])} rows, stopped after {len(seen)} and at {last[-1]:.2f} %")
