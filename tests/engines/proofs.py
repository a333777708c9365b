"""Runs of the certified engine, and a scene, that several tests use."""

import numpy as np

import eventsim as es
from eventsim.engines.base import Stop
from eventsim.engines.certified import CertifiedOptions
from eventsim.engines.certified.session import CertifiedSession
from eventsim.scene.stage import stage_of


def certified(scene, events=None, until=None, keep_rows=True, **options):
    """(session, reason to stop) of a certified run."""
    session = CertifiedSession(stage_of(scene), keep_rows, CertifiedOptions(**options))
    stopped = None
    while stopped is None:
        stopped = session.advance(Stop(until, events), 1 << 62)
    return session, stopped


def line(x, v, **scene):
    """Disks of diameter 1 on a line, at x plus one diameter each."""
    n = len(x)
    return es.Scene(
        disks=es.Disks(np.column_stack([np.add(x, range(n)), np.zeros(n)]), [(u, 0.0) for u in v], 0.5),
        domain=es.Open(),
        **scene,
    )
