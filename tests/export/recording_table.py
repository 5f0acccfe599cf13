"""The lines of the document that make a table of a recording, run on one. Arguments: the document, the recording, a layer's name,
the exported series of wires."""

import re
import sys

import pandas

try:
    import rerun  # noqa: F401
except ImportError:
    print("no rerun-sdk in this Python")
    sys.exit(3)

document, recording, layer, series = sys.argv[1:]
with open(document) as file:
    blocks = re.findall(r"```python\n(.*?)```", file.read(), re.S)
(lines,) = [block for block in blocks if "RrdReader" in block]
assert len([line for line in lines.splitlines() if line and "import" not in line]) < 10
told = {}
exec(lines.replace("out/ka4/recording.rrd", recording).replace("/outer", f"/{layer}"), told)
stress, rows = told["stress"], told["rows"]

# The same numbers as in the export: as many wires, and at each step that both have the stress of each.
own = pandas.read_parquet(series)
own = own[own.layer == layer]
wires = sorted(own.wire.unique())
assert [int(re.search(r"\d+", name).group()) for name in stress.columns] == wires, (list(stress.columns), wires)
table = own.pivot(index="step", columns="wire", values="stress_mpa")
compared = 0
for step, strain, of_wires in zip(rows["step"], stress.index, stress.to_numpy()):
    if step in table.index:
        assert (abs(table.loc[step].to_numpy() - of_wires) <= 1e-3 + 1e-4 * abs(of_wires)).all(), (step, of_wires)
        percent = own[own.step == step].strain_percent.iloc[0]
        assert abs(percent - strain) < 1e-3 + 1e-4 * abs(percent), (percent, strain)
        compared += 1
assert compared > 20, compared
print(f"{compared} rows of {len(wires)} wires are the export's")
