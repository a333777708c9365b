"""What a page is told of a scene besides its picture: its contacts in words, and what read-outs need of it as a gas."""

from __future__ import annotations

from typing import Any

from eventsim.measure.ensemble import LAST_DIGITS, ensemble_of
from eventsim.measure.records import FEW, FEWEST_CONTACTS, LINE, NEVER_MET, ON_A_LINE, TOO_FEW
from eventsim.scene import Scene
from eventsim.scene.contact_law import law_of_scene


def settings_of(scene: Scene) -> str | None:
    """What a scene has besides its disks and walls that changes its contacts, in words; None where it has nothing."""
    law = law_of_scene(scene)
    words = law.words("{:g}".format) + law.rough_words("{:g}".format)
    return None if law.keeps_energy() and law.rough is None else words


def gas_of(scene: Scene) -> dict[str, Any]:
    """What read-outs need to know of the scene as a gas; null where `measure` has a dash, with the reason.

    Of dashes that a run decides: the numbers that `measure` decides by, and its words.
    """
    ensemble = ensemble_of(scene)
    disks, kept = scene.disks, ensemble.kept_momenta
    return {
        "freedoms": ensemble.freedoms,
        "kept": [axis < kept for axis in range(2)],
        "mass": float(disks.mass[ensemble.counted].sum()),
        "middle": ensemble.middle,
        "area": ensemble.area,
        "noTemperature": ensemble.no_temperature,
        "noPressure": ensemble.no_pressure,
        "onALine": {"share": ON_A_LINE, "why": LINE, "never": NEVER_MET},
        "few": {"disks": FEW, "contacts": FEWEST_CONTACTS, "why": TOO_FEW},
        "lastDigits": LAST_DIGITS,
        "maxwell": ensemble.simple and ensemble.n >= FEW,
    }
