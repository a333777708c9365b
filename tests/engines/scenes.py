"""Scenes that several tests of engines use."""

import math

import numpy as np

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.reference import ReferenceSession
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


def session_of(scene, **options):
    return ReferenceSession(stage_of(scene), **options)


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
