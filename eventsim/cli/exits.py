"""The exit codes of the command line, the same for every verb."""

DONE = 0
FAILED = 1
BAD_INPUT = 2
STOPPED_EARLY = 3
INTERRUPTED = 130
