"""The table of contact laws: what each knows, and what it makes of an approach."""

import pytest

from eventsim.formulas.laws import LAWS, Elastic, Inelastic, TimeOfContact, law_of
from eventsim.scene.restitution import Restitution

EXAMPLES = {
    Elastic: Elastic(1.0, 1.0, None),
    Inelastic: Inelastic(0.5, 0.75, None),
    TimeOfContact: TimeOfContact(0.5, 0.75, 0.125),
}


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_a_law_has_an_example_here_and_words(law):
    assert type(EXAMPLES[law]) is law
    assert EXAMPLES[law].words(str) not in [other.words(str) for kind, other in EXAMPLES.items() if kind is not law]


def test_the_keys_of_a_scene_choose_the_law():
    assert law_of(None, None) == EXAMPLES[Elastic]
    assert law_of(None, 0.125) == EXAMPLES[Elastic]  # nothing is lost that a duration could keep
    assert law_of(Restitution(0.5, 0.75), None) == EXAMPLES[Inelastic]
    assert law_of(Restitution(0.5, 0.75), 0.125) == EXAMPLES[TimeOfContact]


@pytest.mark.parametrize("law", EXAMPLES.values(), ids=lambda law: type(law).__name__)
def test_only_a_duration_makes_a_contact_depend_on_the_one_before(law):
    soon, late = law.restitution(0.5, 0.0625, 4.0, 1.0), law.restitution(0.5, 4.0, 0.25, 1.0)
    assert (soon, late) == ((0.5, 0.5) if law.duration is None else (1.0, 0.5))


def test_the_loss_is_that_of_the_least_inelastic_contacts():
    assert [law.loss() for law in EXAMPLES.values()] == [0.0, 0.25, 0.25]
    assert [Inelastic(*shares, None).loss() for shares in ((1.0, 0.75), (0.75, 1.0), (1.0, 1.0))] == [0.25, 0.25, 0.0]


def test_disks_come_to_rest_where_energy_is_lost_at_every_bounce():
    assert [(law.loses_energy(), law.comes_to_rest(), law.series()) for law in EXAMPLES.values()] == [
        (False, False, 1.0),
        (True, True, 0.75),
        (True, False, 1.0),
    ]
