"""What the command line refuses raises with its text."""

import pathlib
import pickle
import subprocess
import sys

import strandsnap

program, root = sys.argv[1], pathlib.Path(sys.argv[2])


def told(*words):
    """Exit code and text of the command line."""
    ran = subprocess.run([program, *words], capture_output=True, text=True)
    return ran.returncode, ran.stderr


def raised(call):
    """What a call raises."""
    try:
        call()
    except strandsnap.Error as error:
        return error
    raise AssertionError("nothing was raised")


def compare(call, *words):
    error = raised(call)
    code, text = told(*words)
    assert (error.exit_code, f"{error}\n") == (code, text), f"{words}: {error}\nagainst\n{text}"
    return error


count = 0
quiet = ["--quiet", "--no-frames", "--no-recording", "--out", "never"]
for file in sorted((root / "tests/scenes/bad").glob("*.toml")):
    error = compare(lambda: strandsnap.run(strandsnap.Scene(file), "never"), "run", str(file), *quiet)
    lines = [number for number, line in enumerate(file.read_text().splitlines(), 1) if "<-- here" in line]
    if isinstance(error, strandsnap.SceneError) and lines:
        assert error.file == str(file) and error.line in lines, (file, error.line, lines)
    assert isinstance(error, ValueError) and error.what and error.what in " ".join(str(error).replace("│", " ").split()), error.what
    count += 1
assert count > 100, count

error = compare(lambda: strandsnap.Scene("ka5"), "plan", "ka5")
assert isinstance(error, strandsnap.InputError) and "ka4" in error.help
compare(lambda: strandsnap.Scene("ka4", {"contact.frictoin": 0.3}), "plan", "ka4", "--set", "contact.frictoin=0.3")
compare(lambda: strandsnap.Scene("ka4", contact__friction=[1, "a"]), "plan", "ka4", "--set", 'contact.friction=[1, "a"]')
compare(lambda: strandsnap.Scene("ka4", {"stop.nothing": None}), "plan", "ka4", "--set", "stop.nothing=")
compare(lambda: strandsnap.resume("missing"), "resume", "missing")
compare(lambda: strandsnap.Run("missing"), "export", "missing", "--format", "xyz")
compare(lambda: strandsnap.Study("pitsch"), "study", "pitsch", "--dry-run")
pathlib.Path("full").mkdir()
pathlib.Path("full/notes.txt").write_text("mine")
compare(lambda: strandsnap.run(strandsnap.Scene("strand.toml"), "full"), "run", "strand.toml", *quiet[:-1], "full")
pathlib.Path("study.toml").write_text('about = "x"\nbase = "ka4"\n[[axis]]\nkey = "strand.pitsch"\nvalues = [1]\n')
compare(lambda: strandsnap.Study("study.toml"), "study", "study.toml", "--dry-run")

# An exception that crosses processes, as between workers, keeps what it says.
copy = pickle.loads(pickle.dumps(error))
assert (str(copy), copy.help, copy.exit_code) == (str(error), error.help, error.exit_code)

for call, kind in [
    (lambda: strandsnap.Scene("ka4", quality="finest"), ValueError),
    (lambda: strandsnap.Scene("ka4", "stop.strain=1 %"), TypeError),
    (lambda: strandsnap.Scene("ka4", {"stop.strain": object()}), TypeError),
    (lambda: strandsnap.Study("pitch", seeds=[1, 1]), ValueError),
    (lambda: strandsnap.run(strandsnap.Scene("ka4"), "never", threads=0), ValueError),
    (lambda: strandsnap.calibrate(strandsnap.Scene("ka4"), -5), ValueError),
]:
    try:
        call()
    except kind:
        continue
    raise AssertionError("nothing was raised")
assert not pathlib.Path("never").exists()
print(f"{count} bad scenes")
