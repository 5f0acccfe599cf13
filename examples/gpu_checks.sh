#!/usr/bin/env bash
# Checks and measures steps on a graphics adapter, with programs that are brought along: nothing is built here.
#
#   examples/gpu_checks.sh PROGRAMS RESULTS [NAME]
#
# PROGRAMS is a folder with `strandsnap`, and `gpu` (the test binary) and `bench` where they are to be run; RESULTS takes
# what they write, JSON among it. NAME is that of the adapter, as `run --device` takes it [gpu]. STRAIN=5 ends the run of ka4
# at 5 % strain, BATCH=1,4 says how many strands are stepped at once, CHECKS=run,bench which parts are done.
set -euo pipefail
programs=$(realpath "$1")
results=$(mkdir -p "$2" && realpath "$2")
name=${3:-gpu}
checks=${CHECKS:-devices,tests,run,verify,stability,bench}
strandsnap=$programs/strandsnap

part() {
    [[ ",$checks," == *",$1,"* ]] || return 1
    echo "== $1, $(date +%T)"
}

if part devices; then
    "$strandsnap" devices --json | tee "$results/devices.json"
fi
if part tests && [ -x "$programs/gpu" ]; then
    "$programs/gpu" --nocapture --test-threads 1 | tee "$results/tests.txt"
fi
if part run; then
    stop=(--set "stop.strain=${STRAIN:-40} %")
    for device in "$name" cpu; do
        "$strandsnap" run ka4 "${stop[@]}" --device "$device" --no-frames --no-recording --quiet --overwrite \
            --out "$results/ka4-$device" | tee "$results/ka4-$device.txt"
    done
    # Up to the first rupture the curves are the same to 1e-6 of the strength.
    python3 - "$results/ka4-$name" "$results/ka4-cpu" <<'PY'
import csv, sys
def rows(folder, name):
    with open(f"{folder}/{name}") as file:
        return list(csv.DictReader(file))
there, here = (rows(folder, "curve.csv") for folder in sys.argv[1:])
broke = [rows(folder, "ruptures.csv")[:1] for folder in sys.argv[1:]]
first = float(broke[1][0]["strain_percent"]) if broke[1] else float("inf")
strength = max(float(row["stress_mpa"]) for row in here)
pairs = [pair for pair in zip(there, here) if float(pair[1]["strain_percent"]) < first]
off = max(abs(float(a["stress_mpa"]) - float(b["stress_mpa"])) for a, b in pairs) / strength
print(f"{len(pairs)} rows up to the first rupture: stress differs by {off:.1e} of {strength:.2f} MPa at most")
if all(broke):
    print("first wire:", *(found[0]["wire"] for found in broke))
PY
fi
if part verify; then
    "$strandsnap" verify --quick --device "$name" --threads 1 --no-plots --json "$results/verify.json" || echo "missed: $?"
fi
if part stability; then
    "$strandsnap" stability --quick --device "$name" --threads 1 --no-plots --json "$results/stability.json" || echo "missed: $?"
fi
if part bench && [ -x "$programs/bench" ]; then
    "$programs/bench" --device "$name" --batch "${BATCH:-1,16,256}" --threads 1 --json "$results/bench.json" |
        tee "$results/bench.txt"
fi
