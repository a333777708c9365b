"""The command ``eventsim``, also as ``python -m eventsim``."""

import sys

INTERRUPTED = 130
"""As `cli.exits` has it, which is not imported yet."""


def main() -> None:
    """Call the command line; an interrupt while it is still being imported ends as quietly as a later one."""
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


if __name__ == "__main__":
    main()
