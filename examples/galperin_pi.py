"""Digits of pi from counting contacts, and a check that is stronger than the count: the velocities."""

import math

import eventsim as es

print("mass ratio   contacts   light disk's speed at the end   rotation formula")
for k in range(4):
    ratio = 100**k
    run = es.simulate(es.gallery("galperin", mass_ratio=ratio))
    contacts = run.counters.events

    # In the plane of (sqrt M V, sqrt m v) each pair and wall contact together are a rotation by 2 theta.
    theta = math.atan(math.sqrt(1 / ratio))
    turns = (contacts + 1) // 2  # a pair contact comes first
    sign = -1 if contacts % 2 else 1  # an odd contact is a pair contact, without its wall contact yet
    formula = sign * math.sqrt(ratio) * math.sin(2 * turns * theta)

    error = abs(run.state.velocity[0, 0] - formula)
    print(f"{ratio:10d} {contacts:10d} {abs(run.state.velocity[0, 0]):24.9f}   error below 1e-9: {error < 1e-9}")
