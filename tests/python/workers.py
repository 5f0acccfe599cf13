"""A study over three worker processes of Dask, one of which is killed: every case is there once, and the same."""

import csv
import os
import pathlib
import signal
import subprocess
import sys

import strandsnap
import strandsnap.on

STUDY = """
about = "A small strand, pulled."
base = "strand.toml"
set = ["output.samples=100"]
seeds = 8

[[axis]]
key = "contact.friction"
values = [0.1, 0.3]
"""


def rows(folder, name):
    with open(f"{folder}/{name}.csv", newline="") as file:
        return [{key: cell for key, cell in row.items() if not key.endswith("[s]")} for row in csv.DictReader(file)]


def main():
    from distributed import Client, LocalCluster

    pathlib.Path("strands.toml").write_text(STUDY)
    local = strandsnap.Study("strands.toml").run("local")
    killed = []
    with LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def kill(share):
            if share > 0.2 and not killed:
                busy = [info["pid"] for info in client.run(lambda dask_worker: {
                    "pid": os.getpid(), "busy": dask_worker.state.executing_count}).values() if info["busy"]]
                killed.extend(busy[:1])
                for process in killed:
                    os.kill(process, signal.SIGKILL)

        spread = strandsnap.on.spread(client, "strands.toml", "spread", progress=kill)
    assert killed, "no worker was killed"
    assert spread.missing == 0 and list(spread.cases["case"]) == list(range(1, 17))
    for name in ("cases", "points", "breaks"):
        assert rows("local", name) == rows("spread", name), name
    kept = [folder.name for folder in pathlib.Path("spread/cases").glob("*/*")]
    assert len(kept) == 16, kept
    # The command goes on with what is there.
    (first, *_) = pathlib.Path("spread/cases").glob("*/*")
    (first / "case.json").unlink()
    command = [sys.argv[1], "study", "strands.toml", "--out", "spread", "--on", "local", "--jobs", "1"]
    environment = {**os.environ, "STRANDSNAP_PYTHON": sys.executable}
    ran = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert ran.returncode == 0 and "cases.csv" in ran.stdout, ran.stdout + ran.stderr
    assert rows("local", "cases") == rows("spread", "cases")
    print(f"16 cases, process {killed[0]} killed")


# Workers begin as copies of this script.
if __name__ == "__main__":
    main()
