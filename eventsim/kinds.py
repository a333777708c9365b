"""The kinds of figures, which can be told without a library to draw them."""

TITLES = {
    "trajectories": "the paths of the disks, contacts marked",
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
    "space-time": "a coordinate against time: disks in a corridor, the height of a ball that bounces",
}
"""Kind -> what it shows; its module in `show.figures` has the same name, with _ for -."""
