"""The program `strandsnap`."""

import signal
import sys

from . import _core, _mesa


def main():
    """Runs the command line on the arguments of this process, and gives its exit code."""
    # The program handles Ctrl-C itself; Python would raise it once more at the end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    _mesa.quiet()
    return _core.main([sys.executable, "-m", "strandsnap"], sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
