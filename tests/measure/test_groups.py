"""Groups: who has met whom, however rows are cut."""

import numpy as np

from eventsim.measure.groups import Groups


def test_chains_of_contacts_join_groups_however_they_are_cut():
    rng = np.random.default_rng(3)
    a, b = rng.integers(0, 60, size=(2, 45))
    members = np.arange(60) % 7 != 0
    whole, parts = Groups(members), Groups(members)
    whole.add(a, b)
    for k in range(45):
        parts.add(a[k : k + 1], b[k : k + 1])
    label = {k: {k} for k in np.flatnonzero(members).tolist()}
    for i, j in zip(a.tolist(), b.tolist(), strict=True):
        if members[i] and members[j] and label[i] is not label[j]:
            label[i] |= label[j]
            for k in label[j]:
                label[k] = label[i]
    assert whole.count == parts.count == len({id(group) for group in label.values()}) < 51


def test_one_that_meets_nobody_is_a_group_of_its_own():
    groups = Groups(np.ones(4, dtype=bool))
    groups.add(np.array([0, 2]), np.array([1, 1]))
    assert groups.count == 2
