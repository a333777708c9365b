"""Structure of a state, through freud: bond order psi_6 and the pair distribution g(r).

Source: V. Ramasubramani et al., Comput. Phys. Commun. 254, 107275 (2020), doi:10.1016/j.cpc.2020.107275.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from eventsim.errors import EventsimError
from eventsim.record.events import Floats, State
from eventsim.scene.domain import Periodic
from eventsim.scene.scene import Scene

BINS, FARTHEST = 200, 0.45
"""Bins of g(r), up to this share of the shorter period."""


@dataclass(frozen=True, slots=True)
class Structure:
    """psi_6: magnitude of the mean bond order over Voronoi neighbours.  r, g: (bins,) distance and pair distribution."""

    psi_6: float
    r: Floats
    g: Floats

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return {"psi_6": self.psi_6, "r": self.r.tolist(), "g": self.g.tolist()}


def structure_of(scene: Scene, state: State) -> Structure:
    """The structure of a state in a periodic domain; EventsimError where there is no freud, or the domain has walls."""
    try:
        import freud
    except ImportError:
        raise EventsimError("structure is measured by freud: pip install 'eventsim-disks[structure]'") from None
    domain = scene.domain
    if not isinstance(domain, Periodic):
        raise EventsimError(f'structure: the domain is "{domain.kind}"; freud works in periodic ones')
    size = np.array(domain.size)
    box = freud.box.Box(Lx=size[0], Ly=size[1], is2D=True)
    centred = state.position - np.array(domain.origin) - 0.5 * size
    points = np.column_stack([centred, np.zeros(len(centred))])
    voronoi = freud.locality.Voronoi()
    voronoi.compute((box, points))
    order = freud.order.Hexatic(k=6, weighted=False)
    order.compute((box, points), neighbors=voronoi.nlist)
    pairs = freud.density.RDF(bins=BINS, r_max=FARTHEST * float(size.min()))
    pairs.compute((box, points))
    psi_6 = float(np.abs(np.mean(order.particle_order)))
    return Structure(psi_6, np.array(pairs.bin_centers, np.float64), np.array(pairs.rdf, np.float64))
