"""The wheel brings the program, and its stub says what is there."""

import ast
import inspect
import pathlib
import signal
import subprocess
import sys
import time

import strandsnap

program, root = sys.argv[1], sys.argv[2]
scripts = pathlib.Path(sys.executable).parent
brought = str(scripts / "strandsnap")


def out(*words):
    return subprocess.run(words, capture_output=True, text=True)


for words in (["--version"], ["scene", "check", "strand.toml"], ["plan", "ka5"], ["scene", "keys"], ["nothing"]):
    one, other = out(program, *words), out(brought, *words)
    assert (one.returncode, one.stdout, one.stderr) == (other.returncode, other.stdout, other.stderr), words
module = out(sys.executable, "-m", "strandsnap", "--version")
assert module.stdout.split()[1] == strandsnap.__version__, module.stdout
assert out(brought, "run", "strand.toml", "--quiet", "--no-frames", "--no-recording", "--out", "by-wheel").returncode == 0
strandsnap.run(strandsnap.Scene("strand.toml"), "by-module")
files = [pathlib.Path(folder, "curve.csv").read_bytes() for folder in ("by-wheel", "by-module")]
assert files[0] == files[1]
# Ctrl-C ends it as it ends the program.
going = [brought, "run", "ka4", "--quiet", "--no-frames", "--no-recording", "--out", "pressed"]
with subprocess.Popen(going, stderr=subprocess.PIPE, text=True) as process:
    while not pathlib.Path("pressed/curve.csv.partial").exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    told = process.stderr.read()
assert process.returncode == 130 and "results so far are kept" in told and "Traceback" not in told, told
assert pathlib.Path("pressed/summary.json").is_file()
# Scripts of batch systems start the interpreter that has the package.
emitted = out(brought, "study", "pitch", "--set", "stop.steps=3", "--seeds", "1", "--emit", "gnu-parallel", "--out", "study")
assert emitted.returncode == 0, emitted.stderr
text = pathlib.Path("study/cluster/cases.sh").read_text()
assert "-m strandsnap" in text and sys.executable in text, text

package = pathlib.Path(strandsnap.__file__).parent
assert (package / "py.typed").is_file()
stub = ast.parse((package / "__init__.pyi").read_text())


def parameters(function):
    arguments = function.args
    names = [argument.arg for argument in arguments.posonlyargs + arguments.args + arguments.kwonlyargs]
    return names + [extra.arg for extra in (arguments.vararg, arguments.kwarg) if extra]


def check(function, there):
    told = list(inspect.signature(there).parameters)
    assert told == [name for name in parameters(function) if name != "self" or "self" in told], (function.name, told)
    assert there.__doc__, f"{function.name} has no docstring"


listed = set()
for node in stub.body:
    if isinstance(node, ast.FunctionDef):
        listed.add(node.name)
        check(node, getattr(strandsnap, node.name))
    elif isinstance(node, ast.ClassDef):
        listed.add(node.name)
        there = getattr(strandsnap, node.name)
        assert there.__doc__, node.name
        methods = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
        shown = {name for name in vars(there) if not name.startswith("_")}
        assert shown == {name for name in methods if not name.startswith("_")}, (node.name, shown ^ methods)
        for one in node.body:
            if isinstance(one, ast.FunctionDef) and one.name == "__new__":
                assert list(inspect.signature(there).parameters) == parameters(one)[1:], node.name
            elif isinstance(one, ast.FunctionDef) and not one.decorator_list and not one.name.startswith("__"):
                check(one, getattr(there, one.name))
for name in strandsnap.__all__:
    assert getattr(strandsnap, name) is not None
assert listed <= set(strandsnap.__all__), listed - set(strandsnap.__all__)
print(f"{len(listed)} names of the stub are there")
