"""An engine of one's own in thirty lines, and what it is worth: judged contact by contact, at two steps."""

from pathlib import Path

import numpy as np

import eventsim as es

scene = es.load_scene(Path(__file__).with_name("six.toml"))
radius, size = scene.disks.radius, np.array(scene.domain.size)


def step(position, velocity, dt):
    """Fly; turn round at walls; let disks that overlap and approach exchange their velocities along the line of centres."""
    position = position + velocity * dt
    for side in (-1.0, 1.0):
        wall = radius[:, None] if side < 0 else size - radius[:, None]
        out = ((position - wall) * side > 0.0) & (velocity * side > 0.0)
        velocity = np.where(out, -velocity, velocity)
    for a in range(len(position)):
        for b in range(a):
            apart = position[a] - position[b]
            distance = np.hypot(*apart)
            normal = apart / distance
            approach = (velocity[a] - velocity[b]) @ normal
            if distance < radius[a] + radius[b] and approach < 0.0:
                velocity[a] -= approach * normal
                velocity[b] += approach * normal
    return position, velocity


for dt in (0.1, 0.001):
    judged = es.validate(scene, step=step, dt=dt)
    contacts = judged.judgement.charge
    print(f"dt = {dt}: {contacts.found} contacts found, {contacts.missed} missed")
    print(f"  {judged.verdict[0]}")
    print(f"  positions are lost (0.1 diameters) at t = {judged.judgement.lost:.2g}")
