# Sourced by ./demo.sh and ./test.sh: what both need on a fresh machine.

say() { printf '\n== %s\n' "$*"; }

# Mesa complains without a session folder, which off-screen pictures do not need.
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-${TMPDIR:-/tmp}}"

fail() {
    printf '\n%s\n' "$*" >&2
    exit 3
}

need_rust() {
    # rustup puts cargo here, but only a new shell has it on its PATH.
    if ! command -v cargo >/dev/null && [ -x "${CARGO_HOME:-$HOME/.cargo}/bin/cargo" ]; then
        PATH="${CARGO_HOME:-$HOME/.cargo}/bin:$PATH"
    fi
    command -v cargo >/dev/null || fail "Rust is missing. Install it with
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh
then open a new shell and start this script again."
    command -v cc >/dev/null || fail "A C linker (cc) is missing, which Rust needs.
On Debian and Ubuntu: apt-get install build-essential; on macOS: xcode-select --install."
}

# Whether a Vulkan driver is described anywhere the loader looks.
has_vulkan_driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return 0
    local folder file
    for folder in /usr/share/vulkan/icd.d /etc/vulkan/icd.d /usr/local/share/vulkan/icd.d \
        "${XDG_DATA_HOME:-$HOME/.local/share}/vulkan/icd.d"; do
        for file in "$folder"/*.json; do
            [ -e "$file" ] && return 0
        done
    done
    return 1
}

# Installs Debian packages; the first argument says why. Fails where there is no apt-get or no right to use it.
install_packages() {
    local why="$1" as_root=()
    shift
    command -v apt-get >/dev/null || return 1
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || return 1
        as_root=(sudo)
    fi
    say "$why ($*)"
    "${as_root[@]}" apt-get update -q && "${as_root[@]}" apt-get install -y -q --no-install-recommends "$@"
}

# Whether a Vulkan driver is there or could be installed.
get_vulkan() {
    has_vulkan_driver || install_packages "No graphics driver: installing Mesa's software driver" mesa-vulkan-drivers libvulkan1
}

WITHOUT_VULKAN="No Vulkan driver was found, which frames need. A software driver is enough:
    Debian, Ubuntu   apt-get install mesa-vulkan-drivers libvulkan1
    Fedora           dnf install mesa-vulkan-drivers vulkan-loader
    Arch             pacman -S vulkan-swrast vulkan-icd-loader"

# Whether a browser that works without a window is there or could be installed; tests/browser looks for these names.
get_browser() {
    local name
    for name in chromium chromium-browser google-chrome google-chrome-stable; do
        command -v "$name" >/dev/null && return 0
    done
    install_packages "No browser: installing Chromium, which opens the pages of runs in tests" chromium
}

# Programs that read exports, as Python packages in .venv; sets READERS_PYTHON when they are there.
get_readers() {
    local packages=(pyarrow==26.0.1 pandas==3.1.1 polars==2.1.0 duckdb==2.0.1 vtk==9.7.2 ovito==3.17.2)
    local try="import pyarrow, pandas, polars, duckdb, vtk, ovito"
    if ! .venv/bin/python -c "$try" 2>/dev/null; then
        say "Installing programs that read exports into .venv (${packages[*]})"
        python3 -m venv .venv && .venv/bin/pip install -q "${packages[@]}" && .venv/bin/python -c "$try" || return 1
    fi
    export READERS_PYTHON="$PWD/.venv/bin/python"
}

# Whether batch systems are there or could be installed. Daemons of Slurm need root.
get_batch_systems() {
    { command -v slurmctld && command -v munged && command -v parallel; } >/dev/null ||
        install_packages "For tests of studies on clusters: installing Slurm and GNU Parallel" slurm-wlm munge parallel
}

# Rerun's own tool in .venv, in the version that Cargo.lock names; sets RERUN_CLI when it is there.
get_rerun() {
    local version
    version=$(awk '/^name = "rerun"$/ { getline; gsub(/version = |"/, ""); print; exit }' Cargo.lock)
    if ! .venv/bin/rerun --version 2>/dev/null | grep -qF " $version "; then
        say "Installing Rerun's tool $version into .venv"
        python3 -m venv .venv && .venv/bin/pip install -q "rerun-sdk==$version" || return 1
    fi
    # No usage statistics from tests.
    .venv/bin/rerun analytics disable >/dev/null 2>&1 || true
    export RERUN_CLI="$PWD/.venv/bin/rerun"
}

# Rules of accessibility for pages in tests, as a package of npm in .venv; sets AXE_FOR_TESTS when they are there.
get_axe() {
    local package=axe-core@4.14.1 file=.venv/axe/node_modules/axe-core
    if ! grep -qsF "\"version\": \"${package#*@}\"" "$file/package.json"; then
        command -v npm >/dev/null || install_packages "No npm: installing it, for the rules of accessibility in tests" npm || return 1
        say "Installing $package into .venv"
        npm install --silent --no-audit --no-fund --ignore-scripts --prefix .venv/axe "$package" || return 1
    fi
    export AXE_FOR_TESTS="$PWD/$file/axe.min.js"
}

# The Python package in .venv; sets STRANDSNAP_PYTHON when it is there. It is built with all features, so that what it compiles
# is what the tests use.
get_python_package() {
    say "Building the Python package into .venv"
    [ -x .venv/bin/pip ] || python3 -m venv .venv || return 1
    .venv/bin/pip install -q --config-settings build-args="--features full --locked" "./src/python[dask]" || return 1
    export STRANDSNAP_PYTHON="$PWD/.venv/bin/python"
}
