"""Tables of a study as Parquet in pandas and polars, against the CSV files. Argument: folder of the study."""

import csv
import sys

import pandas
import polars
import pyarrow.parquet as pq

(study,) = sys.argv[1:]


def same(ours, text):
    if pandas.isna(ours):
        return text == ""
    return ours == text if isinstance(ours, str) else float(ours) == float(text)


for name in ["cases", "points", "breaks"]:
    frame = pandas.read_parquet(f"{study}/{name}.parquet")
    with open(f"{study}/{name}.csv") as file:
        rows = list(csv.DictReader(file))
    assert list(frame.columns) == list(rows[0]), name
    assert len(frame) == len(rows) > 0, name
    for column in frame.columns:
        for ours, text in zip(frame[column], (row[column] for row in rows)):
            assert same(ours, text), (name, column, ours, text)
    assert polars.read_parquet(f"{study}/{name}.parquet").height == len(rows)
    schema = pq.read_schema(f"{study}/{name}.parquet")
    assert schema.metadata[b"strandsnap.study"] == b"own", schema.metadata
    # What is a number can be reckoned with, in the unit that its name says.
    for field in schema:
        unit = field.metadata.get(b"unit", b"").decode() if field.metadata else ""
        if "[" in field.name:
            assert str(field.type) == "double" and f"[{unit}]" in field.name, (name, field)

cases = pandas.read_parquet(f"{study}/cases.parquet")
assert sorted(set(cases["speed [m/s]"])) == [15.0, 20.0] and len(cases) == 4
points = pandas.read_parquet(f"{study}/points.parquet")
mean = cases.groupby("speed [m/s]")["strength [MPa]"].mean()
ours = points[points.quantity == "strength"].set_index("speed [m/s]")["mean"]
assert (abs(mean - ours) < 1e-9).all(), (mean, ours)
print(points[["speed [m/s]", "quantity", "mean", "unit"]].to_string())
