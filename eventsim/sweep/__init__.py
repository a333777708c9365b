"""MANY RUNS, ONE TABLE: a scene for all combinations of values, several times each, anywhere.

The story: `grid` lists the tasks, each with its own seed; `task` does one and gives a row; `spread` has them done by any
executor and keeps a journal; `table` writes the rows.

>>> from functools import partial
>>> import eventsim as es
>>> from eventsim.sweep import sweep
>>> sweep(partial(es.load_scene, "gas.toml"), {"gas.0.packing_fraction": [0.1, 0.2, 0.3]}, replicas=4, out="gas.csv")
"""

from eventsim.sweep.spread import sweep
from eventsim.sweep.table import load_table

__all__ = ["load_table", "sweep"]
