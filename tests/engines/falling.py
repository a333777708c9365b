"""What falls, for tests of several kinds, and the engines that they try."""

import eventsim as es
from eventsim.compiler import has_compiler

ENGINES = ("reference", "fast") if has_compiler() else ("reference",)


def dropped(walls=(), domain=None, **changes):
    disks = es.Disks([[5.0, 1.5]], radius=0.5)
    return es.Scene(
        disks, domain or es.Box((10.0, 10.0)), walls, **{"gravity": (0.0, -2.0), "restitution": 0.5, **changes}
    )
