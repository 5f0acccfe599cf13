#!/usr/bin/env bash
# Every check and test. Works on a fresh machine; what cannot run there is reported as SKIPPED by its name.
set -euo pipefail
cd "$(dirname "$0")"
source .ci/prepare.sh

need_rust
get_vulkan || printf '\n%s\nTests of frames will be SKIPPED.\n' "$WITHOUT_VULKAN"
get_browser || printf '\nNo Chromium is here and none can be installed; tests of pages in a browser will be SKIPPED.\n'
get_axe || printf '\nThe rules of accessibility (axe-core, from npm) cannot be installed here; tests of them will be SKIPPED.\n'
get_rerun || printf '\nRerun'"'"'s tool cannot be installed here; tests that need it will be SKIPPED.\n'
get_batch_systems || printf '\nSlurm or GNU Parallel cannot be installed here; tests that need them will be SKIPPED.\n'
get_readers || printf '\nPrograms that read exports cannot be installed here; tests that need them will be SKIPPED.\n'
get_python_package || printf '\nThe Python package cannot be built here; tests of it will be SKIPPED.\n'

say "Shell syntax"
for script in demo.sh test.sh .ci/run .ci/features .ci/deb .ci/prepare.sh examples/peers/compare.sh examples/long_tests.sh examples/mutants.sh examples/gpu_checks.sh \
    tests/cluster/slurm.sh; do
    bash -n "$script"
done

say "Format"
cargo fmt --all --check

# .ci/features checks every feature by itself, which takes long.
say "Without recording and frames"
cargo clippy --release --locked --no-default-features --features cli --all-targets -- -D warnings

say "Lints"
cargo clippy --release --locked --all-targets -- -D warnings
if [ -n "${STRANDSNAP_PYTHON:-}" ]; then
    PYO3_PYTHON="$STRANDSNAP_PYTHON" cargo clippy --release --locked -p strandsnap-python --features full -- -D warnings
fi

say "Documentation"
RUSTDOCFLAGS=-Dwarnings cargo doc --release --locked --no-deps

say "Tests"
# Cases made at random are the same ones everywhere; `cargo test` alone draws new ones, and examples/long_tests.sh many.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-2611}
# One profile for demo and tests, so that the heavy libraries are built once.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cargo test --release --locked 2>&1 | tee "$log"

# The harness counts a test that could not run as passed; it is taken off again here.
passed=$(awk '/^test result:/ { sum += $4 } END { print sum + 0 }' "$log")
skipped=$(grep -c 'SKIPPED (' "$log" || true)
say "$((passed - skipped)) tests passed, $skipped were SKIPPED"
grep -o 'SKIPPED (.*' "$log" || true
