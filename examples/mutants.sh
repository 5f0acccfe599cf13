#!/usr/bin/env bash
# Mutation testing of what turns state into numbers: cargo-mutants changes one expression at a time and sees whether a test
# notices. Takes hours. A mutant that survives ("missed") is either killed by a new test or named as harmless in README.
#
#   examples/mutants.sh                     all parts
#   examples/mutants.sh law engine          some of them: law, engine, tables, recording
#   SHARD=0/8 examples/mutants.sh law       an eighth of a part, for a look
#   LIST=1 examples/mutants.sh              only list the mutants
#
# Results: out/mutants/PART/mutants.out/{caught,missed,timeout,unviable}.txt
set -euo pipefail
cd "$(dirname "$0")/.."

VERSION=27.1.0
if ! cargo mutants --version 2>/dev/null | grep -q "$VERSION"; then
    cargo install --locked cargo-mutants@"$VERSION"
fi

# Built once and then incrementally, for each mutant; optimised a little, because the tests run simulations.
export CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_PROFILE_RELEASE_INCREMENTAL=true CARGO_PROFILE_RELEASE_DEBUG=false
# Random cases must be the same for every mutant.
export PROPTEST_RNG_SEED=1

files() {
    case $1 in
    law) echo 'src/law/**/*.rs' ;;
    engine) echo 'src/engine/measure.rs src/engine/step_view.rs src/engine/info.rs' ;;
    tables) echo 'src/observe/tables.rs src/observe/summary.rs src/observe/stiffness.rs' ;;
    recording) echo 'src/observe/recording/curve.rs src/observe/recording/particles.rs src/observe/recording/states.rs' ;;
    *) echo "there is no part $1: law, engine, tables, recording" >&2; exit 2 ;;
    esac
}

# The tests that look at these numbers; a mutant that only others would catch is worth a look too.
tests() {
    case $1 in
    law) echo '--lib --test verify --test property' ;;
    engine | tables) echo '--lib --test check_run --test run --test page' ;;
    recording) echo '--lib --test recording --test check_run' ;;
    esac
}

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(law engine tables recording)
for part in "${parts[@]}"; do
    options=(--profile release --jobs 1 --timeout 900 --build-timeout 1800 --output "out/mutants/$part" --colors never)
    for file in $(set -f; files "$part"); do options+=(--file "$file"); done
    # Recordings need the library that writes them; everything else is built lean.
    [ "$part" = recording ] || options+=(--no-default-features --features cli)
    [ -z "${SHARD:-}" ] || options+=(--shard "$SHARD")
    if [ -n "${LIST:-}" ]; then
        cargo mutants --list "${options[@]}"
        continue
    fi
    mkdir -p "out/mutants/$part"
    # Exit code 2: some survived, which is what is looked for; 3: some timed out.
    # shellcheck disable=SC2046
    cargo mutants "${options[@]}" -- $(tests "$part") || [ $? -le 3 ]
    for kind in caught missed timeout unviable; do
        printf '%s, %s: %s\n' "$part" "$kind" "$(wc -l <"out/mutants/$part/mutants.out/$kind.txt")"
    done
done
