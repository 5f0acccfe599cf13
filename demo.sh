#!/usr/bin/env bash
# Builds strandsnap and pulls the KA4 strand until it snaps. Works on a fresh machine; results go to out/ka4.
set -euo pipefail
cd "$(dirname "$0")"
source .ci/prepare.sh

need_rust
get_vulkan || fail "$WITHOUT_VULKAN
Without it: cargo run --release -- run ka4 --no-frames"

say "Building (the first time takes some minutes)"
cargo build --release --locked

say "Pulling the KA4 strand until it snaps"
target/release/strandsnap run ka4 --out out/ka4 --overwrite

say "What was written"
ls -l out/ka4
printf '%s pictures in out/ka4/frames\n' "$(find out/ka4/frames -name '*.png' | wc -l)"
version=$(awk '/^name = "rerun"$/ { getline; gsub(/version = |"/, ""); print; exit }' Cargo.lock)
cat <<TEXT

How to open it:
    out/ka4/frames           any picture viewer, from the first to the last
    out/ka4/recording.rrd    pip install rerun-sdk==$version && target/release/strandsnap view out/ka4
    out/ka4/curve.csv        any spreadsheet; wires.csv and ruptures.csv too
    out/ka4/summary.json     strength, elongation, which wires broke and where
One page with all of it, for any browser:
    target/release/strandsnap report out/ka4
Draw it again from elsewhere, without simulating:
    target/release/strandsnap render out/ka4 --views midsection --colour plastic-strain
TEXT
