"""The table of contact laws: what each knows, and what it makes of an approach."""

from typing import NamedTuple

import pytest

from eventsim.formulas.laws import LAWS, Elastic, Inelastic, Law, TimeOfContact, law_of

EXAMPLES = {Elastic: Elastic(), Inelastic: Inelastic(0.5, 0.75), TimeOfContact: TimeOfContact(0.5, 0.75, 0.125)}


def missing(law):
    return {name for name in vars(Law) if not name.startswith("_") and not hasattr(law, name)}


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_a_law_knows_all_that_is_asked_of_one(law):
    assert missing(law) == set()
    assert type(EXAMPLES[law]) is law


def test_a_law_that_lacks_a_piece_is_found():
    class Dummy(NamedTuple):
        pair: float
        wall: float
        duration: float

        def series(self):
            return 1.0

    assert missing(Dummy) == {"comes_to_rest", "loses_energy", "remedy", "restitution", "words"}


def test_the_keys_of_a_scene_choose_the_law():
    assert law_of(None, None) == Elastic()
    assert law_of(None, 0.125) == Elastic()  # nothing is lost that a duration could keep
    assert law_of((0.5, 0.75), None) == EXAMPLES[Inelastic]
    assert law_of((0.5, 0.75), 0.125) == EXAMPLES[TimeOfContact]


@pytest.mark.parametrize("law", EXAMPLES.values(), ids=lambda law: type(law).__name__)
def test_only_a_duration_makes_a_contact_depend_on_the_one_before(law):
    soon, late = law.restitution(0.5, 0.0625, 4.0), law.restitution(0.5, 4.0, 0.25)
    assert (soon, late) == ((0.5, 0.5) if law.duration is None else (1.0, 0.5))


def test_disks_come_to_rest_where_energy_is_lost_at_every_bounce():
    assert [(law.loses_energy(), law.comes_to_rest(), law.series()) for law in EXAMPLES.values()] == [
        (False, False, 1.0),
        (True, True, 0.75),
        (True, False, 1.0),
    ]
