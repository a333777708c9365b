"""A gas on a line has a closed solution: how far is the engine from it after ten thousand events?"""

import numpy as np

import eventsim as es

scene = es.gallery("corridor", n=50)
run = es.simulate(scene)

radius = scene.disks.radius[0]
cut = radius * (2 * np.arange(len(scene.disks)) + 1)  # the diameters to the left of each centre
free = scene.domain.size[0] - 2 * radius * len(scene.disks)

# Without their diameters the disks are points that pass through each other, and the walls are mirrors.
path = scene.disks.position[:, 0] - cut + scene.disks.velocity[:, 0] * run.time
folded = path % (2 * free)
points = np.sort(np.minimum(folded, 2 * free - folded))
error = np.max(np.abs(run.state.position[:, 0] - (points + cut)))

print(f"{len(scene.disks)} disks, {run.counters.events} events")
print(f"largest error of a position is below 1e-9: {error < 1e-9}")
print(f"largest change of a height: {np.ptp(run.state.position[:, 1]):g}")
