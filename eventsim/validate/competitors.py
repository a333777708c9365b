"""Who takes part in a comparison: engines under the names that tables and figures give them, with their options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from eventsim.engines import STEPPED
from eventsim.engines.stepped import (
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
class Competitor:
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


COMPETITORS = {
    competitor.label: competitor
    for competitor in (
        Competitor("frames", "frames", "per frame; pairs leave its memory when apart", FramesOptions(memory="apart")),
        Competitor("frames-forget", "frames", "per frame; memory emptied each frame", FramesOptions(memory="frame")),
        Competitor("stepped", "stepped", "fixed step, overlaps resolved after it", FixedStepOptions()),
        Competitor("stepped-located", "stepped", "fixed step, impact located within it", FixedStepOptions(locate=True)),
        Competitor("penalty", "penalty", "springs, 20 steps a contact", PenaltyOptions(), late=PENALTY_LATE),
        Competitor("pymunk", "pymunk", "the Chipmunk engine", ChipmunkOptions()),
    )
}


def chosen_competitors(labels: Sequence[str]) -> list[Competitor]:
    """The competitors of these names, all of them for none; EventsimError for a name that there is not."""
    for label in labels:
        if label not in COMPETITORS:
            raise EventsimError(f"there is no engine {label!r} to compare with; there are {', '.join(COMPETITORS)}")
    return [COMPETITORS[label] for label in labels or COMPETITORS]


def able(competitors: Sequence[Competitor], stage: Stage) -> tuple[list[Competitor], list[str]]:
    """(those that can simulate a stage, a sentence on each of the others)."""
    ready: list[Competitor] = []
    sentences: list[str] = []
    for competitor in competitors:
        try:
            STEPPED[competitor.engine].open(stage, keep_rows=False, options=competitor.options)
        except EventsimError as error:
            sentence = f"{competitor.label} is left out: {error}"
            if not any(str(error) in other for other in sentences):
                sentences.append(sentence)
        else:
            ready.append(competitor)
    return ready, sentences
