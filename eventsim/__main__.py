"""The command ``eventsim``, also as ``python -m eventsim``."""

import os
import sys

INTERRUPTED = 130
"""As `cli.output` has it, which is not imported yet."""


def main() -> None:
    """Call the command line; an interrupt while it is still being imported ends as quietly as a later one."""
    _have_streams()
    try:
        from eventsim.cli import main as command

        command(prog_name="eventsim")
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
    finally:
        # After an interrupt inside an exec, in which modules make classes, Python would end by the signal in spite of the
        # exit code; the next exec makes it forget that.
        exec("")


def _have_streams() -> None:
    """Give the process the streams that its caller has closed: else the first file that is opened would take their place."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # it gets the lowest number that is free
            setattr(sys, name, os.fdopen(number, "r" if number == 0 else "w", closefd=False))


if __name__ == "__main__":
    main()
