#!/usr/bin/env bash
# Mutation testing of what turns state into numbers: cargo-mutants changes one expression at a time and sees whether a test
# notices. A mutant that survives ("missed") is either killed by a new test or named, with the reason why it is harmless, in
# assets/results/verification.md.
#
#   examples/mutants.sh                     law, engine and tables
#   examples/mutants.sh law engine          some of them: law, engine, tables, recording
#   SHARD=0/8 examples/mutants.sh law       an eighth of a part, spread evenly over it
#   RE='hertz.rs:20:' examples/mutants.sh law    only those whose name matches, for those that survived once more (and all
#                                           that leave out a field, which cargo-mutants does not filter)
#   LIST=1 examples/mutants.sh              only list the mutants
#   TESTS='--no-default-features --test=measures' SHARD=0/5 examples/mutants.sh engine    other tests than those below
#
# `law` needs nothing but the numbers of `base`, so it is built as a crate of its own: a mutant takes 2 to 5 s (two cores),
# the part one to two hours. In the other parts a mutant is a build of the engine, a minute or two, half of that without
# `--lib`: take shards. `recording` needs rerun and has not been run.
#
# Works in out/mutants/PART; results: out/mutants/PART/mutants.out/{caught,missed,timeout,unviable}.txt. A build that fails
# counts as unviable: look into the log of one before believing many.
set -euo pipefail
cd "$(dirname "$0")/.."

VERSION=27.1.0
if ! cargo mutants --version 2>/dev/null | grep -q "$VERSION"; then
    cargo install --locked cargo-mutants@"$VERSION"
fi

# Optimised a little, because the tests run simulations, and incremental. Without `lto = "off"`, incremental objects of one
# mutant at times do not link with those of the next, which would pass for an unviable mutant.
export CARGO_INCREMENTAL=1 CARGO_PROFILE_DEV_OPT_LEVEL=1 CARGO_PROFILE_DEV_DEBUG=false CARGO_PROFILE_DEV_LTO=off
# Random cases must be the same for every mutant.
export PROPTEST_RNG_SEED=1

files() {
    case $1 in
    law) echo 'src/law/*.rs src/law/**/*.rs' ;;
    engine) echo 'src/engine/measure.rs src/engine/step_view.rs src/engine/info.rs' ;;
    tables) echo 'src/observe/tables.rs src/observe/summary.rs src/observe/stiffness.rs' ;;
    recording) echo 'src/observe/recording/curve.rs src/observe/recording/particles.rs src/observe/recording/states.rs' ;;
    *)
        echo "there is no part $1: law, engine, tables, recording" >&2
        exit 2
        ;;
    esac
}

# What is built, and the tests that look at these numbers, for `cargo test`. `--lib` builds the library once more.
tests() {
    if [ -n "${TESTS:-}" ]; then
        echo "$TESTS"
        return
    fi
    case $1 in
    law) echo '--lib' ;;
    engine) echo '--no-default-features --lib --test=measures --test=shown' ;;
    tables) echo '--no-default-features --features=cli --lib --test=measures --test=check_run' ;;
    recording) echo '--no-default-features --features=cli,record --lib --test=recording --test=check_run' ;;
    esac
}

# A copy that cargo-mutants may change in place; build outputs beside it are kept from run to run.
copy() {
    rm -rf "$2"
    mkdir -p "$2"
    if [ "$1" != law ]; then
        git ls-files -z | xargs -0 cp --parents --preserve=timestamps -t "$2"
        return
    fi
    mkdir -p "$2/src/base"
    cp -r --preserve=timestamps src/law "$2/src/"
    cp --preserve=timestamps src/base/{lanes,random,triple}.rs "$2/src/base/"
    cp Cargo.lock "$2/"
    printf 'pub mod base {\n    pub mod lanes;\n    pub mod random;\n    pub mod triple;\n}\npub mod law;\n' >"$2/src/lib.rs"
    # Two thousand walks where two hundred show nearly as much in a tenth of the time.
    sed -i 's/with_cases(2000)/with_cases(200)/' "$2/src/law/tangential/mindlin_deresiewicz.rs"
    {
        printf '[package]\nname = "laws"\nversion = "0.1.0"\nedition = "2024"\n\n[workspace]\n\n[lib]\ndoctest = false\n\n'
        awk '/^\[/ { on = $0 == "[dependencies]" || $0 == "[dev-dependencies]"; if (on) print; next }
             on && /^(bytemuck|glam|proptest|pulp|serde) = /' Cargo.toml
        printf '\n[profile.dev.package."*"]\nopt-level = 0\n'
    } >"$2/Cargo.toml"
}

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(law engine tables)
root=$PWD/out/mutants
for part in "${parts[@]}"; do
    work=$root/$part
    mkdir -p "$work"
    options=(--in-place --output "$work" --colors never)
    for file in $(set -f; files "$part"); do options+=(--file "$file"); done
    for argument in $(tests "$part"); do options+=("--cargo-arg=$argument"); done
    [ -z "${SHARD:-}" ] || options+=(--sharding round-robin --shard "$SHARD")
    [ -z "${RE:-}" ] || options+=(--re "$RE")
    copy "$part" "$work/crate"
    if [ -n "${LIST:-}" ]; then
        (cd "$work/crate" && cargo mutants --list "${options[@]}")
        continue
    fi
    # The first build is long; what follows is timed against the unchanged tests. Loops that never end are caught by time.
    # Exit code 2: some survived, which is what is looked for; 3: some timed out.
    (
        cd "$work/crate"
        export CARGO_TARGET_DIR=$work/target
        cargo mutants --timeout-multiplier 10 --minimum-test-timeout 15 --build-timeout 3600 "${options[@]}"
    ) || [ $? -le 3 ]
    for kind in caught missed timeout unviable; do
        printf '%s, %s: %s\n' "$part" "$kind" "$(wc -l <"$work/mutants.out/$kind.txt")"
    done
done
