"""Two points start 1e-9 apart; each contact with a round post multiplies their distance."""

import numpy as np

import eventsim as es

separation = 1e-9
scene = es.gallery("sinai", n=2, separation=separation)
run = es.simulate(scene, until=20.0, log=True)

first, second = (run.log.time[(run.log.a == disk) | (run.log.b == disk)] for disk in (1, 2))
print("contacts   time      distance of the points")
for contact in range(min(len(first), len(second)) - 1):
    middle = 0.5 * (first[contact] + first[contact + 1])
    state = run.state_at(middle)
    apart = state.position[1] - state.position[2]
    apart -= np.round(apart)  # on the unit torus: the nearest image
    distance = float(np.hypot(*apart))
    print(f"{contact + 1:8d}   {middle:6.3f}   {distance:.1e}")
    if distance > 1e-2:
        break
