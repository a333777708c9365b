"""Whether a series of contacts goes on for ever: told by the linear map of its rounds.

Disks that meet in turn change their approach velocities u by u -> u - (1 + e) u_j A_j / A_jj at contact j, A = J M^-1 J^T, while
the normals stay.  A round is a product of such maps.  The series has no end where the largest eigenvalue of the round is real,
and u tends to an eigenvector along which all contacts approach.  Where it is complex, u turns until a contact does not come.
Next to the critical restitution the ratio of the rounds seems to have settled in both cases.

Source: S. McNamara, W. R. Young, Phys. Fluids A 4, 496 (1992), doi:10.1063/1.858323.
"""

from __future__ import annotations

import numpy as np

from eventsim.record.events import Floats, Rows
from eventsim.scene.stage import Stage

LONGEST_ROUND = 16
"""Contacts in a round that is looked for."""

APART = 2.0**-22
"""Two eigenvalues closer than this part of them may be one, or a complex pair: at a double one they are known to the root of a
last bit."""


def is_endless(rows: Rows, stage: Stage) -> bool | None:
    """Whether the series that rows of some disks end with has no end; None where it shows no rounds, or has no such map.

    False also where the digits of the map do not tell.
    """
    who = list(zip(rows["a"].tolist(), rows["b"].tolist(), rows["wall"].tolist(), strict=True))
    period = next((p for p in range(1, LONGEST_ROUND + 1) if 3 * p <= len(who) and who[-2 * p : -p] == who[-p:]), None)
    if period is None or stage.gravity is not None or stage.law.duration is not None or any(stage.law.grips):
        return None
    disks = sorted({i for a, b, _ in who[-period:] for i in (a, b) if i >= 0})
    weight = np.ones(len(disks)) if stage.mass is None else np.array([_inverse(float(stage.mass[i])) for i in disks])
    if not np.all(np.isfinite(weight)):
        return None
    contacts = list(dict.fromkeys(who[-period:]))
    found = _directions(rows, who, contacts, disks)
    if found is None:
        return None
    jacobian, velocities = found
    masses = (jacobian * np.repeat(weight, 2)) @ jacobian.T
    steps = []
    for contact in who[-period:]:
        j = contacts.index(contact)
        if not masses[j, j] > 0.0:
            return None
        step = np.eye(len(contacts))
        step[:, j] -= (1.0 + _restitution(contact, stage)) * masses[:, j] / masses[j, j]
        steps.append((j, step))
    return _tends_to_approach(steps, jacobian @ velocities)


def _tends_to_approach(steps: list[tuple[int, Floats]], approach: Floats) -> bool:
    """Whether velocities tend to an eigenvector of a round along which every contact of it approaches."""
    whole = np.eye(len(approach))
    for _, step in steps:
        whole = step @ whole
    values, vectors = np.linalg.eig(whole)
    order = np.argsort(-np.abs(values))
    first = values[order[0]]
    if not np.isreal(first) or not 0.0 < first.real < 1.0:
        return False
    if len(order) > 1 and abs(values[order[1]] - first) <= APART * abs(first):
        return False
    share = np.linalg.solve(vectors, approach.astype(complex))[order[0]]
    along = (share * vectors[:, order[0]]).real
    for j, step in steps:
        if not along[j] < 0.0:
            return False
        along = step @ along
    return True


def _directions(
    rows: Rows, who: list[tuple[int, int, int]], contacts: list[tuple[int, int, int]], disks: list[int]
) -> tuple[Floats, Floats] | None:
    """(J, v): the normals of contacts (contacts, 2 disks), from what they did to velocities, and the velocities at the end."""
    jacobian = np.zeros((len(contacts), 2 * len(disks)))
    latest: dict[int, tuple[float, float]] = {}
    for contact, row in zip(who, rows, strict=True):
        a, b, _ = contact
        after = {a: (float(row["vxa"]), float(row["vya"]))}
        if b >= 0:
            after[b] = (float(row["vxb"]), float(row["vyb"]))
        if contact in contacts and all(i in latest for i in after):
            normal = np.array([0.0, 0.0])
            for i, sign in ((a, 1.0), (b, -1.0)):
                if i >= 0 and after[i] != latest[i]:
                    normal = sign * (np.array(after[i]) - np.array(latest[i]))
                    break
            if not np.any(normal):
                return None
            normal /= np.hypot(*normal)
            j = contacts.index(contact)
            for i, sign in ((a, 1.0), (b, -1.0)):
                if i >= 0:
                    k = disks.index(i)
                    jacobian[j, 2 * k : 2 * k + 2] = sign * normal
        latest.update(after)
    if not np.all(np.any(jacobian != 0.0, axis=1)):
        return None
    return jacobian, np.array([v for i in disks for v in latest[i]])


def _restitution(contact: tuple[int, int, int], stage: Stage) -> float:
    """At low speeds."""
    a, b, wall = contact
    return stage.law.series(stage.usual(a, b) if b >= 0 else stage.law.of_wall(wall))


def _inverse(mass: float) -> float:
    return float("inf") if mass == 0.0 else 1.0 / mass
