"""Event-driven hard disks in two dimensions: a scene in, an event log out that replays bit for bit.

The story, and where each part of it lives::

    formulas   the physics: when two disks meet, what then    eventsim.formulas
    scene      what exists: disks, walls, a domain            eventsim.scene
    record     what happened: the rows of a log, its files    eventsim.record
    engines    how time passes: from event to event           eventsim.engines
    runner     what all runs share: loop, files, checkpoints  eventsim.runner
    replay     what follows from a log: states at any time    eventsim.replay
    measure    numbers from it, with error bars and theory    eventsim.measure
    validation engines against each other, theory and proof   eventsim.validation
    sweep      many runs, one table                           eventsim.sweep
    show       pictures of what happened                      eventsim.show
    simulation the way in for Python users                    eventsim.simulation
    live       the view in the browser                        eventsim.live
    cli        the way in from a terminal                     eventsim.cli

>>> import eventsim as es
>>> run = es.simulate(es.gallery("two-disks"), log=True)
>>> run.log.save("two-disks.csv")

The names below are loaded when they are first used, so ``import eventsim`` itself costs next to nothing.
"""

from importlib import import_module

TYPE_CHECKING = False  # type checkers know better; `typing` itself takes ten times as long to import as all of this

__version__ = "0.2.0.dev0"

if TYPE_CHECKING:
    from eventsim.engines.base import Stop as Stop
    from eventsim.errors import CheckpointError as CheckpointError
    from eventsim.errors import CollapseError as CollapseError
    from eventsim.errors import EventsimError as EventsimError
    from eventsim.errors import LogError as LogError
    from eventsim.errors import SceneError as SceneError
    from eventsim.judged import Judged as Judged
    from eventsim.judged import validate as validate
    from eventsim.record.events import State as State
    from eventsim.run import ENGINES as ENGINES
    from eventsim.run import EventLog as EventLog
    from eventsim.run import Run as Run
    from eventsim.run import load_log as load_log
    from eventsim.scene import Box as Box
    from eventsim.scene import Channel as Channel
    from eventsim.scene import Disks as Disks
    from eventsim.scene import Open as Open
    from eventsim.scene import Periodic as Periodic
    from eventsim.scene import Restitution as Restitution
    from eventsim.scene import Scene as Scene
    from eventsim.scene.files import load_scene as load_scene
    from eventsim.scene.gallery import gallery as gallery
    from eventsim.scene.walls import Arc as Arc
    from eventsim.scene.walls import Circle as Circle
    from eventsim.scene.walls import Ellipse as Ellipse
    from eventsim.scene.walls import Polygon as Polygon
    from eventsim.scene.walls import Polyline as Polyline
    from eventsim.scene.walls import Segment as Segment
    from eventsim.simulation import Simulation as Simulation
    from eventsim.simulation import resume as resume
    from eventsim.simulation import simulate as simulate

_HOMES = {
    "Scene": "scene",
    "Disks": "scene",
    "Box": "scene",
    "Periodic": "scene",
    "Channel": "scene",
    "Open": "scene",
    "Segment": "scene.walls",
    "Polygon": "scene.walls",
    "Polyline": "scene.walls",
    "Arc": "scene.walls",
    "Circle": "scene.walls",
    "Ellipse": "scene.walls",
    "Restitution": "scene",
    "load_scene": "scene.files",
    "gallery": "scene.gallery",
    "simulate": "simulation",
    "resume": "simulation",
    "Simulation": "simulation",
    "validate": "judged",
    "Judged": "judged",
    "Run": "run",
    "Stop": "engines.base",
    "State": "record.events",
    "EventLog": "run",
    "load_log": "run",
    "ENGINES": "run",
    "EventsimError": "errors",
    "SceneError": "errors",
    "LogError": "errors",
    "CollapseError": "errors",
    "CheckpointError": "errors",
}

__all__ = [*_HOMES, "__version__"]


_PARTS = ("formulas", "scene", "record", "engines", "runner", "replay", "measure", "validation", "sweep", "show", "live", "cli")


def __getattr__(name: str) -> object:
    """Load a public name, or a part of the package, on first use (PEP 562)."""
    if name in _PARTS:
        return import_module(f"eventsim.{name}")
    if name not in _HOMES:
        from eventsim.errors import did_you_mean  # only who errs pays for it
        from eventsim.meant import PACKAGE

        hint = f": {PACKAGE[name]}" if name in PACKAGE else did_you_mean(name, __all__)
        raise AttributeError(f"module 'eventsim' has no attribute {name!r}{hint}")
    value: object = getattr(import_module(f"eventsim.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the public names, loaded or not."""
    return sorted({*globals(), *__all__})
