"""Placing disks more densely than chance can: they grow while they move, until they have their radii.

Source: B. D. Lubachevsky, F. H. Stillinger, J. Stat. Phys. 60, 561 (1990), doi:10.1007/BF01025983.
`kernel` moves growing disks from contact to contact, `compiled` makes machine code of it, `schedule` says how fast they grow.
Engines stand above scenes and know no growth, so this package has a loop of its own.
"""
