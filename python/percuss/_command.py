"""The command `percuss`, which the wheel brings along."""

from __future__ import annotations

import signal
import sys

from percuss import _percuss


def main() -> int:
    """Run the command with the words of this process.

    Returns
    -------
    int
        The exit code: 0, 1 or 2, as the command line's page says.
    """
    # Ctrl-C ends the command as it ends any other, in the middle of its work.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _percuss.command(["percuss", *sys.argv[1:]])
