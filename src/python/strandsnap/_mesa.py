"""Mesa's Vulkan driver."""

import os
import tempfile


def quiet():
    """Gives it a session folder: it complains where there is none, which no off-screen picture needs."""
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
