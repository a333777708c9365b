"""Errors over the seeds of a scene: one start may be lucky, and a chart that shows one says nothing of the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from statistics import median

from eventsim.validation.competitors import Competitor
from eventsim.validation.precision import Curves, Task, Tell, curves


def curves_over_seeds(
    task: Task, competitors: Sequence[Competitor], patience_s: float, tell: Tell = lambda _: None, keeps: bool = False
) -> Curves:
    """The curves of a task; errors are medians over its scene and the others, with the least and the most.

    Interrupted, it raises KeyboardInterrupt, or `keeps` what it has reached.
    """
    result = curves(task, competitors, patience_s, tell, keeps=keeps)
    errors = {(point.label, point.value): [point.error] for point in result.points}
    for scene in () if result.interrupted else task.others:
        try:
            again = curves(replace(task, scene=scene, others=()), competitors, patience_s, tell, timed=False)
        except KeyboardInterrupt:
            if not keeps:
                raise
            result.interrupted = True
            break
        for label in result.labels:
            # steps are told in radii flown: the coarsest is the same one for each seed, and so on
            for point, other in zip(result.of(label), again.of(label), strict=False):
                errors[label, point.value].append(other.error)
    for point in result.points:
        found = errors[point.label, point.value]
        point.error, point.error_least, point.error_most = median(found), min(found), max(found)
    return result
