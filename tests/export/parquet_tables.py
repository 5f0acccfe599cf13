"""Tables of an export in pandas (pyarrow), polars and DuckDB: values, types, units. Arguments: folder of the run, of the export."""

import csv
import json
import sys

import duckdb
import pandas
import polars
import pyarrow.parquet as pq

run, export = sys.argv[1:]
TABLES = ["curve", "wires", "ruptures", "wire_series", "bond_series"]


def close(a, b):
    return abs(a - b) <= 1e-7 * max(abs(a), abs(b)) + 1e-12


# The tables of the run, under the names of the CSV files.
for name in TABLES[:3]:
    frame = pandas.read_parquet(f"{export}/{name}.parquet")
    with open(f"{run}/{name}.csv") as file:
        rows = list(csv.DictReader(file))
    assert list(frame.columns) == list(rows[0]), name
    assert len(frame) == len(rows) > 0, name
    for column in frame.columns:
        for ours, text in zip(frame[column], (row[column] for row in rows)):
            if pandas.isna(ours):
                assert text == "", (name, column, text)
            elif isinstance(ours, str):
                assert ours == text, (name, column)
            elif frame[column].dtype == bool:
                assert ("yes" if ours else "no") == text, (name, column)
            else:
                assert close(float(ours), float(text)), (name, column, ours, text)

# Units and meaning stand with every column; once more for the whole file.
for name in TABLES:
    schema = pq.read_schema(f"{export}/{name}.parquet")
    units = json.loads(schema.metadata[b"strandsnap.units"])
    assert schema.metadata[b"strandsnap.run"] and schema.metadata[b"strandsnap.run_id"]
    for field in schema:
        unit = field.metadata.get(b"unit", b"").decode()
        assert field.metadata[b"about"], (name, field.name)
        assert units.get(field.name, "") == unit, (name, field.name)
        for end, its in [("_mpa", "MPa"), ("_mm", "mm"), ("_percent", "%"), ("_s", "s"), ("_j", "J"), ("_n", "N")]:
            if field.name.endswith(end) and not field.name.endswith("_n_mm"):
                assert unit == its, (name, field.name, unit)

# The same numbers in each program: greatest stress, broken bonds at the end.
bonds = f"{export}/bond_series.parquet"
pandas_bonds = pandas.read_parquet(bonds)
polars_bonds = polars.read_parquet(bonds)
last = pandas_bonds[pandas_bonds.step == pandas_bonds.step.max()]
broken = (last.state == "broken").sum()
assert broken == len(pandas.read_parquet(f"{export}/ruptures.parquet")) > 0
assert set(pandas_bonds.state) == {"whole", "yielding", "broken"}
assert (pandas_bonds[pandas_bonds.state == "broken"].stress_mpa == 0).all()
greatest = float(pandas_bonds.stress_mpa.max())
assert float(polars_bonds["stress_mpa"].max()) == greatest
counted = duckdb.sql(
    f"""select max(stress_mpa), count(*) filter (state = 'broken' and step = (select max(step) from '{bonds}'))
    from '{bonds}'"""
).fetchall()[0]
assert counted == (greatest, broken), counted
known = duckdb.sql(f"select key::varchar from parquet_kv_metadata('{bonds}')").fetchall()
assert ("strandsnap.units",) in known, known

# The bonds that broke are those of ruptures.csv.
ruptures = pandas.read_csv(f"{run}/ruptures.csv")
gone = last[last.state == "broken"]
assert set(zip(gone.wire, gone.bond)) == set(zip(ruptures.wire, ruptures.bond))

# Series agree with the curve: strain, time, and layer stress as the mean of its wires.
curve = pandas.read_csv(f"{run}/curve.csv").set_index("step")
wires = pandas.read_parquet(f"{export}/wire_series.parquet")
for (step, layer), group in wires.groupby(["step", "layer"]):
    row = curve.loc[step]
    assert close(group.time_s.iloc[0], row.time_s) and close(group.strain_percent.iloc[0], row.strain_percent)
    mean, told = group.stress_mpa.mean(), row[f"stress_{layer.replace(' ', '_')}_mpa"]
    assert abs(mean - told) < 1e-6 * abs(told) + 1e-6, (step, layer, mean, told)
for step, group in wires.groupby("step"):
    assert group.bonds_broken.sum() == curve.loc[step].bonds_broken, step
seen = pandas_bonds.drop_duplicates("step").set_index("step")
both = seen.merge(curve, left_index=True, right_index=True, suffixes=("", "_csv"))
assert len(both) > 1 and (both.time_s - both.time_s_csv).abs().max() < 1e-12
assert (both.strain_percent - both.strain_percent_csv).abs().max() < 1e-6
print(f"{len(pandas_bonds)} rows of bonds, {broken} broken")
