"""What can go wrong, and what a run warns of."""


class Error(Exception):
    """What the command line ends with an error for; its text is what it shows.

    what: what is wrong, in a sentence
    help: what would be right, or None
    file: the file that it is about, or None
    line: its line, from 1, or None
    exit_code: that of the command line
    """

    def __init__(self, text, *, what=None, help=None, file=None, line=None, exit_code=None):
        super().__init__(text)
        self.what = what
        self.help = help
        self.file = file
        self.line = line
        self.exit_code = exit_code


class InputError(Error, ValueError):
    """Input that cannot be used: an unknown name, a folder that is not empty, files that do not agree."""


class SceneError(InputError):
    """A scene, a study or an option that cannot be used: `file` and `line` say where."""


class FileError(Error, OSError):
    """The file system refused something."""


class MissingError(Error, RuntimeError):
    """The machine or this build of the package lacks something: a graphics adapter, a viewer, a feature."""


class SimulationError(Error, RuntimeError):
    """The simulation had to stop: results so far are kept."""


class RunWarning(UserWarning):
    """What must be known before a run is believed; the command line prints it as WARNING."""
