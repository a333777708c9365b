"""A world: a scene that is simulated a bounded time ahead of those who look at it."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from eventsim.compiler import has_compiler
from eventsim.engines import STEPPED
from eventsim.engines.stepped import IN_A_ROW, StepOptions
from eventsim.errors import EventsimError
from eventsim.live.described import gas_of, settings_of
from eventsim.live.messages import OPPONENTS, AddDisk, AddWall, Move, Open, Resize, Throw
from eventsim.live.packets import packet
from eventsim.live.source import demand_small
from eventsim.live.track import Track
from eventsim.patience import patience
from eventsim.record.events import State
from eventsim.replay.replay import Replay
from eventsim.scene import Box, Disks, Scene, Segment
from eventsim.scene.disks import join
from eventsim.show.frames import SECONDS
from eventsim.show.player.pack import PackedColumn, scene_description, stage_description, start_columns

if TYPE_CHECKING:
    from eventsim.live.viewer import Viewer

LEAD_SECONDS = 3.0
"""How far a world is simulated ahead of its viewers, in seconds at the speed at which they play."""

LEAD_EVENTS = 200_000
"""... and in events: a scene whose events pile up must not fill the memory ahead of those who look."""

MOST_EVENTS = 3_000_000
"""Events of one world (400 MB): all of them are kept, so that the page can go back and the log be downloaded."""

SCOUT_EVENTS = 2000
"""Events simulated before a scene is shown, which tell how fast disks get and how far they go."""

CROSSING_SECONDS = 5.0
"""Where a scene is made for no span (`until`): how long a disk of usual speed takes to cross the picture."""

MAKING_SECONDS = 20.0
"""How long a page waits for its disks to be placed; a file or a notebook waits longer."""

MOST_PER_FRAME = 1000
"""Disks in a comparison: some engines, and the page that looks for overlaps, go through all pairs in each frame."""

MANY = 500
"""Disks from which on the fast engine is worth its start: with fewer, the reference engine is ahead of any viewer."""


class World:
    """A scene, the tracks of the engines that run it, and the viewers that follow.

    given: the scene that the server was started with, if any. room(): how many more events the server has memory for.
    abandoned(world): called when the last viewer has left.
    """

    def __init__(self, given: Scene | None, room: Callable[[], int], abandoned: Callable[[World], None]) -> None:
        self.id = secrets.token_urlsafe(9)
        self.tracks: list[Track] = []
        self.viewers: set[Viewer] = set()
        self.opened = b""
        self.edition = 0
        self.scene: Scene | None = None
        self.speed = 1.0
        self._rate: float | None = None
        self._opponent = OPPONENTS[0]
        self._given = given
        self._room = room
        self._abandoned = abandoned
        self.busy = asyncio.Lock()
        self._news = asyncio.Event()
        self._task = asyncio.create_task(self._run_ahead())

    @property
    def count(self) -> int:
        """The events that this world keeps."""
        return sum(track.count for track in self.tracks)

    def leave(self, viewer: Viewer) -> None:
        """One looks no more; without any the world stops, and its memory is free."""
        self.viewers.discard(viewer)
        if not self.viewers:
            self._task.cancel()
            # A cancelled task remembers where it was, and so this world: kept here it would close a cycle, and the
            # large memory of a run would wait for the collector.
            del self._task
            self._abandoned(self)

    def wake(self) -> None:
        """Tell the simulating task that something has changed."""
        self._news.set()

    async def open(self, message: Open) -> None:
        """Begin with another scene, for all viewers; raise EventsimError, and keep the old one, where it cannot be."""
        async with self._changing():
            source = message.source
            if source is None and self._given is None:
                raise EventsimError("the server was started without a scene: choose one, or use the menu")
            with patience(MAKING_SECONDS):
                scene = self._given if source is None else await asyncio.to_thread(source.scene)
            assert scene is not None
            pace = None if source is None else source.pace
            self._opponent = message.opponent
            await self._begin(scene, message.rate, "open", pace)

    async def throw(self, message: Throw) -> None:
        """Give a disk a velocity at the time that is shown, and simulate on from there."""
        async with self._changing():
            state = await self._state_at(message.time, message.disk)
            if len(self.tracks) == 1 and self.tracks[0].ended is None:
                self.tracks[0].kick(message.disk, message.velocity)
                return
            # What has ended does not go on, and engines that go step by step cannot go back: all begin anew, with the same start.
            velocity = state.velocity.copy()
            velocity[message.disk] = message.velocity
            await self._begin(self._scene_from(replace(state, velocity=velocity)), self._rate, "throw", self.speed)

    async def move(self, message: Move) -> None:
        """Begin anew from the state at the time that is shown, with one disk elsewhere."""
        async with self._changing():
            state = await self._state_at(message.time, message.disk)
            position = state.position.copy()
            position[message.disk] = message.position
            await self._begin(self._scene_from(replace(state, position=position)), self._rate, "move", self.speed)

    async def add_disk(self, message: AddDisk) -> None:
        """Begin anew from the state at the time that is shown, with one more disk, at rest and of mass 1."""
        async with self._changing():
            state, scene = await self._state_at(message.time), self.tracks[0].scene
            moved = scene.disks.begun_at(state.position, state.velocity, state.spin)
            disks = join([moved, Disks([message.position], radius=message.radius)])
            await self._begin(scene.begun_at(state.time, disks), self._rate, "disk", self.speed)

    async def add_wall(self, message: AddWall) -> None:
        """Begin anew from the state at the time that is shown, with one more wall."""
        async with self._changing():
            scene = self._scene_from(await self._state_at(message.time))
            walled = replace(scene, walls=(*scene.walls, Segment(message.start, message.end)))
            await self._begin(walled, self._rate, "wall", self.speed)

    async def resize(self, message: Resize) -> None:
        """Begin anew in a box of another size; its walls wait outside of disks that would no longer fit."""
        async with self._changing():
            if self.scene is None or not _resizable(self.scene):
                raise EventsimError("only a box without further walls can follow the size of the window")
            state = await self._state_at(message.time)
            box = self.scene.domain
            assert isinstance(box, Box)
            needed = (state.position + self.scene.disks.radius[:, None] - np.array(box.origin)).max(axis=0)
            width, height = np.maximum(message.size, np.nextafter(needed, np.inf)).tolist()
            scene = self._scene_from(state, replace(box, size=(width, height)))
            await self._begin(scene, self._rate, "resize", self.speed)

    async def log_to(self, path: str) -> None:
        """Write all that happened so far; raise EventsimError where nothing has been opened."""
        async with self.busy:
            if not self.tracks:
                raise EventsimError("this world has no scene yet")
            log = await asyncio.to_thread(self.tracks[0].log)
        await asyncio.to_thread(log.save, path)

    async def _begin(self, scene: Scene, rate: float | None, why: str, pace: float | None) -> None:
        """Put a scene before the viewers, which is held still. pace: scene time per second, None: as suits it."""
        demand_small(scene)
        notice = None
        track, speed, header, columns = await asyncio.to_thread(_scouted, scene, pace)
        tracks = [track]
        if rate is not None:
            try:
                tracks.append(await asyncio.to_thread(_beside, scene, self._opponent, speed / rate))
            except EventsimError as error:
                notice = f"nothing to compare with: {error}"
        self.scene, self.tracks = scene, tracks
        self.edition += 1
        self._rate, self.speed = rate, speed
        about = {"edition": self.edition, "world": self.id, "why": why, "notice": notice}
        about |= {"rate": rate, "opponent": self._opponent, **_lateness(self._opponent)}
        self.opened = packet("opened", columns, **header, **about, tracks=len(tracks))
        for viewer in self.viewers:
            viewer.begin(speed)

    def _scene_from(self, state: State, domain: Box | None = None) -> Scene:
        """Return the scene with another start; its disks keep radius and mass."""
        scene = self.tracks[0].scene
        disks = scene.disks.begun_at(state.position, state.velocity, state.spin)
        return scene.begun_at(state.time, disks, domain)

    async def _state_at(self, time: float, disk: int = 0) -> State:
        """Take the event-driven engine back to a time; raise where there is no such disk."""
        if not self.tracks:
            raise EventsimError("there is no scene yet: open one first")
        track = self.tracks[0]
        if disk >= len(track.scene.disks):
            raise EventsimError(f"disk {disk} does not exist; there are {len(track.scene.disks)}, counted from 0")
        if time > track.horizon:
            raise EventsimError(f"time = {time:g}: is not simulated yet, and no page shows it; {track.horizon:g} is")
        try:
            return await asyncio.to_thread(track.rewind, time)
        finally:
            for viewer in self.viewers:
                viewer.cut(track.count, track.horizon)

    @asynccontextmanager
    async def _changing(self) -> AsyncIterator[None]:
        """Hold the world still; in the end tell everybody, whether the change succeeded or not."""
        async with self.busy:
            try:
                yield
            finally:
                self._tell()

    def _tell(self) -> None:
        for viewer in self.viewers:
            viewer.wake()
        self.wake()

    async def _run_ahead(self) -> None:
        """Simulate whatever is behind its goal, piece by piece; sleep while nothing is."""
        while True:
            self._news.clear()
            behind = self._behind()
            if behind is None:
                await self._news.wait()
                continue
            track, goal, most = behind
            async with self.busy:
                if track not in self.tracks:
                    continue
                try:
                    await asyncio.to_thread(track.advance, goal, most)
                except EventsimError as error:
                    track.ended = str(error)
                except Exception:
                    logging.getLogger(__name__).exception("the engine failed")
                    track.ended = "the engine failed; the server's terminal tells how"
            for viewer in self.viewers:
                viewer.wake()

    def _behind(self) -> tuple[Track, float, int] | None:
        """Return a track that is behind the viewers' goals, how far it is to go, and by how many events at most."""
        goal = max((viewer.time + LEAD_SECONDS * viewer.speed for viewer in self.viewers), default=-1.0)
        seen = max((viewer.events for viewer in self.viewers), default=0)
        waiting = [track for track in self.tracks if track.ended is None and track.horizon < goal]
        for track in sorted(waiting, key=lambda track: track.horizon):
            room = min(MOST_EVENTS - track.count, self._room())
            if room <= 0:
                track.ended = (
                    f"this world has {track.count:,} events, as many as are kept: download the log, or begin anew"
                )
                continue
            most = min(seen + LEAD_EVENTS - track.count if track is self.tracks[0] else LEAD_EVENTS, room)
            if most > 0:
                return track, goal, most
        return None


def _scouted(scene: Scene, pace: float | None) -> tuple[Track, float, dict[str, Any], list[PackedColumn]]:
    """Return the track of a scene, its usual speed, and header and columns of the description that a page draws it from."""
    track = Track(scene, "fast" if len(scene.disks) >= MANY and has_compiler() else "reference")
    seconds = LEAD_SECONDS if scene.domain.size is not None else SECONDS  # on the open plane the window holds all flights
    track.advance(seconds * (pace or _usual_speed(scene)), SCOUT_EVENTS)
    replay = Replay(track.log())
    stage = stage_description(replay, replay.span[1])
    x0, y0, x1, y1 = stage["shown"]
    speed = pace or _usual_speed(scene) or max(x1 - x0, y1 - y0) / (stage["fastest"] * CROSSING_SECONDS)
    header = {
        "title": scene.called,
        "startTime": scene.start_time,
        "usualSpeed": speed,
        "resizable": _resizable(scene),
        "borders": len(replay.stage.boundaries),
        "scene": scene_description(replay.stage),
        "stage": stage,
        "gas": gas_of(scene),
        "settings": settings_of(scene),
    }
    return track, speed, header, start_columns(replay)


def _beside(scene: Scene, engine: str, frame: float) -> Track:
    """Return the track of another engine; raise EventsimError for scenes that are not for it."""
    if len(scene.disks) > MOST_PER_FRAME:
        raise EventsimError(f"a comparison is for at most {MOST_PER_FRAME} disks, and there are {len(scene.disks)}")
    return Track(scene, engine, returns=False, dt=frame)


def _lateness(engine: str) -> dict[str, float]:
    """The steps by which an engine may tell a contact late, and over which it may spread its rows."""
    options = STEPPED[engine].options
    assert issubclass(options, StepOptions)
    return {"late": options.late, "spread": IN_A_ROW if options.spread else 0.0}


def _resizable(scene: Scene) -> bool:
    return isinstance(scene.domain, Box) and not scene.walls


def _usual_speed(scene: Scene) -> float:
    """Return the scene time that a second of playing shows, if the scene says what span it is made for; else 0."""
    if scene.until is None or not scene.until > scene.start_time:
        return 0.0
    return (scene.until - scene.start_time) / SECONDS
