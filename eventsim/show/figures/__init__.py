"""Figures: one module a kind, each with `draw(figure, log)`; every number is worked out from the log.

`kinds.TITLES` is the table of kinds: command line and help read it, and `write.write_figure` draws one of them to a file.
"""
