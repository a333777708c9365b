"""NUMBERS FROM A LOG, never from an engine: what is measured, how sure it is, and what theory says beside it.

The story: `ensemble` says who is in a scene and what is conserved; `meter` hands rows in blocks to `sums`, which follow every
flight and keep sums by time, and samples to `correlation`, in constant memory; `records` tells what these mean;
`quantities` makes numbers of them, each with an error bar (`blocking`) and theory where it holds.

>>> from eventsim.measure import measure
>>> measure(run.log)["Z"].value
"""

from eventsim.measure.measures import Measure, Measures
from eventsim.measure.meter import Meter, measure, measure_file

__all__ = ["Measure", "Measures", "Meter", "measure", "measure_file"]
