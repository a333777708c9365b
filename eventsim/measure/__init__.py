"""NUMBERS FROM A LOG, never from an engine: what is measured, how sure it is, and what theory says beside it.

The story: `ensemble` says what kind of gas a scene is; `meter` takes rows in blocks, follows every flight (`flights`), and
keeps sums by time (`series`) and correlations (`correlation`) in constant memory; `results` turns them into quantities,
each with an error bar (`blocking`) and its theory (`theory`).

>>> from eventsim.measure import measure
>>> measure(run.log)["Z"].value
"""

from eventsim.measure.meter import Meter, measure
from eventsim.measure.results import Measures, Quantity

__all__ = ["Measures", "Meter", "Quantity", "measure"]
