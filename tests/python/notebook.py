"""The cells of the notebook run one after the other."""

import json
import pathlib
import sys

root = pathlib.Path(sys.argv[2])
book = json.loads((root / "examples/wire.ipynb").read_text())
assert book["nbformat"] == 4
cells = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
assert len(cells) > 3
names = {}
for number, cell in enumerate(cells, 1):
    exec(compile(cell, f"cell {number}", "exec"), names)
print(f"{len(cells)} cells")
