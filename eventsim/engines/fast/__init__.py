"""The fast engine: the reference engine's algorithm, compiled; the same log, bit for bit."""
