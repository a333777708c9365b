"""Two disks on a torus: the collision rate against its closed form.

With total momentum zero the relative motion is a point in a torus with a round hole of radius d (the diameter), so the
mean free path is pi * area / perimeter = (V - pi d^2) / (2 d): the rate is 2 d |v_rel| / (V - pi d^2).
"""

import math

import numpy as np

import eventsim as es

SIDE = 2.288228082  # packing fraction 0.3 for d = 1
SPEED = 1.0  # of the relative motion; contacts do not change it
formula = 2 * SPEED / (SIDE**2 - math.pi)

rates = []
for t in np.arange(1, 9) / 10:
    direction = np.array([1 - t**2, 2 * t]) / (1 + t**2)  # a unit vector without sine or cosine
    half = SPEED / 2 * direction
    scene = es.Scene(
        disks=es.Disks(position=[[0.0, 0.0], [SIDE / 2, SIDE / 2]], velocity=[half, -half], radius=0.5),
        domain=es.Periodic((SIDE, SIDE)),
    )
    run = es.simulate(scene, until=3_000.0)
    rates.append(run.counters.pair_contacts / run.time)

mean, error = np.mean(rates), np.std(rates, ddof=1) / math.sqrt(len(rates))
print(f"closed form   {formula:.4f}")
print(f"measured      {mean:.4f} +- {error:.4f}")
print(f"within 3 standard errors: {abs(mean - formula) < 3 * error}")
