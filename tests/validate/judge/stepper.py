"""A time-stepped engine in some thirty lines, as people write them: gravity first, then places, then who overlaps is turned."""

import numpy as np

import eventsim as es


def box_of(gravity=(0.0, -2.0), **keys):
    """Six unlike disks in a box, which lose energy."""
    position = [(0.7, 1.2), (1.2, 1.1), (0.3, 0.3), (1.7, 0.4), (1.0, 0.25), (1.7, 1.2)]
    velocity = [(0.3, 0.0), (-0.5, 0.2), (0.8, 1.0), (-1.0, 1.2), (-0.4, 0.3), (-0.9, -0.3)]
    disks = es.Disks(position, velocity, [0.1, 0.1, 0.08, 0.12, 0.1, 0.09], [1.0, 3.0, 0.5, 2.0, 1.0, 1.5])
    return es.Scene(disks, es.Box((2.0, 1.5)), gravity=gravity, restitution=0.9, until=1.5, name="box", **keys)


class Stepper:
    """Its numbers may be other than those of the scene; `halved`: the number of a pair contact that gets half its impulse."""

    def __init__(self, scene, restitution=0.9, gravity=None, swell=1.0, halved=None):
        self.radius, self.mass, self.size = swell * scene.disks.radius, scene.disks.mass, np.array(scene.domain.size)
        self.gravity = np.array(scene.gravity or (0.0, 0.0)) if gravity is None else np.array(gravity)
        self.restitution, self.halved, self.pairs, self.halved_at = restitution, halved, 0, None
        self.drag = 0.0

    def step(self, x, v, dt):
        """One step."""
        v = (1.0 - self.drag * dt) * v + self.gravity * dt
        x = x + v * dt
        for a in range(len(x)):
            out = ((x[a] < self.radius[a]) & (v[a] < 0.0)) | ((x[a] > self.size - self.radius[a]) & (v[a] > 0.0))
            v[a] = np.where(out, -self.restitution * v[a], v[a])
            for b in range(a):
                d = x[a] - x[b]
                distance = np.hypot(*d)
                speed = (v[a] - v[b]) @ d / distance
                if distance < self.radius[a] + self.radius[b] and speed < 0.0:
                    self.pairs += 1
                    share = 0.5 if self.pairs == self.halved else 1.0
                    self.halved_at = (b, a) if share < 1.0 else self.halved_at
                    impulse = -share * (1.0 + self.restitution) * speed / (1.0 / self.mass[a] + 1.0 / self.mass[b])
                    v[a] += impulse / self.mass[a] * d / distance
                    v[b] -= impulse / self.mass[b] * d / distance
        return x, v


def run(engine, scene, dt=0.001, every=5, velocity=None):
    """(times, positions, velocities) of every so many steps until the end of the scene."""
    x, v = scene.disks.position.copy(), np.array(scene.disks.velocity if velocity is None else velocity, dtype=float)
    states = [(0.0, x, v)]
    for k in range(1, round(scene.until / dt) + 1):
        x, v = engine.step(x, v, dt)
        if k % every == 0:
            states.append((k * dt, x, v))
    return tuple(np.array(column) for column in zip(*states, strict=True))
