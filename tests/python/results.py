"""A run from Python and one from the command line write the same bytes, and arrays hold what the files say."""

import csv
import gc
import pathlib
import subprocess
import sys
import threading
import time

import numpy
import strandsnap

program = sys.argv[1]
command = [program, "run", "strand.toml", "--quiet", "--no-frames", "--no-recording", "--out", "cli", "--seed", "3"]
settings = ["output.snapshots=8", "output.samples=60", "contact.friction=0.25"]
subprocess.run(command + [word for setting in settings for word in ("--set", setting)], check=True)

# Text, numbers, keywords and numpy's own scalars all mean what --set means.
changes = {"output.snapshots": "8"}
scene = strandsnap.Scene("strand.toml", changes, output__samples=numpy.int64(60), contact__friction=0.25, seed=3)
assert "friction = 0.25" in scene.toml and scene.name == "strand", scene.toml
text = pathlib.Path("strand.toml").read_text()
same = strandsnap.Scene.from_text(text, ["output.snapshots=8", *settings[1:]], name="strand.toml", seed=3)
assert same.toml == scene.toml and same.about.startswith("A small strand")

rows, shares, threads = [], [], set()


def on_row(row):
    rows.append(row)
    threads.add(threading.get_ident())


# The interpreter is free while the engine works.
ticks = []
done = threading.Event()
ticker = threading.Thread(target=lambda: [ticks.append(time.sleep(0.005)) for _ in iter(done.is_set, True)])
ticker.start()
run = strandsnap.run(scene, "py", on_row=on_row, progress=shares.append)
done.set()
ticker.join()
assert len(ticks) > 5, f"{len(ticks)} ticks"
assert threads == {threading.get_ident()}

for name in ["curve.csv", "wires.csv", "ruptures.csv", "scene.toml", "trajectory.bin"]:
    one, other = (pathlib.Path(folder, name).read_bytes() for folder in ("cli", "py"))
    assert one == other, f"{name} differs"
assert run.folder == pathlib.Path("py") and run.scene.toml == scene.toml
assert run.summary["tensile_strength_mpa"] == strandsnap.Run("cli").summary["tensile_strength_mpa"]


def in_csv(value):
    """A value as CSV files hold it, numbers in nine digits."""
    if isinstance(value, (bool, numpy.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (float, numpy.floating)):
        return None if numpy.isnan(value) else float(f"{value:.8e}")
    return float(value) if isinstance(value, (int, numpy.integer)) else str(value)


def read(cell, column):
    if column.dtype.kind in "fi":
        return float(cell) if cell else None
    return cell


for opened in (run, strandsnap.Run(pathlib.Path("cli"))):
    for name in ("curve", "wires", "ruptures"):
        table = getattr(opened, name)
        with open(f"cli/{name}.csv", newline="") as file:
            lines = list(csv.DictReader(file))
        assert list(table) == list(lines[0]), (name, list(table))
        for key, column in table.items():
            assert [in_csv(value) for value in column] == [read(line[key], column) for line in lines], (name, key)
assert run.wires["broken"].dtype == bool and run.wires["wire"].dtype == numpy.int64
assert run.wires["broken"].any() and run.wires["layer"][0] == "core"

# Rows as they came are those that are kept, to the bit.
assert [list(row) for row in rows] == [list(run.curve)] * len(rows)
for key, column in run.curve.items():
    assert numpy.array_equal([row[key] for row in rows], column), key
assert shares == sorted(shares) and 0 <= shares[0] < 0.1 and 0.5 < shares[-1] <= 1, shares[-1]

# Nothing is copied: an array is the memory that the engine's own rows were gathered in, and outlives the run.
strain, stress = run.curve["strain_percent"], run.curve["stress_mpa"]
assert stress.base is not None and not stress.flags.owndata and stress.flags.writeable
assert run.curve["stress_mpa"] is stress
before = stress.copy()

final = run.positions()
count = len(final)
assert final.shape == (count, 3) and final.dtype == numpy.float32
snapshot = run.snapshot(index=-1)
assert numpy.array_equal(snapshot["position_m"], final) and snapshot["wire"].max() == 7
assert {len(column) for column in snapshot.values()} == {count}
assert (snapshot["bond_state"] == 2).sum() == run.summary["bonds_broken"] == len(run.ruptures["wire"])
# At rest the wires go from 0 to 12 mm.
first = run.positions(index=0)
assert abs(first[:, 2].min()) < 1e-9 and abs(first[:, 2].max() - 12e-3) < 1e-8
strains = run.snapshots["strain_percent"]
middle = len(strains) // 2
assert numpy.array_equal(run.positions(strains[middle]), run.positions(index=middle))
assert numpy.array_equal(run.positions(strains[middle] + 1e-3), run.positions(index=middle))
for wrong, kind in [(dict(strain=50), ValueError), (dict(index=1000), IndexError), (dict(strain=1, index=1), ValueError)]:
    try:
        run.positions(**wrong)
    except kind:
        continue
    raise AssertionError(f"{wrong} was taken")

# Positions are those that other programs read, in mm.
subprocess.run([program, "export", "cli", "--format", "xyz", "--out", "xyz"], check=True, capture_output=True)
lines = pathlib.Path("xyz/particles.xyz").read_text().splitlines()[-count:]
exported = numpy.array([line.split()[1:4] for line in lines], float)
assert numpy.allclose(exported, 1000 * final.astype(float), rtol=1e-6, atol=0), abs(exported - 1000 * final).max()
also = strandsnap.run(scene, "also", overwrite=True)
assert not pathlib.Path("also/xyz").exists()
also = strandsnap.run(strandsnap.Scene("also/scene.toml", output__also=["xyz"]), "also-xyz")
# Lines with a sign of equality name the run, which is another one.
bodies = [pathlib.Path(folder, "particles.xyz").read_text().splitlines() for folder in ("also-xyz/xyz", "xyz")]
of_particles = [[line for line in lines if "=" not in line] for lines in bodies]
assert of_particles[0] == of_particles[1] and len(of_particles[0]) > count
del run, opened
gc.collect()
assert numpy.array_equal(stress, before) and len(strain) == len(stress)
print(f"{len(rows)} rows, {count} particles")
