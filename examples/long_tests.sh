#!/usr/bin/env bash
# Tests that take too long for ./test.sh: 200 killed runs, 100,000 inputs made at random, strands made at random from 100
# seeds, a study of 500 cases that is killed 20 times and started twice at once, and a run of ten million steps whose memory
# and open files are watched.
#
#   examples/long_tests.sh                    all, about an hour on two cores
#   examples/long_tests.sh kills fuzz random study soak     some of them
#
# Ends with 1 when one fails. The last results stand in assets/results/stability.md.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${STRANDSNAP:-$PWD/target/release/strandsnap}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

kills() {
    STRANDSNAP_KILLS=200 cargo test --release --locked --test resume a_run_that_is_killed -- --nocapture
}

fuzz() {
    cargo test --release --locked --test fuzz -- --ignored --nocapture
}

random() {
    for ((seed = 1; seed <= ${SEEDS:-100}; seed++)); do
        PROPTEST_RNG_SEED=$seed cargo test --release --locked --quiet --test property -- any_strand random
    done
}

study() {
    cat >"$folder/many.toml" <<'TOML'
about = "Many short wires."
base = "single-wire"
set = ["output.checkpoint=300", "wire.0.to=[\"0 mm\", \"0 mm\", \"10 mm\"]", "grip.length=2 mm", "bond.rupture.strain=20 %", "stop.stress_fraction=", "stop.strain_after_drop=2 %"]
seeds = 125

[[axis]]
key = "grip.speed"
values = ["10 m/s", "15 m/s", "20 m/s", "25 m/s"]
TOML
    mkdir "$folder/whole" "$folder/killed"
    (cd "$folder/whole" && "$program" study ../many.toml >/dev/null)
    cd "$folder/killed"
    for ((i = 0; i < 20; i++)); do
        "$program" study ../many.toml >/dev/null 2>&1 &
        local running=$!
        sleep "$((RANDOM % 3)).$((RANDOM % 10))"
        kill -9 "$running" 2>/dev/null || true
        wait "$running" 2>/dev/null || true
    done
    echo "cases finished after 20 kills: $(find out -name case.json | wc -l) of 500"
    # Two at once: one of them is refused, or both make the same.
    "$program" study ../many.toml >/dev/null 2>"$folder/first.err" & local first=$!
    local codes=()
    "$program" study ../many.toml >/dev/null 2>"$folder/second.err" && codes+=(0) || codes+=($?)
    wait "$first" && codes+=(0) || codes+=($?)
    echo "two at once ended with ${codes[*]}"
    "$program" study ../many.toml >/dev/null
    for table in points.csv breaks.csv; do
        cmp "out/study/many/$table" "$folder/whole/out/study/many/$table"
    done
    echo "tables are the same to the byte"
    cd - >/dev/null
}

soak() {
    local steps=${STEPS:-10000000}
    "$program" run single-wire --set 'wire.0.to=["0 mm", "0 mm", "10 mm"]' --set 'grip.length=2 mm' \
        --set 'grip.speed=1 mm/s' --set "stop.steps=$steps" --set 'output.checkpoint=50000' --threads 1 --no-frames --no-recording \
        --quiet --out "$folder/soak" &
    local running=$! first=0 now=0 files=0
    # After a start, in which buffers grow to their size.
    sleep 10
    while kill -0 "$running" 2>/dev/null; do
        now=$(awk '/VmRSS/ { print $2 }' "/proc/$running/status" 2>/dev/null || true)
        files=$(ls "/proc/$running/fd" 2>/dev/null | wc -l)
        [ -n "$now" ] && [ "$files" -gt 0 ] || break
        [ "$first" -gt 0 ] || { first=$now; echo "after 10 s: $now kB, $files files open"; }
        last="$now kB, $files files open"
        sleep 5
    done
    wait "$running"
    echo "at the end: $last, $steps steps"
    [ "${last%% *}" -lt $((first + first / 10)) ] || { echo "memory has grown by more than a tenth"; return 1; }
}

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(kills fuzz random study soak)
for part in "${parts[@]}"; do
    printf '\n== %s\n' "$part"
    time "$part"
done
