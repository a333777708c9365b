"""The reference engine with the plain contact formula alone: what is lost where no doubtful pair is computed carefully."""

from __future__ import annotations

from eventsim.engines.reference.loop import ReferenceSession
from eventsim.engines.reference.predict import Predictor
from eventsim.formulas.contact import pair_delay


class PlainPredictor(Predictor):
    """Predicts contacts of disks by `pair_delay`, whose c and D cancel near contact and at a graze."""

    straight_delay = staticmethod(pair_delay)


class PlainSession(ReferenceSession):
    """The reference engine in the middle of a run, without careful contact times of pairs."""

    name = "plain"
    predictor = PlainPredictor
