"""Who takes part in a comparison: engines under the names that tables and figures give them, with their options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from eventsim.engines import STEPPED
from eventsim.engines.options import words_of
from eventsim.engines.stepped import ChipmunkOptions, FixedStepOptions, FramesOptions, StepOptions
from eventsim.errors import EventsimError
from eventsim.scene.stage import Stage


@dataclass(frozen=True, slots=True)
class Competitor:
    """A stepped engine with options of its own, and what it is called."""

    label: str
    engine: str
    options: StepOptions

    def at(self, dt: float) -> StepOptions:
        """The options of a run with step dt."""
        return replace(self.options, dt=dt)


    @property
    def settings(self) -> str:
        """What the engine is told besides the step, in words."""
        told = [(name, getattr(self.options, name)) for name in words_of(type(self.options)) if name != "dt"]
        return ", ".join(f"{name} {'as usual' if value is None else value}" for name, value in told) or "nothing to set"


def _variants(engine: str) -> list[Competitor]:
    """An engine with its usual options, and with others that are worth a name."""
    options = STEPPED[engine].options()
    assert isinstance(options, StepOptions)
    others = [Competitor(label, name, told) for label, (name, told) in VARIANTS.items() if name == engine]
    return [Competitor(engine, engine, options), *others]


VARIANTS = {
    "frames-forget": ("frames", FramesOptions(memory="frame")),
    "stepped-located": ("stepped", FixedStepOptions(locate=True)),
    "pymunk-1": ("pymunk", ChipmunkOptions(iterations=1)),
    "pymunk-30": ("pymunk", ChipmunkOptions(iterations=30)),
}
"""label -> (engine, options)."""

COMPETITORS = {one.label: one for engine in STEPPED for one in _variants(engine)}
"""label -> competitor: all stepped engines, a new one too."""


def chosen_competitors(labels: Sequence[str]) -> list[Competitor]:
    """The competitors of these names, or of one, all of them for none; EventsimError for a name that there is not."""
    labels = (labels,) if isinstance(labels, str) else labels
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
