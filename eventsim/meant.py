"""What objects are asked for by names that other libraries use: the error says which name it has here."""

from __future__ import annotations

from typing import TYPE_CHECKING

FRAME = "to_pandas() gives a data frame"
ADVANCE = "advance_to(time) lets time pass, step() goes to the next event"

MEANT = {
    "Excerpt": dict.fromkeys(("to_dataframe", "to_df", "df"), FRAME),
    "EventLog": {
        **dict.fromkeys(("to_dataframe", "to_df", "df"), FRAME),
        "to_csv": "save('log.csv') writes it",
        "columns": "each is an attribute (log.time, log.a), all are log.rows",
        "measures": "log.measure()",
    },
    "Run": {"events": "run.counters.events is their number, run.log tells them", "energy": "run.state.energy"},
    "Simulation": {
        **dict.fromkeys(("run", "run_until", "advance", "simulate"), ADVANCE),
        "kick": "set_velocity(disk, velocity)",
        "state_at": "sim.log.state_at(time)",
        "events": "sim.counters.events is their number, sim.log tells them",
    },
    "Scene": {
        "run": "es.simulate(scene)",
        "load": "es.load_scene(path)",
        "replace": "dataclasses.replace(scene, ...)",
        "contact_law": "scene.law",
    },
    "Measures": dict.fromkeys(("to_pandas", "to_dataframe", "df"), "to_dict(), items() and table() give all of them"),
    "State": {"kinetic_energy": "state.energy, which under gravity holds the potential energy too"},
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
            said = f"{kind!r} object has no attribute {name!r}{f': {hint}' if hint else ''}"
            raise AttributeError(said, name=name, obj=self)
