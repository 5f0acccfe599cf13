"""How far something is, on standard error."""

import sys

WIDTH = 24


class Line:
    """A line that is written over itself whenever the share done has changed by a per cent."""

    def __init__(self, name):
        self.name = name
        self.shown = None

    def __call__(self, share):
        percent = int(100 * share)
        if percent == self.shown:
            return
        self.shown = percent
        bar = "#" * (WIDTH * percent // 100)
        sys.stderr.write(f"\r{self.name} [{bar:{WIDTH}}] {percent:3d} %")
        sys.stderr.flush()

    def close(self):
        """Ends the line."""
        if self.shown is not None:
            sys.stderr.write("\n")
            sys.stderr.flush()
