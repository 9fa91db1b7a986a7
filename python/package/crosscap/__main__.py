"""The command line: ``crosscap`` and ``python -m crosscap``."""

import signal
import sys

from ._crosscap import main as _main


def main():
    """Run the command line of this process and exit with its code."""
    # The interpreter only notes Ctrl-C, and would tell the command when it is done.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_main(["crosscap", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
