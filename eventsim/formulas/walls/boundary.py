"""A hard side of the domain: a straight wall without ends across an axis, met from inside."""

from typing import NamedTuple

from eventsim.formulas.real import Real


class Boundary(NamedTuple):
    """A hard wall across axis 0 (x) or 1 (y), at `position`, met from above (+1) or from below (-1); its number in the log."""

    axis: int
    position: float
    side: float
    wall: int

    def normal(self) -> tuple[float, float]:
        """The unit normal that points into the domain."""
        return (self.side, 0.0) if self.axis == 0 else (0.0, self.side)

    def target(self, radius: Real) -> Real:
        """The coordinate across the wall of a centre that touches it."""
        return self.position + self.side * radius

    def touching(self, x: Real, y: Real, radius: Real) -> tuple[Real, Real]:
        """The place of a disk, set exactly onto the wall."""
        return (self.target(radius), y) if self.axis == 0 else (x, self.target(radius))
