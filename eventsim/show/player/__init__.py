"""The player: a page that holds a scene and its log, and plays them without anything else."""
