import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, final

import numpy
import numpy.typing
from typing_extensions import Self, TypeAlias

from . import _core as _core
from ._errors import Error as Error
from ._errors import FileError as FileError
from ._errors import InputError as InputError
from ._errors import MissingError as MissingError
from ._errors import RunWarning as RunWarning
from ._errors import SceneError as SceneError
from ._errors import SimulationError as SimulationError
from ._frame import Frame as Frame

_Path: TypeAlias = str | os.PathLike[str]
_Table: TypeAlias = dict[str, numpy.typing.NDArray[Any]]
_Value: TypeAlias = str | bool | int | float | None | Sequence[Any] | Mapping[str, Any]
_Set: TypeAlias = Mapping[str, _Value] | Sequence[str] | None
_Progress: TypeAlias = bool | Callable[[float], object] | None
_Row: TypeAlias = dict[str, float | int | str | bool | None]

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

__version__: str
HAS_FRAMES: bool
"""Whether `Run.frame`, and frames and animations of runs, are in this build."""
HAS_RECORDING: bool
"""Whether Rerun recordings are in this build."""

@final
class Scene:
    """What is simulated: wires, how they are laid up, held and pulled, and when it ends."""
    def __new__(
        cls,
        source: _Path,
        set: _Set = None,
        *,
        quality: str | None = None,
        seed: int | None = None,
        memory: int | None = None,
        **keys: _Value,
    ) -> Self:
        """Reads a shipped scene by name, or a TOML file by path. `set` and keywords (`contact__friction=0.3`) change keys as
        `--set` does; `quality` is draft, standard or fine; `memory` is the most that its run may take (bytes)."""
    @staticmethod
    def from_text(
        text: str,
        set: _Set = None,
        *,
        name: str = "scene.toml",
        folder: _Path | None = None,
        quality: str | None = None,
        seed: int | None = None,
        memory: int | None = None,
        **keys: _Value,
    ) -> Scene:
        """Reads a scene from TOML text; centreline files are looked for in `folder`."""
    @property
    def name(self) -> str:
        """After which the folder of its run is called."""
    @property
    def about(self) -> str:
        """What it shows, in a sentence."""
    @property
    def toml(self) -> str:
        """The resolved scene."""
    @property
    def changed(self) -> list[str]:
        """What `quality` has changed, each as `key=value`."""
    @property
    def idle(self) -> list[str]:
        """Keys that it gives without effect, in words."""

@final
class Run:
    """The results of a run, from its folder. Tables are named as the columns of the CSV files."""
    def __new__(cls, folder: _Path, *, anyway: bool = False) -> Self:
        """Opens the run in a folder; with `anyway` also where files were changed since the run."""
    @property
    def folder(self) -> Path: ...
    @property
    def scene(self) -> Scene:
        """The scene that was run."""
    @property
    def summary(self) -> dict[str, Any]:
        """What the run found (`summary.json`); the names say the units."""
    @property
    def curve(self) -> _Table:
        """A row per sample: `strain_percent`, `stress_mpa`, `stress_LAYER_mpa`, forces (N), torque (N mm), energies (J)."""
    @property
    def wires(self) -> _Table:
        """A row per wire, from wire 1: layer, diameter (mm), greatest stress (MPa), strain then (%), first rupture."""
    @property
    def ruptures(self) -> _Table:
        """A row per broken bond, in their order: wire and bond from 1, strain (%), place (mm), cause, stress (MPa)."""
    @property
    def snapshots(self) -> _Table:
        """The rows of the curve at which every particle was kept."""
    def positions(self, strain: float | None = None, *, index: int | None = None) -> numpy.typing.NDArray[numpy.float32]:
        """Centres of all particles (m), shape (n, 3), at the snapshot nearest to a strain (%), or with this index, or the
        last."""
    def snapshot(self, strain: float | None = None, *, index: int | None = None) -> _Table:
        """All that was kept of every particle, chosen as by `positions`; units stand in the names."""
    def frame(
        self,
        strain: float | None = None,
        *,
        index: int | None = None,
        view: str | Sequence[str] | None = None,
        colour: str | None = None,
        theme: str | None = None,
        width: int | None = None,
        height: int | None = None,
        azimuth: float | None = None,
        elevation: float | None = None,
        zoom: float | None = None,
        focus_z: float | None = None,
    ) -> Frame:
        """A picture of a snapshot, chosen as by `positions`; sizes in pixels, angles in degrees, `focus_z` in mm. Raises
        `MissingError` where this build has no frames, or the machine no graphics driver."""

@final
class Study:
    """A scene that is varied: which cases there are, each a run that is kept in the study's folder."""
    def __new__(
        cls,
        source: _Path,
        set: _Set = None,
        *,
        quality: str | None = None,
        seeds: int | Sequence[int] | None = None,
        **keys: _Value,
    ) -> Self:
        """Reads a shipped study by name, or a TOML file by path; changes are those of every case's scene."""
    @staticmethod
    def from_text(
        text: str,
        set: _Set = None,
        *,
        name: str = "study.toml",
        folder: _Path | None = None,
        quality: str | None = None,
        seeds: int | Sequence[int] | None = None,
        **keys: _Value,
    ) -> Study:
        """Reads a study from TOML text; a base scene that is a path is taken from `folder`."""
    @property
    def name(self) -> str: ...
    @property
    def about(self) -> str:
        """What it asks, in a sentence."""
    @property
    def cases(self) -> list[str]:
        """The names of its cases; their numbers count from 1."""
    @property
    def folder(self) -> Path:
        """The folder of its results where none is given."""
    def missing(self, out: _Path | None = None, *, device: str = "cpu") -> list[int]:
        """The numbers of the cases that are not kept yet."""
    def run(
        self,
        out: _Path | None = None,
        *,
        jobs: int | None = None,
        device: str = "cpu",
        fresh: bool = False,
        parquet: bool = False,
        progress: _Progress = None,
    ) -> StudyResults:
        """Runs the cases that are missing, `jobs` at a time on one thread each, and gathers all."""
    def run_case(self, number: int, out: _Path | None = None, *, device: str = "cpu") -> str:
        """Runs one case, or finds it kept: "ran" or "failed"."""
    def collect(self, out: _Path | None = None, *, device: str = "cpu", parquet: bool = False) -> StudyResults:
        """Gathers the cases that are kept, and runs nothing."""
    def __len__(self) -> int: ...

@final
class StudyResults:
    """What a study found. Tables are named as the columns of its CSV files."""
    @property
    def folder(self) -> Path: ...
    @property
    def files(self) -> list[Path]:
        """The files that were written."""
    @property
    def text(self) -> str:
        """What the command line prints of it."""
    @property
    def missing(self) -> int:
        """How many cases were not run yet."""
    @property
    def cases(self) -> _Table:
        """A row per case; units stand in the names, as in "strength [MPa]"."""
    @property
    def points(self) -> _Table:
        """A row per point and quantity: mean, deviation and interval over seeds, in the `unit` of the row."""
    @property
    def breaks(self) -> _Table:
        """A row per point and layer: when and where it broke."""

@final
class Calibration:
    """What a calibration found."""
    @property
    def set(self) -> list[str]:
        """What reproduces the test: for `Scene(…, set=calibration.set)`."""
    @property
    def trials(self) -> _Table:
        """Setting by setting; the last one met the test."""
    @property
    def file(self) -> Path:
        """`calibration.json`."""

def run(
    scene: Scene,
    out: _Path | None = None,
    *,
    overwrite: bool = False,
    wait: bool = False,
    threads: int | None = None,
    device: str = "cpu",
    frames: bool = False,
    animation: _Path | None = None,
    animation_width: int | None = None,
    recording: bool = False,
    live: str | None = None,
    time_limit: float | None = None,
    progress: _Progress = None,
    on_row: Callable[[_Row], object] | None = None,
) -> Run:
    """Runs a scene and writes its results into `out`, or into out/NAME. Ctrl-C, an exception from a callback and `time_limit`
    (s) end it cleanly, and `resume` goes on."""

def resume(
    folder: _Path,
    *,
    threads: int | None = None,
    device: str | None = None,
    time_limit: float | None = None,
    progress: _Progress = None,
    on_row: Callable[[_Row], object] | None = None,
) -> Run:
    """Goes on with a run that was interrupted or killed, to the same bits."""

def calibrate(
    scene: Scene,
    strength: float | None = None,
    elongation: float | None = None,
    *,
    tolerance: float = 1.0,
    seeds: int | Sequence[int] | None = None,
    jobs: int | None = None,
    device: str = "cpu",
    out: _Path | None = None,
    fresh: bool = False,
    progress: _Progress = None,
) -> Calibration:
    """Fits hardening and rupture strain to a strength (MPa) and an elongation (%), each within `tolerance` (%)."""

def scenes() -> dict[str, str]:
    """The scenes that come with the program: name and TOML text."""

def studies() -> dict[str, str]:
    """The studies that come with the program: name and TOML text."""
