"""Reverse every velocity: the gas goes back to its start, as far as the digits carry."""

import numpy as np

import eventsim as es

scene = es.gallery("gas", n=16, seed=3)

print("events out   events back   distance from the start")
for events in (20, 50, 100):
    sim = es.Simulation(scene)
    while len(sim.log) < events:
        sim.step()
    turn = sim.time
    sim.advance_to(turn * (1 + 1e-9))  # a little later than the last contact
    half = sim.time
    for disk, velocity in enumerate(sim.state.velocity):
        sim.set_velocity(disk, -velocity)
    out = len(sim.log)
    sim.advance_to(2 * half)
    error = np.max(np.abs(sim.state.position - scene.disks.position))
    back = len(sim.log) - out
    print(f"{events:10d}   {back:11d}   below 1e{int(np.ceil(np.log10(error))):+d}")
