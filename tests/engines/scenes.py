"""Scenes that several tests of engines use."""

import math
from dataclasses import replace

import numpy as np

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.reference import ReferenceOptions
from eventsim.engines.reference.loop import ReferenceSession
from eventsim.record.events import Rows
from eventsim.scene.stage import stage_of


def lattice_gas(n, eta, domain=es.Box, seed=1, quantum=None, radii=(0.5,), masses=(1.0,), **scene):
    """n disks on a square lattice with normal velocities, or velocities that are multiples of a quantum (many ties)."""
    rng = np.random.default_rng(seed)
    radius = np.resize(np.array(radii), n)
    area = math.pi * float(np.sum(radius**2)) / eta
    columns = math.ceil(math.sqrt(n))
    side = max(math.sqrt(area), 2.0 * float(radius.max()) * columns * 1.0001)
    pitch = side / columns
    sites = np.array([(i, j) for i in range(columns) for j in range(columns)][:n])
    velocity = rng.normal(size=(n, 2))
    if quantum is not None:
        velocity = np.round(velocity / quantum) * quantum
    return es.Scene(
        disks=es.Disks((sites + 0.5) * pitch, velocity, radius, np.resize(np.array(masses), n)),
        domain=es.Open() if domain is es.Open else domain((side, side)),
        **scene,
    )


def in_far_corner(scene, size, corner=(1, 1)):
    """The disks of a box in a corner of a very wide one, 0: at its low end, 1: at its high end, held there by walls."""
    width, height = scene.domain.size
    x, y = (size - width if corner[0] else 0.0), (size - height if corner[1] else 0.0)
    end_x, end_y = (size if corner[0] else 0.0), (size if corner[1] else 0.0)
    wall_x, wall_y = (x if corner[0] else width), (y if corner[1] else height)
    return replace(
        scene,
        disks=replace(scene.disks, position=np.add(scene.disks.position, (x, y))),
        domain=es.Box((size, size)),
        walls=(es.Polyline([(wall_x, end_y), (wall_x, wall_y), (end_x, wall_y)]),),
    )


def session_of(scene, **options):
    return ReferenceSession(stage_of(scene), options=ReferenceOptions(**options))


def rows_of(scene, events=None, until=None, **options) -> Rows:
    """The rows of a run of the reference engine."""
    session = session_of(scene, **options)
    session.advance(Stop(until, events), 10**9)
    return session.take_rows()


def run_of(scene, **options):
    """(session, reason to stop) of a run to the stop that is given."""
    stop = Stop(options.pop("until", None), options.pop("events", None))
    session = session_of(scene, **options)
    return session, session.advance(stop, 10**9)


def wide_mixture(n, seed, domain=es.Box, side=8.0, **scene):
    """About n small disks, points among them, around a few that are up to thirty times as large; some immovable, some tracers."""
    rng = np.random.default_rng(seed)
    large = rng.uniform(0.6, 1.2, int(rng.integers(1, 5)))
    small = rng.choice([0.0, 0.04, 0.05, 0.2], n, p=[0.1, 0.4, 0.4, 0.1])
    position, radius = np.empty((0, 2)), np.empty(0)
    for r in (*large, *small):
        for place in rng.uniform(r, side - r, (50, 2)):
            if np.all(np.sum((position - place) ** 2, axis=1) > (radius + r) ** 2):
                position, radius = np.vstack([position, place]), np.append(radius, r)
                break
    mass = np.maximum(radius, 0.04) ** 2
    if seed % 3 == 0:
        mass[0], mass[-20:] = math.inf, 0.0
    disks = es.Disks(position, rng.normal(size=position.shape), radius, mass)
    return es.Scene(disks=disks, domain=es.Open() if domain is es.Open else domain((side, side)), **scene)
