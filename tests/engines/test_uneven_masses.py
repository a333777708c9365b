"""A light disk between a wall and a heavy one keeps its digits through a thousand contacts, with and without loss."""

from decimal import Decimal, localcontext

import pytest

import eventsim as es

ENGINES = ["reference", "fast"]
RADIUS = 0.5


def between_wall_and_heavy(restitution, mass):
    """The wall is at x = 0; the light disk rests, the heavy one comes in."""
    disks = es.Disks([(1.0, 2.0), (3.0, 2.0)], [(0.0, 0.0), (-1.0, 0.0)], RADIUS, [1.0, mass])
    return es.Scene(disks, es.Box((64.0, 4.0)), restitution=es.Restitution(restitution, restitution))


def true_end(restitution, mass):
    """(contacts, v_light, v_heavy) once no contact follows, in 60 digits; gaps count from contact."""
    with localcontext() as context:
        context.prec = 60
        e, heavy = Decimal(restitution), Decimal(mass)
        x, y, u, v = Decimal("0.5"), Decimal("1.5"), Decimal(0), Decimal(-1)  # light and heavy, less what their radii take
        contacts = 0
        while True:
            to_wall = x / -u if u < 0 else None
            to_pair = (y - x) / (u - v) if u > v else None
            if to_wall is None and to_pair is None:
                return contacts, u, v
            if to_pair is None or (to_wall is not None and to_wall < to_pair):
                x, y, u = Decimal(0), y + v * to_wall, -e * u
            else:
                x = y = x + u * to_pair
                closing = (1 + e) * (u - v) / (1 + heavy)
                u, v = u - heavy * closing, v + closing
            contacts += 1


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("mass", "loss"), [(1e5, 1e-3), (1e6, 1e-6), (1e6, 1e-9)])
def test_a_light_disk_keeps_its_digits_where_contacts_take_a_little(engine, loss, mass):
    """pi sqrt(M/m) contacts; rounding each velocity anew would cost four digits of the small last one."""
    restitution = 1.0 - loss
    contacts, light, heavy = true_end(restitution, mass)
    run = es.simulate(between_wall_and_heavy(restitution, mass), until=20.0, engine=engine)
    assert run.counters.pair_contacts + run.counters.wall_contacts == contacts
    assert run.state.velocity[:, 0].tolist() == pytest.approx([float(light), float(heavy)], rel=1e-14, abs=0.0)
