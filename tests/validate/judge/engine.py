"""An engine in some thirty lines, as people write them, with one fault planted at a time."""

import math

import numpy as np

import eventsim as es

FAULTS = ("none", "missed", "double impulse", "leak", "drift", "masses", "restitution")


def scene_of(n=7, seed=3):
    """Disks of three masses in a box, far from each other at the start."""
    rng = np.random.default_rng(seed)
    sites = np.array([(x, y) for x in (0.5, 1.5, 2.5) for y in (0.5, 1.5, 2.5)])[:n]
    velocity = rng.normal(size=(n, 2))
    mass = np.array([1.0, 2.0, 3.0])[np.arange(n) % 3]
    disks = es.Disks(sites + rng.uniform(-0.1, 0.1, (n, 2)), velocity, 0.2, mass)
    return es.Scene(disks, es.Box((3.0, 3.0)), until=4.0, name="planted")


def motion(scene, fault="none", at=5, frame=0.01, until=4.0):
    """Times, positions, velocities, contacts of an event-driven run; `fault` happens at contact number `at`, or from there on."""
    x, v = scene.disks.position.copy(), scene.disks.velocity.copy()
    r, m = scene.disks.radius, scene.disks.mass.copy()
    size, n, now, skip, count = scene.domain.size, len(scene.disks), 0.0, set(), 0
    times, places, speeds, contacts = [0.0], [x.copy()], [v.copy()], []
    while True:
        best = (math.inf, None)
        for a in range(n):
            for axis in (0, 1):
                for side, wall in ((0, ("left", "bottom")[axis]), (1, ("right", "top")[axis])):
                    gap = x[a, axis] - r[a] if side == 0 else size[axis] - r[a] - x[a, axis]
                    speed = -v[a, axis] if side == 0 else v[a, axis]
                    if speed > 0 and (a, wall) not in skip:
                        best = min(best, (max(gap / speed, 0.0), (a, -1, wall)), key=lambda one: one[0])
            for b in range(a + 1, n):
                d, u = x[b] - x[a], v[b] - v[a]
                du, uu = d @ u, u @ u
                root = du * du - uu * (d @ d - (r[a] + r[b]) ** 2)
                if du < 0 and root > 0 and (a, b) not in skip:
                    best = min(best, (max((-du - math.sqrt(root)) / uu, 0.0), (a, b, "")), key=lambda one: one[0])
        delay, who = best
        while times[-1] + frame <= now + delay and times[-1] + frame < until + 0.5 * frame:
            times.append(len(times) * frame)
            x, delay, now = x + v * (times[-1] - now), delay - (times[-1] - now), times[-1]
            v = v * (1.0 + 2e-5) if fault == "drift" else v
            places.append(x.copy())
            speeds.append(v.copy())
        if now + delay > until:
            return np.array(times), np.array(places), np.array(speeds), contacts
        x, now = x + v * delay, now + delay
        a, b, wall = who
        here = count >= at
        if (fault == "missed" and b >= 0 and here and not skip) or (fault == "leak" and b < 0 and here and not skip):
            skip.add((a, b) if b >= 0 else (a, wall))
            continue
        count += 1
        contacts.append((now, a, b, wall))
        e = 0.8 if fault == "restitution" and here else 1.0
        if b < 0:
            v[a, 0 if wall in ("left", "right") else 1] *= -e
            continue
        ma, mb = (m[a], m[b]) if not (fault == "masses" and here) else (1.5 * m[a], m[b])
        normal = (x[b] - x[a]) / np.linalg.norm(x[b] - x[a])
        strength = (1 + e) * ((v[a] - v[b]) @ normal) / (1 / ma + 1 / mb)
        if fault == "double impulse" and here and not skip:
            strength, skip = 2 * strength, {"once"}
        v[a] -= strength / ma * normal
        v[b] += strength / mb * normal
