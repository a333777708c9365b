"""Who takes part in a comparison: engines under the names that tables and figures give them, with their options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from eventsim.engines import STEPPED
from eventsim.engines.stepped.options import (
    ChipmunkOptions,
    FixedStepOptions,
    FramesOptions,
    PenaltyOptions,
    StepOptions,
)
from eventsim.errors import EventsimError
from eventsim.scene.stage import Stage

PENALTY_LATE = 31.0
"""Steps: a spring reports the end of a contact, which lasts 20 steps, with a wall or an immovable disk 20 sqrt 2."""


@dataclass(frozen=True, slots=True)
class Entrant:
    """A stepped engine with options of its own: what it is called, and what that means in a few words.

    late: steps by which its rows may come after the contact.
    """

    label: str
    engine: str
    words: str
    options: StepOptions
    late: float = 2.0

    def at(self, dt: float) -> StepOptions:
        """The options of a run with step dt."""
        return replace(self.options, dt=dt)


ENTRANTS = {
    entrant.label: entrant
    for entrant in (
        Entrant("frames", "frames", "per frame; pairs leave its memory when apart", FramesOptions(memory="apart")),
        Entrant("frames-forget", "frames", "per frame; memory emptied each frame", FramesOptions(memory="frame")),
        Entrant("stepped", "stepped", "fixed step, overlaps resolved after it", FixedStepOptions()),
        Entrant("stepped-located", "stepped", "fixed step, impact located within it", FixedStepOptions(locate=True)),
        Entrant("penalty", "penalty", "springs, 20 steps a contact", PenaltyOptions(), late=PENALTY_LATE),
        Entrant("pymunk", "pymunk", "the Chipmunk engine", ChipmunkOptions()),
    )
}


def chosen_entrants(labels: Sequence[str]) -> list[Entrant]:
    """The entrants of these names, all of them for none; EventsimError for a name that there is not."""
    for label in labels:
        if label not in ENTRANTS:
            raise EventsimError(f"there is no engine {label!r} to compare with; there are {', '.join(ENTRANTS)}")
    return [ENTRANTS[label] for label in labels or ENTRANTS]


def able(entrants: Sequence[Entrant], stage: Stage) -> tuple[list[Entrant], list[str]]:
    """(those that can simulate a stage, a sentence on each of the others)."""
    ready: list[Entrant] = []
    sentences: list[str] = []
    for entrant in entrants:
        try:
            STEPPED[entrant.engine].open(stage, keep_rows=False, options=entrant.options)
        except EventsimError as error:
            sentence = f"{entrant.label} is left out: {error}"
            if not any(str(error) in other for other in sentences):
                sentences.append(sentence)
        else:
            ready.append(entrant)
    return ready, sentences
