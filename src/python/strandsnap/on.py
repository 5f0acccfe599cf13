"""Spreads the cases of a study over workers of Dask (package `distributed`).

    python -m strandsnap.on dask://HOST:PORT study.toml     # the workers of a scheduler
    python -m strandsnap.on local pitch --jobs 8            # processes of this machine

Workers need this package, and must see the folder of the study, and its file, under the same paths. Finished cases are
kept there, so that the same command goes on with the others. A case whose worker is lost goes to another one, which goes on
from its last checkpoint.
"""

import argparse
import os
import sys
import uuid

from . import Error, Study
from ._progress import Line


def _case(source, changes, number, out, device):
    return Study(source, **changes).run_case(number, out, device=device)


def spread(client, source, out=None, *, device="cpu", parquet=False, progress=None, **changes):
    """Runs the cases of a study that are missing on the workers of a `distributed.Client`, and gathers all.

    `source` and `changes` are those of `Study`; `progress` is called with the share that is done. What a case raised is
    raised when the others are over; with `collect` those can be gathered all the same.
    """
    from distributed import as_completed

    is_file = str(source).endswith(".toml") or os.sep in str(source)
    source = os.path.abspath(source) if is_file else str(source)
    study = Study(source, **changes)
    out = os.path.abspath(out or study.folder)
    os.makedirs(out, exist_ok=True)
    missing = study.missing(out, device=device)
    one = f"{study.name}-{uuid.uuid4().hex[:8]}"
    cases = [client.submit(_case, source, changes, n, out, device, key=f"{one}-{n}", pure=False) for n in missing]
    raised = None
    try:
        for done, case in enumerate(as_completed(cases), 1):
            raised = raised or case.exception()
            if progress:
                progress(done / len(cases))
    finally:
        client.cancel(cases)
    if raised:
        raise raised
    return study.collect(out, device=device, parquet=parquet)


def _seeds(text):
    if ".." in text:
        first, last = map(int, text.split(".."))
        return list(range(first, last + 1))
    return [int(seed) for seed in text.split(",") if seed.strip()] if "," in text else int(text)


def main(arguments=None):
    """The command line; gives the exit code."""
    parser = argparse.ArgumentParser(prog="python -m strandsnap.on", description=__doc__.splitlines()[0])
    parser.add_argument("workers", help="dask://HOST:PORT, or local for processes of this machine")
    parser.add_argument("study", help="a study that comes with the program, or the path of a TOML file")
    parser.add_argument("--out", metavar="DIR", help="folder of the study")
    parser.add_argument("--set", action="append", metavar="KEY=VALUE", help="change a key of every case's scene")
    parser.add_argument("--seeds", type=_seeds, help="how many, such as 8, or which, such as 1,2,3 or 4..9")
    parser.add_argument("--quality", choices=["draft", "standard", "fine"])
    parser.add_argument("--device", default="cpu", metavar="cpu|gpu|auto|NAME")
    parser.add_argument("--parquet", action="store_true", help="write the tables as Apache Parquet too")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes of this machine [default: one per core]")
    given = parser.parse_args(arguments)
    if given.workers != "local" and not given.workers.startswith("dask://"):
        parser.error(f"{given.workers} is neither local nor dask://HOST:PORT")
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        print("Dask's package `distributed` is missing: pip install distributed", file=sys.stderr)
        return 3
    changes = {"set": given.set, "seeds": given.seeds, "quality": given.quality}
    line = Line("study")
    how = {"device": given.device, "parquet": given.parquet, "progress": line}
    try:
        if given.workers == "local":
            jobs = given.jobs or os.cpu_count()
            address = LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
        else:
            address = given.workers.replace("dask", "tcp", 1)
        with Client(address) as client:
            results = spread(client, given.study, given.out, **how, **changes)
    except Error as error:
        print(error, file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("\nstopped; finished cases are kept, and the same command goes on with them.", file=sys.stderr)
        return 130
    finally:
        line.close()
    print(results.text)
    print("Written:", *results.files, sep="\n  ")
    return 0


if __name__ == "__main__":
    sys.exit(main())
