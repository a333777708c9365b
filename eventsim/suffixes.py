"""What the names of files end in, by what is in them; no other module lists them."""

SCENES = (".toml", ".json")
LOGS = (".csv", ".jsonl", ".npz", ".parquet")
PART = ".part"
"""After the name of a file that grows, or is not whole yet."""

DUMPS = (".dump", ".lammpstrj")
LAMMPS_DATA = (".data", ".lmp")
EXCHANGE = (".xyz", ".gsd", *DUMPS)
"""States for other programs."""

STATES = (".csv", ".npz", *EXCHANGE)
TABLES = (".csv", ".parquet")
READ_TABLES = (".csv", ".npz", ".parquet")
"""Columns that another program wrote."""

TRAJECTORIES = (*READ_TABLES, *EXCHANGE)
"""Positions at times that another program wrote."""

STARTS = (".csv", ".npz", *EXCHANGE, *LAMMPS_DATA)
"""Disks at one time: what a disks_file may be."""

FIGURES = (".png", ".svg", ".pdf")
ANIMATIONS = (".mp4", ".gif", ".html", ".png")
