"""The wish to end a run early, as another thread or a signal handler may have it; the run keeps what has happened."""

from __future__ import annotations

from eventsim.engines.base import BrokenOffError, Session


class Interrupt:
    """Asks a run to end; it does so between two stints of its engine, and its outcome says `interrupted`.

    asked: whether it has been asked.  session: the one that is at work, None before and after.
    """

    def __init__(self) -> None:
        self.asked = False
        self.session: Session | None = None

    def ask(self) -> None:
        """Ask the run to end, from wherever."""
        self.asked = True

    def break_in(self) -> None:
        """Ask from a signal handler: what only prepares itself is broken off at once, and so is all by a second call.

        Raises KeyboardInterrupt, or BrokenOffError into a session that prepares itself.
        """
        again, self.asked = self.asked, True
        if again or self.session is None:
            raise KeyboardInterrupt
        if self.session.prepares:
            raise BrokenOffError
