"""The shapes a disk can meet, one file each: when (delay), and in which direction it pushes (normal).

A shape is a tuple of numbers (a NamedTuple), so that compiled engines can take it as it is.  Sides: +1 or -1 for the two
sides of a thin wall; 0: the disk has not met this wall last, and its position says on which side it is.
"""
