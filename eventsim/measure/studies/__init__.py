"""Studies: what is measured only where it is asked for, each an option of `eventsim measure`.

To add one is its file and one line in `STUDIES`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from eventsim.errors import EventsimError
from eventsim.measure.found import Found
from eventsim.measure.studies import boundary, escape, lyapunov, recurrence, structure, transport
from eventsim.record.events import Rows
from eventsim.replay.log import AnyLog


class Sink(Protocol):
    """A study under way."""

    def write(self, rows: Rows) -> None:
        """Take a block of full rows, the next of the run."""

    def found(self, duration: float) -> Found:
        """Return what was found in the run, which lasted `duration` (time since the start)."""


class Study(NamedTuple):
    """A study.

    Attributes:
        name: of its option.
        values: what follows the option, (name, type); none: it is a flag.
        words: what it measures, for help.
        of: makes it, of (log, discard, *values); discard: time at the beginning that is left out, None: it is not said.
        sink: begins it, of (scene, discard, *values), where it needs no log but each row once.
    """

    name: str
    values: tuple[tuple[str, type], ...]
    words: str
    of: Callable[..., Found]
    sink: Callable[..., Sink] | None = None


STUDIES = (
    Study("structure", (), "g(r), S(k), psi_6 and coordination along the run, in periodic domains (by freud)", structure.found),
    Study("transport", (), "viscosity, heat conductivity, self-diffusion against lag", transport.found, transport.Transport),
    Study("lyapunov", (("K", int),), "the K largest Lyapunov exponents, per time and per contact of a disk", lyapunov.found),
    Study("boundary", (), "the boundary map of a billiard: arc length and sine of the angle of each contact", boundary.found),
    Study(
        "escape",
        tuple((name, float) for name in ("X0", "Y0", "X1", "Y1")),
        "escapes through a segment: rate, survivors",
        escape.found,
    ),
    Study("recurrence", (), "recurrence times of a billiard: how long until a contact comes back", recurrence.found),
)
"""The table of studies."""


def study(log: AnyLog, name: str, *values: float, discard: float | None = None) -> Found:
    """Make a study of the run that a log tells.

    Args:
        log: full or compact.
        name: of the table, such as "lyapunov".
        values: what the study asks for.
        discard: time at the beginning that is left out; None: each study's own share.

    Raises:
        EventsimError: for another name, other values, or a log that does not tell what the study needs.
    """
    chosen = next((one for one in STUDIES if one.name == name), None)
    if chosen is None:
        raise EventsimError(f"there is no study {name!r}; there are {', '.join(one.name for one in STUDIES)}")
    if len(values) != len(chosen.values):
        raise EventsimError(
            f"the study {name} asks for {', '.join(key for key, _ in chosen.values) or 'no values'}, not {list(values)}"
        )
    return chosen.of(log, discard, *values)
