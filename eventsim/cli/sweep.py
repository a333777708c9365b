"""`eventsim sweep`: a scene for many values and seeds; one table of measures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from eventsim import suffixes
from eventsim.cli.options import Whole, complete_scene, drawable, json_option, quiet_option, writable
from eventsim.cli.output import BAD_INPUT, INTERRUPTED, say, say_data
from eventsim.errors import EventsimError, SceneError
from eventsim.processes import cores

if TYPE_CHECKING:
    from eventsim.scene import Scene
    from eventsim.sweep.task import Row


NO_KEYS = ("unknown key", "setting '", "no such file", "neither a scene file")
"""What is in a problem that other values do not mend."""

SETTINGS_HELP = "Values of a key: KEY=A,B,C or KEY=START:STOP:COUNT. Given several times: every combination."


@click.command()
@click.argument("scene", shell_complete=complete_scene)
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUES", help=SETTINGS_HELP)
@click.option("--replicas", type=click.IntRange(min=1), default=1, show_default=True, help="Runs of each combination.")
@click.option("--seed", type=click.IntRange(min=0), default=1, metavar="S", help="Every run's seed is derived from it.")
@click.option("--out", required=True, metavar="FILE", help="The table: FILE.csv or .parquet.")
@click.option("--figure", metavar="FILE", help="Draw Z against the packing fraction to FILE.png, .svg or .pdf.")
@click.option("--x", metavar="COLUMN", help="Draw against this key or column.  [default, with --y: the first key of --set]")
@click.option("--y", metavar="COLUMN", help="Draw this measure.  [default, with --x: Z]")
@click.option("--until", type=float, metavar="T", help="Stop every run at this time.")
@click.option("--events", type=Whole(min=1), metavar="N", help="Stop every run after N events.")
@click.option("--discard", type=click.FloatRange(min=0), metavar="T", help="Leave out this time at the beginnings.")
@click.option("--structure", is_flag=True, help="Also g(r) at contact, S(0), psi_6 and coordination (needs freud).")
@click.option("--transport", is_flag=True, help="Also viscosity, heat conductivity and self-diffusion.")
@click.option("--engine", default="auto", show_default=True, metavar="NAME", help="Which engine simulates.")
@click.option("--workers", type=click.IntRange(min=1), metavar="W", help="Processes; default: one for each core.")
@click.option("--dask", metavar="ADDRESS", help="Let a Dask cluster do it, such as tcp://host:8786.")
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    replicas: int,
    seed: int,
    out: str,
    figure: str | None,
    x: str | None,
    y: str | None,
    until: float | None,
    events: int | None,
    discard: float | None,
    structure: bool,
    transport: bool,
    engine: str,
    workers: int | None,
    dask: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Run SCENE for every combination of values, several times each, and write one table of measures.

    One row a run: the settings, replica and seed, what `eventsim measure` measures with its errors and theory, and
    in the column `failed` the reason where a run could not be done. The table does not depend on how many workers
    there are, nor on interrupts: the same command again goes on where the last one was stopped (FILE.journal).

    \b
    Examples:
      eventsim sweep periodic-fluid --set packing_fraction=0.1:0.6:6 --replicas 4 --events 200000 --out z.csv --figure z.png
      eventsim sweep cooling --set restitution=0.8:0.95:4 --events 3000 --out e.csv --figure e.png --y cooling_exponent
      eventsim sweep gas.toml --set gas.0.count=100,1000 --set restitution=0.9,0.95 --out cooling.parquet
      eventsim sweep gas.toml --set gas.0.radius=0.01:0.02:11 --out gas.csv --dask tcp://head:8786

    \b
    Keys of --json:
      scene, out, figure     as typed; the files written (figure: null without, or where
                             every run failed)
      runs, failed           rows of the table; how many of them failed
      equilibrated           how many of the others nothing speaks against
      elapsed_s              seconds

    Exit codes: 0 done; 2 bad usage, scene or file, or every run failed; 130 interrupted (what was done is kept).
    """
    target = writable(out, "--out", suffixes.TABLES)
    drawn = drawable(figure, "--figure")
    assert target is not None
    if drawn is None and (x or y):
        raise click.UsageError("--x and --y say what is drawn: give --figure FILE too")
    if dask is not None and workers is not None:
        raise click.UsageError("--workers is for this machine, --dask for a cluster: give one of them")

    from functools import partial
    from time import perf_counter

    from eventsim.cli.progress import TaskBar
    from eventsim.cli.words import as_json_text
    from eventsim.scene.names import plural
    from eventsim.sweep import sweep
    from eventsim.sweep.dask import dask_executor
    from eventsim.sweep.grid import grid_of

    began = perf_counter()
    grid = grid_of(settings)
    _demand_keys(scene, grid)
    try:
        with dask_executor(dask) as executor, TaskBar(quiet=quiet) as progress:
            rows = sweep(
                partial(_scene, scene),
                grid,
                replicas=replicas,
                seed=seed,
                until=until,
                events=events,
                discard=discard,
                studies=[name for name, asked in (("structure", structure), ("transport", transport)) if asked],
                engine=engine,
                out=target,
                workers=workers or max(1, int(cores())),
                executor=executor,
                progress=progress,
                name=scene,
            )
    except KeyboardInterrupt:
        say(f"interrupted; the same command again goes on from here ({target}.journal)", err=True)
        click.get_current_context().exit(INTERRUPTED)
    failed = sum(row["failed"] is not None for row in rows)
    drawn = drawn if failed < len(rows) else None
    if drawn is not None:
        try:
            _draw(rows, drawn, x, y, scene)
        except EventsimError as error:
            raise EventsimError(f"{error}; the table {target} is whole") from None
    settled = sum(row.get("equilibrated") is True for row in rows)
    if as_json:
        data = {"scene": scene, "out": str(target), "figure": None if drawn is None else str(drawn)}
        counts = {"runs": len(rows), "failed": failed, "equilibrated": settled}
        say_data(as_json_text({**data, **counts, "elapsed_s": perf_counter() - began}))
    elif not quiet:
        why = next((f" (the first: {row['failed']})" for row in rows if row["failed"] is not None), "")
        say(
            f"{plural(len(rows), 'run')} of {scene} in {target}: {settled} equilibrated, {failed} failed{why};"
            f" {perf_counter() - began:.3g} s"
        )
    if failed == len(rows):
        click.get_current_context().exit(BAD_INPUT)


def _demand_keys(scene: str, grid: Mapping[str, Sequence[str]]) -> None:
    """Raise SceneError where settings name no keys of the scene: all runs would fail for it."""
    try:
        _scene(scene, tuple(f"{key}={values[0]}" for key, values in grid.items()), None)
    except SceneError as error:
        if slips := [problem for problem in error.problems if any(words in problem for words in NO_KEYS)]:
            raise SceneError(slips) from None


def _draw(rows: Sequence[Row], path: Path, x: str | None, y: str | None, name: str) -> None:
    """Draw the columns that are asked for, or else Z against the packing fraction."""
    if x or y:
        from eventsim.show.figures.swept import write_swept

        write_swept(rows, path, x, y, name)
    else:
        from eventsim.show.figures.equation_of_state import write_equation_of_state

        write_equation_of_state(rows, path, name)


def _scene(scene: str, settings: tuple[str, ...], seed: int | None) -> Scene:
    """The scene of a task, in whichever process."""
    from eventsim.cli.source import seeded_scene

    return seeded_scene(scene, settings, seed)
