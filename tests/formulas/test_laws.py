"""The table of contact laws: what each knows, and what it makes of an approach."""

import math
from dataclasses import replace

import pytest

import eventsim as es
from eventsim.formulas.laws import LAWS, Elastic, Inelastic, Own, TimeOfContact, Yielding, law_of, wrong_share
from eventsim.record.events import State
from eventsim.replay.states import write_states
from eventsim.scene.contact_law import law_of_scene
from eventsim.scene.disks import named_species
from eventsim.scene.disks_file import read_disks_file, write_disks_file
from eventsim.scene.files import scene_from_dict
from eventsim.scene.own_law import own_law
from eventsim.scene.restitution import Restitution, as_restitution


def half(restitution):
    return restitution


EXAMPLES = {
    Elastic: Elastic(1.0, 1.0, None),
    Inelastic: Inelastic(0.5, 0.75, None),
    TimeOfContact: TimeOfContact(0.5, 0.75, 0.125),
    Yielding: Yielding(0.5, 0.75, None, 0.25),
    Own: Own(0.5, 0.75, None, own_law(half)),
}

KNOWN = {
    Elastic: (False, False, 0.75),
    Inelastic: (True, True, 0.75),
    TimeOfContact: (True, False, 1.0),
    Yielding: (True, True, 0.75),
    Own: (True, False, 1.0),
}
"""Whether they take energy, whether disks come to rest, and what comes back of slow contacts whose usual share is 0.75."""


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_a_law_has_an_example_here_and_words(law):
    assert type(EXAMPLES[law]) is law
    assert EXAMPLES[law].words(str) not in [other.words(str) for kind, other in EXAMPLES.items() if kind is not law]


def test_the_keys_of_a_scene_choose_the_law():
    assert law_of(None, None) == EXAMPLES[Elastic]
    assert law_of(None, 0.125) == EXAMPLES[Elastic]  # nothing is lost that a duration could keep
    assert law_of(Restitution(0.5, 0.75), None) == EXAMPLES[Inelastic]
    assert law_of(Restitution(0.5, 0.75), 0.125) == EXAMPLES[TimeOfContact]
    assert law_of(Restitution(0.5, 0.75, 0.25), None) == EXAMPLES[Yielding]


@pytest.mark.parametrize("law", EXAMPLES.values(), ids=lambda law: type(law).__name__)
def test_only_a_duration_makes_a_contact_depend_on_the_one_before(law):
    alone = law.restitution(0.5, math.inf, math.inf, 0.0, 1.0)
    soon, late = law.restitution(0.5, 0.0625, 4.0, 0.0, 1.0), law.restitution(0.5, 4.0, 0.25, 0.0, 1.0)
    assert (soon, late) == ((alone, alone) if law.duration is None else (1.0, alone))
    assert alone == 0.5 or type(law) not in KNOWN


def test_the_loss_is_that_of_the_least_inelastic_contacts():
    assert {kind: EXAMPLES[kind].loss() for kind in KNOWN} == {kind: 0.0 if kind is Elastic else 0.25 for kind in KNOWN}
    assert [Inelastic(*shares, None).loss() for shares in ((1.0, 0.75), (0.75, 1.0), (1.0, 1.0))] == [0.25, 0.25, 0.0]


def test_disks_come_to_rest_where_energy_is_lost_at_every_bounce():
    for kind, told in KNOWN.items():
        law = EXAMPLES[kind]
        assert (law.loses_energy(), law.comes_to_rest(), law.series(0.75)) == told


@pytest.mark.parametrize("law", EXAMPLES.values(), ids=lambda law: type(law).__name__)
def test_a_law_whose_slow_bounces_keep_their_height_brings_nothing_to_rest(law):
    assert law.comes_to_rest() is (law.series(0.75) < 1.0 and law.loss() > 0.0)


@pytest.mark.parametrize("law", [one for one in EXAMPLES.values() if one.by_speed], ids=lambda law: type(law).__name__)
def test_laws_by_speed_say_what_a_duration_does(law):
    assert "(TC model)" not in law.words(str)
    assert "a contact within 0.125 of a disk's previous one is elastic (TC model)" in replace(law, duration=0.125).words(str)


def test_above_the_speed_at_which_they_yield_less_comes_back():
    law = EXAMPLES[Yielding]
    assert [law.restitution(0.5, 1.0, 1.0, speed, 1.0) for speed in (0.0, 0.25, 4.0, 64.0)] == [0.5, 0.5, 0.25, 0.125]
    assert law.possible(0.5, 4.0) == (0.25,)
    assert Yielding(1.0, 1.0, None, 0.25).comes_to_rest() is False  # slow bounces keep their height
    assert Yielding(1.0, 1.0, None, 0.25).keeps_energy() is False


def test_a_speed_that_is_none_is_refused():
    with pytest.raises(es.SceneError, match=r"restitution.yield_speed = 0.0: must be a finite speed above 0"):
        es.Scene(es.Disks([[0, 0]], radius=1), es.Open(), restitution={"yield_speed": 0.0})
    assert as_restitution({"yield_speed": 2.0}) == Restitution(1.0, 1.0, 2.0)


def test_a_pair_that_is_faster_than_it_yields_parts_as_fast_as_johnson_says():
    disks = es.Disks([[0.0, 0.0], [2.0, 0.0]], [[4.0, 0.0], [0.0, 0.0]], 0.5)
    run = es.simulate(es.Scene(disks, es.Open(), restitution={"yield_speed": 0.25}), events=1, engine="reference")
    assert run.state.velocity.tolist() == [[1.0, 0.0], [3.0, 0.0]]  # e = (1/16)^(1/4) = 1/2
    assert run.residuals.energy is None
    assert run.residuals.momentum == 0.0


def test_a_cluster_under_a_law_of_speeds_stops_the_run_with_its_disks_and_the_law():
    disks = es.Disks([[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0]], [[1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]], 0.5)
    run = es.simulate(es.Scene(disks, es.Open(), restitution={"yield_speed": 0.25}), events=9, engine="reference")
    assert (run.stopped, run.counters.events) == ("law", 0)
    assert run.reason.startswith("disks 0, 1, 2 have contacts at one instant: restitution that falls with the speed says")


def test_a_corner_of_right_angles_is_two_contacts_under_any_law():
    disk = es.Disks([[3.0, 3.0]], [[-4.0, -4.0]], 0.5)
    run = es.simulate(es.Scene(disk, es.Box((6.0, 6.0)), restitution={"yield_speed": 0.25}), events=2, engine="reference")
    assert run.state.velocity.tolist() == [[2.0, 2.0]]


def test_stepped_engines_and_tangent_maps_refuse_a_law_that_they_do_not_know():
    disks = es.Disks([[0.0, 0.0], [2.0, 0.0]], [[4.0, 0.0], [0.0, 0.0]], 0.5)
    scene = es.Scene(disks, es.Open(), restitution={"yield_speed": 0.25})
    with pytest.raises(es.EventsimError, match="stepped cannot simulate this scene: it knows no restitution that falls"):
        es.simulate(scene, until=1.0, engine="stepped")
    trust = es.simulate(scene, until=1.0, engine="reference", trust=True).trust
    assert "no tangent map" in trust.reason


@pytest.mark.parametrize(
    ("keys", "beyond", "no_tangent"),
    [
        ({}, None, None),
        ({"tangential_restitution": 0.5}, "disks that spin", None),
        ({"walls": [es.Segment((5.0, 0.0), (5.0, 1.0), shaking=0.5)]}, "walls that heat, shake or slide", None),
        (
            {"walls": [es.Segment((5.0, 0.0), (5.0, 1.0), temperature=0.5)], "seed": 1},
            "walls that heat, shake or slide",
            "walls draw velocities by chance, whatever these were before",
        ),
        ({"walls": [es.Segment((5.0, 0.0), (5.0, 1.0), restitution=0.5)]}, "restitution of single walls or species", None),
    ],
)
def test_what_others_do_not_know_of_a_law_is_told(keys, beyond, no_tangent):
    law = law_of_scene(es.Scene(es.Disks([[0.0, 0.0]], radius=0.5), es.Open(), **keys))
    assert (law.beyond_steps, law.no_tangent) == (beyond, no_tangent)
    words = law.rough_words(str)
    assert words.startswith("; tangential restitution 0.5 between disks, 0.5 at walls") == (law.rough is not None)
    assert ("; walls heat, by chance, at kT = 0.5" in words) == law.heats


@pytest.mark.parametrize(
    ("share", "why"),
    [
        ("half", "is no number that a contact can have"),
        (math.nan, "is no number that a contact can have"),
        (math.inf, "is no number that a contact can have"),
        (-1.5, "is an impulse that pulls"),
        (-0.5, "leaves disks approaching"),
        (0.0, None),
        (2, None),
    ],
)
def test_what_a_law_of_ones_own_cannot_mean_is_told(share, why):
    assert wrong_share(share) == why


def test_a_wall_and_a_side_of_the_domain_have_shares_of_their_own():
    disks = es.Disks([[1.0, 1.0], [4.0, 3.0]], [[0.0, -1.0], [1.0, 0.0]], 0.5)
    floor = es.Segment((0.0, 0.25), (2.0, 0.25), restitution=0.25)
    scene = es.Scene(disks, es.Box((6.0, 6.0), walls={"right": {"restitution": 0.5}}), [floor], until=2.0)
    run = es.simulate(scene, engine="reference")
    assert run.state.velocity.tolist() == [[0.0, 0.25], [-0.5, 0.0]]
    assert es.Scene(disks, es.Box((6.0, 6.0)), [floor], restitution=0.25).walls[0].restitution == 0.25
    assert run.residuals.energy is None


def test_shares_of_walls_go_through_a_scene_file(tmp_path):
    disks = es.Disks([[1.0, 1.0]], [[0.0, -1.0]], 0.5)
    domain = es.Box((6.0, 6.0), walls={"top": {"restitution": 1.0}, "left": {"restitution": 0.1}})
    chain = es.Polyline([(3.0, 3.0), (4.0, 3.0), (4.0, 4.0)], restitution=0.3)
    scene = es.Scene(disks, domain, [chain], restitution=0.9, name="scene")
    for suffix in ("toml", "json"):
        scene.save(tmp_path / f"scene.{suffix}")
        assert es.load_scene(tmp_path / f"scene.{suffix}") == scene
    assert law_of_scene(scene).walls == (0.1, 0.9, 0.9, 1.0, 0.3, 0.3)


@pytest.mark.parametrize(
    ("walls", "message"),
    [
        ({"middle": {"restitution": 0.5}}, "domain.walls.middle: this domain has the walls left, right, bottom, top"),
        ({"left": {"bounce": 0.5}}, "domain.walls.left.bounce: unknown key"),
        ({"left": 0.5}, "domain.walls.left = 0.5: must be a table with restitution"),
        ({"left": {"restitution": "hard"}}, "wall.restitution = 'hard'"),
    ],
)
def test_what_no_side_has_is_refused(walls, message):
    with pytest.raises(es.SceneError) as refused:
        es.Box((1.0, 1.0), walls=walls)
    assert message in str(refused.value)


def test_a_share_of_a_side_keeps_its_bounds():
    with pytest.raises(es.SceneError, match=r"domain.walls.left.restitution = 1.5: must be from 0 to 1"):
        es.Scene(es.Disks([[1.0, 1.0]], radius=0.5), es.Box((2.0, 2.0), walls={"left": {"restitution": 1.5}}))


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_disk_comes_to_rest_on_the_wall_that_takes_energy_and_not_on_another(engine):
    if engine == "fast":
        pytest.importorskip("numba")
    disks = es.Disks([[1.0, 2.0], [5.0, 2.0]], radius=0.5)
    ledges = [es.Segment((0.5, 1.0), (1.5, 1.0)), es.Segment((4.5, 1.0), (5.5, 1.0), restitution=0.5)]
    run = es.simulate(es.Scene(disks, es.Box((6.0, 6.0)), ledges, (0.0, -1.0)), until=9.0, engine=engine)
    assert run.counters.rests == 1
    assert run.state.velocity[1].tolist() == [0.0, 0.0]
    assert run.state.position[1, 1] == pytest.approx(1.5, abs=1e-12)
    fallen = run.state.position[0, 1] - 1.5, run.state.velocity[0, 1]
    assert fallen[0] + 0.5 * fallen[1] ** 2 == pytest.approx(0.5, abs=1e-12)


def species_scene(**keys):
    position = [[1.0, 1.0], [3.0, 1.0], [1.0, 3.0], [3.0, 3.0], [1.0, 5.0], [3.0, 5.0]]
    velocity = [[1.0, 0.0], [0.0, 0.0]] * 3
    disks = es.Disks(position, velocity, 0.5, 1.0, ["a", "b", "a", "", "", ""])
    return es.Scene(disks, es.Open(), restitution={"pair": 0.5, "pairs": {"b-a": 0.25, "0-a": 0.0}}, name="species", **keys)


def test_two_species_have_a_share_of_their_own():
    run = es.simulate(species_scene(), until=2.0, engine="reference")
    relative = run.state.velocity[1::2, 0] - run.state.velocity[::2, 0]
    assert relative.tolist() == [0.25, 0.0, 0.5]


def test_species_go_through_scene_files_disks_files_and_logs(tmp_path):
    scene = species_scene(until=2.0)
    for suffix in ("toml", "json"):
        scene.save(tmp_path / f"scene.{suffix}")
        assert es.load_scene(tmp_path / f"scene.{suffix}") == scene
    es.simulate(scene, log=tmp_path / "log.npz", engine="reference")
    assert es.load_log(tmp_path / "log.npz").scene == scene
    for suffix in ("csv", "npz"):
        write_states(tmp_path / f"start.{suffix}", scene, [State(0.0, scene.disks.position, scene.disks.velocity)])
        assert read_disks_file(tmp_path / f"start.{suffix}").disks == scene.disks
    write_disks_file(tmp_path / "disks.npz", scene.disks)
    assert read_disks_file(tmp_path / "disks.npz").disks == scene.disks
    names, of = named_species(scene.disks)
    assert (names, of.tolist()) == (("a", "b", "0"), [0, 1, 0, 2, 2, 2])


def test_gases_have_a_species_and_so_have_disks_without_one(tmp_path):
    tables = {
        "domain": {"kind": "periodic", "size": [9.0, 9.0]},
        "restitution": {"pairs": {"dust-0": 0.5, "1-1": 0.75}},
        "gas": [
            {"count": 4, "radius": 0.25, "seed": 1, "species": "dust"},
            {"count": 2, "radius": 0.25, "seed": 2},
            {"count": 2, "radius": 0.5, "seed": 3},
        ],
    }
    scene = scene_from_dict(tables)
    assert named_species(scene.disks)[1].tolist() == [0] * 4 + [1] * 2 + [2] * 2
    assert law_of_scene(scene).pairs == ((1.0, 0.5, 1.0), (0.5, 1.0, 1.0), (1.0, 1.0, 0.75))


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ({"a-x": 0.5}, "restitution.pairs.a-x: no disk is of the species x (there are a, b)"),
        ({"a": 0.5}, "restitution.pairs.a: must be two species with a hyphen between"),
        ({"a-b": 1.5}, "restitution.pairs.a-b = 1.5: must be from 0 to 1"),
        ({"a-b": 0.5, "b-a": 0.5}, "restitution.pairs.b-a: these two species have a share already"),
    ],
)
def test_pairs_of_species_that_mean_nothing_are_refused(pairs, message):
    disks = es.Disks([[1.0, 1.0], [3.0, 1.0]], radius=0.5, species=["a", "b"])
    with pytest.raises(es.SceneError) as refused:
        es.Scene(disks, es.Open(), restitution={"pairs": pairs})
    assert message in str(refused.value)


@pytest.mark.parametrize("species", ["a-b", ["a"], ["a", 3.0, "b"], [1.0, 2.0, 3.0]])
def test_names_of_species_are_texts_without_hyphens_one_for_each_disk(species):
    with pytest.raises(es.SceneError, match=r"disks\.species"):
        es.Disks([[1.0, 1.0], [3.0, 1.0], [5.0, 1.0]], radius=0.5, species=species)
