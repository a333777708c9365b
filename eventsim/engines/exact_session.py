"""What the reference and the fast engine do alike with the clock: turnovers, open windows, quiet ends, kicks, snapshots."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from fractions import Fraction

from eventsim.engines.base import Session, Snapshot, Stop
from eventsim.engines.ends import end_of_clock, sunk_speeds
from eventsim.engines.exact_state import ExactState
from eventsim.engines.only_wraps import only_wraps
from eventsim.engines.turnover import epochs_to_kick, epochs_to_wrap, exponent_after, exponent_kicked
from eventsim.formulas.clock import EARLY, MOST_EPOCHS, epochs_before, remainder_since
from eventsim.formulas.real import NEVER, Real
from eventsim.scene.stage import Stage


class ExactSession(Session):
    """An engine that goes from event to event, in the middle of a run.

    Its clock turns over as `turnover` says.  A window without a row stays open beyond its end.  From there the clock jumps to the
    next contact; if no row comes there, it jumps back.  So a session is in one of three conditions: in a window that ends
    (`state.opened` is false), in an open one, or behind a jump to a contact that is still to come (`_before` is there).
    """

    state: ExactState

    def __init__(self, stage: Stage) -> None:
        super().__init__(stage)
        self._idle = 0.0  # time since the end of the last window that had rows
        self._behind: Snapshot | None = None  # where the last flight began, in an earlier window
        self._before: Snapshot | None = None  # the open window, when the clock has jumped to a contact that is still to come
        self._awaited: Real = 0.0  # when that contact is due in the open window
        self._missed: Real = -1.0  # when one is due in it that does not come where the clock jumps to
        self._clear: Real = 0.0  # none is due in it before

    # What an engine fills.

    @abstractmethod
    def _advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate, as `advance` says; a quiet end is not gone back from yet."""

    @abstractmethod
    def _fly_as(self, saved: Snapshot) -> None:
        """Let clock and flights be those of a snapshot; nothing is predicted from them yet."""

    @abstractmethod
    def _predict_afresh(self) -> None:
        """Fill cells and calendar from the flights."""

    @abstractmethod
    def _turn(self, end: Real, epochs: int, exponent: int, strayed: bool) -> None:
        """Begin a window some epochs later, all disks advanced to a time of this one, and predict all of them anew.

        exponent: of the new window.  strayed: disks may have left their cells by then.
        """

    @abstractmethod
    def _set_now(self, now: Real) -> None:
        """Set the remainder of the clock."""

    @abstractmethod
    def _begin_window(self, exponent: int) -> None:
        """Set how long the present window is."""

    @abstractmethod
    def _next_contact(self) -> float:
        """When the earliest contact that is predicted is due, rounded; inf without one."""

    @abstractmethod
    def _meets_on_the_plane(self) -> bool:
        """Whether a disk on the open plane will meet anything."""

    @abstractmethod
    def _search(self, goal: float, now: Real) -> Real | None:
        """When the first contact before a time of the open window is due; None without one.

        To find it disks enter cells that are ahead of them.  Behind the search they are where they are at the time `now`.
        """

    @abstractmethod
    def _kick(self, i: int, vx: float, vy: float) -> None:
        """Give disk i a velocity, now, and predict it anew."""

    # What follows.

    def advance(self, stop: Stop, budget: int) -> str | None:
        """Simulate until the stop or for about `budget` steps; the reason to stop, None where the budget ended first."""
        stopped = self._advance(stop, budget)
        if stopped == "quiet" and stop.until is None:
            self._go_back()
        return stopped

    @property
    def clock(self) -> tuple[int, float]:
        """Where the clock stands: (epoch, remainder)."""
        return self.state.epoch, self.state.now

    def kick(self, i: int, vx: float, vy: float) -> None:
        """Set the velocity of disk i from outside, now."""
        self._shorten_window(i, vx, vy)
        self._kick(i, vx, vy)

    def snapshot(self) -> Snapshot:
        """All that the future depends on."""
        return self.state.snapshot()

    def restore(self, saved: Snapshot) -> None:
        """Go on from a snapshot, this engine's or another's."""
        self._idle, self._behind, self._before = 0.0, None, None
        self._clear, self._missed = 0.0, -1.0
        self._fly_as(saved)
        self._predict_afresh()

    def _end_window(self, for_ever: bool) -> str | None:
        """Let the clock turn over, or the window stay open if it had no row.

        Why the run stops there: the clock has come to its end, speeds are below the digits, or nothing is ahead but wraps.
        """
        state = self.state
        if not (state.window_rows or state.opened) and state.epoch < MOST_EPOCHS:
            epochs = self._epochs_to_wrap()
            if epochs is None or epochs > 1 << state.window:
                self._leave_open(epochs)
                return None
        if state.epoch >= MOST_EPOCHS:  # nothing more can be logged
            return self._stop_at_the_end(self._next_contact())
        if state.window_rows and (sentence := self._sunk_speeds()) is not None:
            self.reason = sentence
            self._pass_to(state.window_end)
            return "digits"
        idles = for_ever and not state.window_rows
        self._idle = self._idle + float(state.window_end) if idles else 0.0
        self._remember(for_ever)
        self._turn_over(state.window_end, int(state.window_end / state.epoch_length))
        return "quiet" if idles and self._only_wraps() else None

    def _leave_open(self, epochs: int | None) -> None:
        """Let a window that had no row stay open for so many epochs, or for ever."""
        self.state.stay_open(epochs)
        self._clear, self._missed = 0.0, -1.0

    def _epochs_to_wrap(self) -> int | None:
        return epochs_to_wrap(self.stage, self.state.epoch, self.state.window, self.state.anchors())

    def _sunk_speeds(self) -> str | None:
        """A sentence where speeds have sunk below the digits, by contacts, so that the run ends with the window."""
        return None if self._pair_contacts() == 0 else sunk_speeds(self.stage, self.state.window_rows, self.state.anchors)

    def _pair_contacts(self) -> int:
        """How many contacts of disks there have been."""
        return self.counters.pair_contacts

    def _only_wraps(self) -> bool:
        """Whether disks will wrap for ever, and never meet anything again."""
        return only_wraps(self.stage, self.state.anchors(), self._idle)

    def _meets_again(self) -> bool:
        """Whether more is ahead than passages from cell to cell."""
        return self.stage.size is not None or self._next_contact() < NEVER or self._meets_on_the_plane()

    def _stop_at_the_end(self, due: Real) -> str:
        """Stop at the end of the clock, at or before a time at which the next contact is due: why."""
        state = self.state
        end = min(state.window_end, (MOST_EPOCHS - state.epoch) * state.epoch_length) if state.opened else state.window_end
        word, self.reason = end_of_clock(self.stage, state.epoch, end, float(due), self._meets_again())
        if word != "quiet":
            self._pass_to(end)
        return word

    def _turn_over(self, end: Real, epochs: int, strayed: bool = False) -> None:
        """Let the clock go on by some epochs, at the time `end` of its window."""
        state = self.state
        self.counters.turnovers += 1
        self._turn(end, epochs, exponent_after(self.stage, state.window, state.window_rows, state.anchors), strayed)

    def _jump(self, due: Real) -> bool:
        """Let the clock jump from an open window to a contact that is due there; whether it counts so far.

        All disks are advanced to shortly before it, and predicted anew.  If no row comes there, the clock jumps back.
        """
        state = self.state
        epochs = epochs_before(float(due), state.window, state.epoch_length)
        if state.epoch + epochs > MOST_EPOCHS:
            return False
        self._before, self._awaited = self.snapshot(), due
        self._turn_over(epochs * state.epoch_length, epochs, strayed=True)
        return True

    def _jump_back(self, until: Real, stop: float | Fraction | None) -> bool:
        """Be in the open window again where the contact does not come, or not until the stop; whether that is reached."""
        assert self._before is not None
        before, self._before = self._before, None
        stops = bool(until < self._latest)
        self._missed = -1.0 if stops else self._awaited
        self.counters.turnovers -= 1
        self._be_open(before)
        if stops:
            self._set_now(max(before.now, self._remainder(stop)))
        self._predict_afresh()
        return stops

    @property
    def _latest(self) -> float:
        """The time behind a jump at which the contact that it was for has come, or does not come."""
        return 2.0 * self.state.epoch_length

    def _came(self) -> None:
        """A row has come: the clock does not jump back, and a window that was open ends with the epoch."""
        self._before = None
        self.state.close()

    def _be_open(self, saved: Snapshot) -> None:
        """Be in the open window that a snapshot was taken in; nothing is predicted yet."""
        self._fly_as(saved)
        self.state.stay_open(self._epochs_to_wrap())

    def _contact_near(self, until: float) -> Real | None:
        """The time of a contact that is due behind `until`, but for which the clock jumps to a time before it; else None.

        After the jump the same contact may come until then, since the times are rounded.
        """
        state = self.state
        ahead = (until // state.epoch_length + 1.0 + EARLY) * state.epoch_length
        goal = min(ahead, state.window_end)
        if goal <= self._clear:
            return None
        found = self._search(goal, until)
        if found is None:
            self._clear = goal
        return None if found == self._missed else found

    def _remember(self, for_ever: bool) -> None:
        """Before the clock turns over: keep where the last flight began; on the open plane it may have been the last of all."""
        if not for_ever:
            self._behind = None
        elif self.stage.size is None and (self.state.window_rows or self._behind is None):
            self._behind = replace(self.snapshot(), now=self.state.last_begun)

    def _go_back(self) -> None:
        """Rewind to where the last flight began: when the engine noticed that nothing follows must not show in the result."""
        last = self.state.last_begun
        if self._behind is not None and not self.state.window_rows:
            self.restore(self._behind)
        elif last < self.state.now:
            self.restore(replace(self.snapshot(), now=last))

    def _pass_to(self, until: Real) -> None:
        """Let time pass to `until`, a remainder; without a stop time it stays where it is."""
        if self.state.now < until < NEVER:
            self._set_now(until)

    def _remainder(self, until: float | Fraction | None) -> float:
        """A time of the scene's clock as a remainder; inf where there is none."""
        if until is None:
            return NEVER
        return remainder_since(self.state.epoch, self.stage.epoch_length, until, self.stage.start_time)

    def _shorten_window(self, i: int, vx: float, vy: float) -> None:
        """Let the clock turn over at a kick before which nothing happened for long, or whose disk is too fast for the window."""
        stage, state = self.stage, self.state
        exponent = exponent_kicked(stage, state.window, lambda: state.anchors().kicked(i, vx, vy))
        epochs = epochs_to_kick(stage, state.epoch, float(state.now), state.window_rows, exponent < state.window)
        if epochs:
            self.counters.turnovers += 1
            self._turn(state.now, epochs, exponent, strayed=True)
        elif state.now < state.epoch_length:
            self._begin_window(exponent)
