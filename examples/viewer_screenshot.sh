#!/bin/sh
# Opens a recording in the real Rerun viewer, off screen, and keeps a picture of it once it has settled.
#
#   examples/viewer_screenshot.sh RECORDING.rrd PICTURE.png [WIDTHxHEIGHT]
#
# Needs the viewer and its Python package (`pip install rerun-sdk==0.36.3`; its program on PATH as `rerun`, or its path
# in $RERUN_CLI) and a Vulkan driver (Debian: apt-get install mesa-vulkan-drivers).
# Exit codes: 0 done, 1 the viewer made no picture, 2 bad arguments, 3 something missing on this machine.
set -eu

VERSION=0.36.3
PORT=${PORT:-19876}

fail() {
    code=$1
    shift
    echo "viewer_screenshot: $*" >&2
    exit "$code"
}

[ $# -ge 2 ] || fail 2 "usage: $0 RECORDING.rrd PICTURE.png [WIDTHxHEIGHT]"
recording=$1
size=${3:-1600x900}
[ -s "$recording" ] || fail 2 "there is no recording at $recording"
echo "$size" | grep -Eq '^[1-9][0-9]*x[1-9][0-9]*$' || fail 2 "\"$size\" is no size; write it as 1600x900"
mkdir -p "$(dirname "$2")"
picture=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")

wrapper=${RERUN_CLI:-$(command -v rerun || true)}
[ -n "$wrapper" ] || fail 3 "no Rerun viewer: pip install rerun-sdk==$VERSION"
# The `rerun` of the Python package is a script around the real program; ending the script would leave that running.
head -c 2 "$wrapper" | grep -q '#!' || fail 3 "$wrapper is not the rerun of the Python package rerun-sdk"
python=$(head -n 1 "$wrapper" | sed 's/^#! *//')
viewer=$($python -c 'import os, rerun_cli; print(os.path.join(os.path.dirname(rerun_cli.__file__), "rerun"))' || true)
[ -x "$viewer" ] || fail 3 "no program inside the Python package of $wrapper: pip install rerun-sdk==$VERSION"
found=$("$viewer" --version 2>/dev/null | head -n 1)
case $found in
    *" $VERSION "*) ;;
    *) fail 3 "the viewer is not of version $VERSION but \"$found\": pip install rerun-sdk==$VERSION" ;;
esac

has_vulkan() {
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    for file in /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json /usr/local/share/vulkan/icd.d/*.json; do
        [ ! -e "$file" ] || return 0
    done
    return 1
}
[ "$(uname)" != Linux ] || has_vulkan || fail 3 "no Vulkan driver: on Debian, apt-get install mesa-vulkan-drivers"

# A fresh home: the viewer would otherwise show a layout that it remembers instead of the file's own.
home=$(mktemp -d)
process=
clean() {
    if [ -n "$process" ]; then
        kill "$process" 2>/dev/null || true
        # It writes into its home until it has ended, and holds its port.
        wait "$process" 2>/dev/null || true
    fi
    rm -rf "$home"
}
trap clean EXIT
HOME=$home "$viewer" analytics disable >/dev/null 2>&1
HOME=$home XDG_RUNTIME_DIR=$home "$viewer" --headless --hide-welcome-screen --bind 127.0.0.1 --port "$PORT" \
    --window-size "$size" "$recording" >"$home/log" 2>&1 &
process=$!

rm -f "$picture"
# A recording loads bit by bit, so the picture counts once two in a row are the same.
if ! $python - "$PORT" "$picture" "$home/last.png" <<'EOF'
import pathlib, sys, time
from rerun.experimental import ViewerClient

port, picture, last = sys.argv[1:]
deadline = time.monotonic() + 180
time.sleep(3)
client = ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")
before = None
while time.monotonic() < deadline:
    client.save_screenshot(last)
    now = pathlib.Path(last).read_bytes()
    # The viewer may still be writing it.
    if now and now == before:
        pathlib.Path(picture).write_bytes(now)
        sys.exit(0)
    before = now
    time.sleep(3)
sys.exit("the picture did not settle within three minutes")
EOF
then
    tail -n 20 "$home/log" >&2
    fail 1 "the viewer made no picture of $recording"
fi
[ -s "$picture" ] || fail 1 "the viewer made no picture of $recording"
echo "$picture"
