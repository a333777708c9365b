"""pymunk, by hand: what it does with six disks, sampled at 60 Hz, judged from its positions alone."""

from pathlib import Path

import numpy as np
import pymunk

import eventsim as es

scene = es.load_scene(Path(__file__).with_name("six.toml"))
disks, (width, height) = scene.disks, scene.domain.size

space = pymunk.Space()
space.collision_slop = 0.003  # its own 0.1 would be a third of a radius
bodies = []
for position, velocity, radius in zip(disks.position.tolist(), disks.velocity.tolist(), disks.radius.tolist(), strict=True):
    body = pymunk.Body(mass=1.0, moment=float("inf"))
    body.position, body.velocity = tuple(position), tuple(velocity)
    circle = pymunk.Circle(body, radius)
    circle.elasticity = 1.0
    space.add(body, circle)
    bodies.append(body)
corners = [(-1, -1), (width + 1, -1), (width + 1, height + 1), (-1, height + 1)]
for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
    wall = pymunk.Segment(space.static_body, start, end, 1.0)  # thick, so that nothing gets through
    wall.elasticity = 1.0
    space.add(wall)

for substeps in (1, 32):
    for body, position, velocity in zip(bodies, disks.position.tolist(), disks.velocity.tolist(), strict=True):
        body.position, body.velocity = tuple(position), tuple(velocity)
    times, places = [0.0], [disks.position]
    for frame in range(1, 361):
        for _ in range(substeps):
            space.step(1.0 / 60.0 / substeps)
        times.append(frame / 60.0)
        places.append(np.array([body.position for body in bodies]))
    judged = es.validate(scene, trajectory=(times, places))
    contacts = judged.judgement.charge
    print(f"{substeps} steps a frame: finds {contacts.found} of {contacts.ahead} contacts that could be charged")
    print(f"  {judged.verdict[0]}")
    print(f"  positions are lost (0.1 diameters) at t = {judged.judgement.lost:.2g}")
