"""What objects are asked for by names that other libraries use: the error says which name it has here."""

from __future__ import annotations

from typing import TYPE_CHECKING

FRAME = "to_pandas() gives a data frame"
ADVANCE = "advance_to(time) lets time pass, step() goes to the next event"

OF_RUNS = {
    "measure": "simulate(..., measure=True) and run.measures, or run.log.measure()",
    "temperature": "run.log.measure()['temperature'], or run.measures after simulate(..., measure=True)",
    "pressure": "run.log.measure(), or run.measures after simulate(..., measure=True)",
    "figure": "run.plot(kind)",
    "save": "run.log.save(path) writes the log, run.scene.save(path) the scene",
}
"""What is asked of a run."""

PACKAGE = {
    "Gas": 'gases are tables of scene files: load_scene({"gas": [{...}], ...}), or gallery("gas")',
    "Interrupt": "from eventsim.runner.options import Interrupt",
    "Kind": "from eventsim.record.events import Kind; log.kinds has them as text",
    "Wall": "Segment, Polygon, Polyline, Arc, Circle, Ellipse",
    "Side": 'sides are tables: Box((2, 1), walls={"bottom": {"restitution": 0.5}})',
    "plot": "run.plot(kind), log.plot(kind)",
    "animate": "run.animate(path), log.animate(path)",
    "run": "simulate(scene)",
    "load": "load_scene(path), load_log(path)",
}
"""What the package is asked for."""

MEANT = {
    "Excerpt": dict.fromkeys(("to_dataframe", "to_df", "df"), FRAME),
    "EventLog": {
        **dict.fromkeys(("to_dataframe", "to_df", "df"), FRAME),
        "to_csv": "save('log.csv') writes it",
        "columns": "each is an attribute (log.time, log.a), all are log.rows",
        "measures": "log.measure()",
        **dict.fromkeys(("times", "t"), "log.time"),
        **dict.fromkeys(("wall_names", "walls"), "log.wall_name is a column, log.provenance.wall_names are all"),
        "pairs": 'log[log.kinds == "pair"]',
        "state": "log.state_at(time)",
        "states": "log.state_at(time), one by one",
    },
    "Run": {"events": "run.counters.events is their number, run.log tells them", "energy": "run.state.energy", **OF_RUNS},
    "Simulation": {
        **dict.fromkeys(("run", "run_until", "advance", "simulate"), ADVANCE),
        "kick": "set_velocity(disk, velocity)",
        "state_at": "sim.log.state_at(time)",
        "events": "sim.counters.events is their number, sim.log tells them",
        **{name: f"sim.log.{name}(...)" for name in ("plot", "animate")},
        "save": "sim.log.save(path) writes the log",
        "measure": "Simulation(scene, measure=True).measures, or sim.log.measure()",
    },
    "Scene": {
        "run": "es.simulate(scene)",
        "load": "es.load_scene(path)",
        "replace": "dataclasses.replace(scene, ...)",
        "contact_law": "scene.law",
    },
    "Measures": dict.fromkeys(("to_pandas", "to_dataframe", "df"), "to_dict(), items() and table() give all of them"),
    "State": {
        "kinetic_energy": "state.energy, which under gravity holds the potential energy too",
        **{f"{name}s": f"state.{name}" for name in ("position", "spin")},
        "velocities": "state.velocity",
        "temperature": "a temperature is an average over a run: run.log.measure()['temperature']",
    },
    "Judged": dict.fromkeys(("plot", "figure"), "save_figure(path) draws it"),
}
"""Class -> a name that it does not have -> what is meant."""


class NamesMeant:
    """Who is asked for a name of `MEANT` says what is meant."""

    __slots__ = ()

    if not TYPE_CHECKING:  # a type checker knows which names there are

        def __getattr__(self, name):
            kind = type(self).__name__
            hint = MEANT.get(kind, {}).get(name)
            if kind == "Measures" and hint is None and not name.startswith("_") and name != "by_name":
                hint = f"measures[{name!r}]" if name in self.by_name else "measures.keys() are those that there are"
            said = f"{kind!r} object has no attribute {name!r}{f': {hint}' if hint else ''}"
            raise AttributeError(said, name=name, obj=self)
