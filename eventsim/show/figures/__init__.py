"""Figures: one module a kind, each with `draw(figure, log)`; every number is worked out from the log.

`TITLES` is the table of kinds: command line and help read it, and `write.write_figure` draws one of them to a file.
"""

TITLES = {
    "trajectories": "the ways of the disks, contacts marked",
    "raster": "which disk had an event when, and how many there were",
    "speeds": "speed histogram, with Maxwell's curve",
    "msd": "mean squared displacement against time",
    "vacf": "velocity autocorrelation, with the tail 1 / t of two dimensions",
    "free-paths": "distances between contacts, with kinetic theory",
    "series": "energy, temperature, pressure, collision rate along the run",
    "profile": "density and temperature in slices along gravity, or along x",
    "residuals": "energy and overlaps over time: how good the run is",
    "structure": "g(r) and S(k) along the run (needs freud)",
    "boundary": "boundary map of a billiard: arc length and sine of the angle of each contact",
    "space-time": "positions against time, for disks in a corridor",
}
"""Kind -> what it shows; its module has the same name, with _ for -."""
