"""NUMBERS FROM A LOG, never from an engine: what is measured, how sure it is, and what theory says beside it.

The story: `ensemble` says who is in a scene and what is conserved; `meter` hands rows in blocks to `sums`, which follow every
flight and keep sums by time, and samples to `correlation`, in constant memory; `records` tells what these mean;
`quantities` makes numbers of them, each with an error bar (`blocking`) and theory where it holds.

What is dearer, or needs the whole log, is one of the `studies`: made only where it is asked for.

>>> from eventsim.measure import measure, study
>>> measure(run.log)["Z"].value
>>> study(run.log, "lyapunov", 1)["lyapunov_1"].value
"""

from eventsim.measure.found import Found
from eventsim.measure.measures import Measure, Measures
from eventsim.measure.meter import Meter, measure, measure_file
from eventsim.measure.studies import study

__all__ = ["Found", "Measure", "Measures", "Meter", "measure", "measure_file", "study"]
