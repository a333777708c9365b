"""Placing disks more densely than chance can: they grow while they move, until they have their radii.

Source: B. D. Lubachevsky, F. H. Stillinger, J. Stat. Phys. 60, 561 (1990), doi:10.1007/BF01025983.
`kernel` moves growing disks from contact to contact; `growth` keeps the schedule; `place` makes disks of gases.
"""

from eventsim.scene.compress.place import place_compressed

__all__ = ["place_compressed"]
