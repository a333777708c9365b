"""Contact by contact, stuck disks, orders: on rows that were written by hand."""

import numpy as np
import pytest

from eventsim.record.events import Kind, blank_rows
from eventsim.validation.compare import fitted_order
from eventsim.validation.contacts import Census, _count, first_of_each, longest_stuck


def rows_of(*contacts):
    """Rows from (time, a, b) for pairs and (time, a, "wall") for walls."""
    rows = blank_rows(len(contacts))
    for row, (time, a, other) in zip(rows, contacts, strict=True):
        row["time"], row["a"] = time, a
        if other == "wall":
            row["kind"], row["wall"] = Kind.WALL, 0
        else:
            row["kind"], row["b"] = Kind.PAIR, other
        row["vxa"], row["vya"], row["vxb"], row["vyb"] = 1.0, 0.0, 0.0, 1.0
    return rows


def counted(ahead, rows, behind=(), late=()):
    total = Census()
    _count(total, rows_of(*ahead), rows_of(*rows), rows_of(*behind), rows_of(*late))
    return total.found, total.missed, total.doubled, total.spurious


def test_each_contact_is_found_missed_doubled_or_spurious():
    ahead = [(1.0, 0, 1), (1.1, 2, "wall"), (1.2, 3, 4)]
    assert counted(ahead, ahead) == (3, 0, 0, 0)
    assert counted(ahead, ahead[:2]) == (2, 1, 0, 0)
    assert counted(ahead, [*ahead, (1.15, 2, "wall")]) == (3, 0, 1, 0)
    assert counted(ahead, [*ahead, (1.3, 5, 6)]) == (3, 0, 0, 1)


def test_a_contact_may_be_reported_late_and_early_at_the_end_of_a_stretch():
    ahead = [(1.0, 0, 1)]
    assert counted(ahead, [], late=[(2.01, 0, 1)]) == (1, 0, 0, 0)
    assert counted(ahead, [(1.0, 0, 1), (1.99, 2, 3)], behind=[(2.01, 2, 3)]) == (1, 0, 0, 0)


def test_angles_compare_first_contacts_only():
    total = Census()
    exact, engine = rows_of((1.0, 0, 1), (1.5, 1, 2)), rows_of((1.0, 0, 1), (1.5, 1, 2))
    engine["vxa"], engine["vya"] = 0.0, 1.0  # a quarter turn of disk a, none of disk b
    _count(total, exact, engine, blank_rows(0), blank_rows(0))
    assert total.angle == pytest.approx(45.0)
    assert len(total.angles) == 2


def test_a_disk_is_stuck_while_rows_follow_step_by_step():
    rows = rows_of(*[(0.1 * k, 0, "wall") for k in range(5)], (0.9, 0, "wall"), (0.0, 1, "wall"), (0.1, 1, "wall"))
    assert longest_stuck(rows, 0.1) == pytest.approx(0.4)
    assert longest_stuck(rows[:0], 0.1) == 0.0


def test_an_order_is_fitted_between_rounding_and_saturation():
    steps = np.array([0.1, 0.01, 0.001, 0.0001])
    assert fitted_order(steps, 0.5 * steps**2) == pytest.approx(2.0, abs=0.01)
    assert np.isnan(fitted_order(steps, np.full(4, 2.0)))
    assert np.isnan(fitted_order(steps, np.full(4, 1e-15)))


def test_an_impulse_over_several_steps_is_one_contact():
    rows = rows_of((1.0, 0, 1), (1.1, 0, 1), (1.2, 0, 1), (1.2, 2, "wall"), (1.6, 0, 1))
    assert first_of_each(rows, 0.15)["time"].tolist() == [1.0, 1.2, 1.6]
    assert len(first_of_each(rows, 0.05)) == 5
