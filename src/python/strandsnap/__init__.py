"""Stranded wire under load: scenes are run until wires snap, and what they gave comes as numpy arrays.

>>> import strandsnap
>>> scene = strandsnap.Scene("single-wire", {"stop.strain": "2 %"}, seed=3)
>>> run = strandsnap.run(scene, "out/wire", overwrite=True)
>>> run.curve["stress_mpa"].max()           # columns are named as in curve.csv, units at the end
>>> run.positions(1.5)                      # centres of all particles (m) at a strain of 1.5 %
>>> strandsnap.Run("out/ka4").ruptures["wire"]

Errors have the text that the command line shows, with file, line and key. The program itself is `strandsnap`, or
`python -m strandsnap`; `python -m strandsnap.on` spreads a study over workers of Dask.
"""

from . import _core
from ._core import (
    HAS_FRAMES,
    HAS_RECORDING,
    Calibration,
    Run,
    Scene,
    Study,
    StudyResults,
    __version__,
    calibrate,
    resume,
    run,
    scenes,
    studies,
)
from ._errors import Error, FileError, InputError, MissingError, RunWarning, SceneError, SimulationError

__all__ = [
    "HAS_FRAMES",
    "HAS_RECORDING",
    "Calibration",
    "Error",
    "FileError",
    "Frame",
    "InputError",
    "MissingError",
    "Run",
    "RunWarning",
    "Scene",
    "SceneError",
    "SimulationError",
    "Study",
    "StudyResults",
    "calibrate",
    "resume",
    "run",
    "scenes",
    "studies",
]

_core.built_in(_core.__file__)


def __getattr__(name):
    # Not before it is asked for: the command line needs no numpy.
    if name == "Frame":
        from ._frame import Frame

        return Frame
    raise AttributeError(f"module 'strandsnap' has no attribute {name!r}")
