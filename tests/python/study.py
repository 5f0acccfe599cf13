"""Studies and calibrations from Python find what the command line finds."""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading

import numpy
import strandsnap

program = sys.argv[1]
WIRES = """
about = "Some short wires."
base = "single-wire"
set = ["wire.0.to=[\\"0 mm\\", \\"0 mm\\", \\"10 mm\\"]", "grip.length=2 mm", "bond.rupture.strain=20 %",
    "stop.stress_fraction=", "stop.strain_after_drop=2 %"]
seeds = 2

[[axis]]
key = "grip.speed"
values = ["20 m/s", "30 m/s"]
"""
pathlib.Path("wires.toml").write_text(WIRES)
subprocess.run([program, "study", "wires.toml", "--out", "cli"], check=True, capture_output=True)
study = strandsnap.Study("wires.toml")
assert len(study) == 4 and len(study.cases) == 4 and study.missing("py") == [1, 2, 3, 4]
assert study.run_case(2, "py") == "ran" and study.missing("py") == [1, 3, 4]
shares = []
found = study.run("py", progress=shares.append)
assert shares == sorted(shares) and shares[-1] == 1 and study.missing("py") == [] and found.missing == 0


def rows(folder, name):
    with open(f"{folder}/{name}.csv", newline="") as file:
        return [{key: cell for key, cell in row.items() if not key.endswith("[s]")} for row in csv.DictReader(file)]


for name in ("cases", "points", "breaks"):
    assert rows("cli", name) == rows("py", name), name
    table = getattr(found, name)
    for key in rows("py", name)[0]:
        cells = [row[key] for row in rows("py", name)]
        column = table[key]
        if column.dtype.kind in "fi":
            cells = [float(cell) if cell else numpy.nan for cell in cells]
            assert numpy.array_equal(column.astype(float), cells, equal_nan=True), (name, key)
        else:
            assert list(column) == cells, (name, key)
assert set(found.cases["outcome"]) == {"ran"} and "Some short wires" not in found.text and "strength" in found.text
assert all(file.is_file() for file in found.files)
same = strandsnap.Study.from_text(WIRES, name="wires.toml", seeds=[1]).collect("py")
assert len(same.cases["case"]) == 2

pathlib.Path("slow.toml").write_text('about = "Two strands."\nbase = "ka4"\nseeds = 2\n')
timer = threading.Timer(1.5, os.kill, [os.getpid(), signal.SIGINT])
timer.start()
try:
    strandsnap.Study("slow.toml").run("slow")
    raise AssertionError("Ctrl-C raised nothing")
except KeyboardInterrupt:
    assert strandsnap.Study("slow.toml").missing("slow") == [1, 2]

short = {"wire.0.to": ["0 mm", "0 mm", "30 mm"], "grip.length": "5 mm", "bond.rupture.strain": "4 %"}
scene = strandsnap.Scene("single-wire", short, bond__rupture__weibull_modulus="inf", grip__speed="5 m/s")
fitted = strandsnap.calibrate(scene, 150, 5, tolerance=1, out="fit")
options = [f"--set={option}" for option in ['wire.0.to=["0 mm", "0 mm", "30 mm"]', "grip.length=5 mm",
    "bond.rupture.strain=4 %", "bond.rupture.weibull_modulus=inf", "grip.speed=5 m/s"]]
fit = ["calibrate", "single-wire", *options, "--strength", "150", "--elongation", "5", "--out", "fit-cli"]
subprocess.run([program, *fit], check=True, capture_output=True)
[one, other] = [json.loads(pathlib.Path(folder, "calibration.json").read_text()) for folder in ("fit", "fit-cli")]
assert one["set"] == other["set"] == fitted.set and one["target"] == other["target"]
assert abs(fitted.trials["strength_error_percent"][-1]) <= 1 and fitted.file == pathlib.Path("fit/calibration.json")
print(f"{len(found.cases['case'])} cases, fitted in {len(fitted.trials['seeds'])} settings")
