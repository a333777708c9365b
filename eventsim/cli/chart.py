"""`eventsim chart`: speed against accuracy, all engines, as a figure and a table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from eventsim.cli.options import complete_scene, drawable, json_option, quiet_option, writable
from eventsim.cli.output import INTERRUPTED, say, say_data

if TYPE_CHECKING:
    from eventsim.validation.chart import Chart
    from eventsim.validation.precision import Task


TABLE = (
    "Against the event-driven engine: times the time for the error in the head (>: not reached in so much) | times the error "
    "in its time (-: no run so short)"
)


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE...]", shell_complete=complete_scene)
@click.option("--out", default="chart.png", show_default=True, metavar="FILE", help="The figure: .png, .svg or .pdf.")
@click.option("--details", metavar="FILE", help="All panels and the table of advantages, on a longer page.")
@click.option("--csv", metavar="FILE.csv", help="The numbers; without it, beside the figure.")
@click.option(
    "--patience", type=float, default=0.4, show_default=True, metavar="S", help="CPU seconds for one run at most."
)
@json_option
@quiet_option
def command(
    scenes: tuple[str, ...], out: str, details: str | None, csv: str | None, patience: float, as_json: bool, quiet: bool
) -> None:
    """Chart error against computing time for all engines: event-driven ones, balls, and stepped ones over their steps.

    Without a SCENE: a gas, the break, Galperin's disks, pressures of a gas and of a very dense packing, a pile that
    comes to rest; and which contacts are lost while energy looks perfect, how chaos eats digits, rates against the
    number of disks. Of a scene of your own: the positions after three contacts a disk. Truth is the certified engine
    where it is installed and knows the scene. Printed: five questions with their answers, and by what the
    event-driven engine is ahead of every other one.

    \b
    Examples:
      eventsim chart                        chart.png and chart.csv, in about two minutes
      eventsim chart gas break --out two.svg --details two-all.png
      eventsim chart my.toml --patience 10  finer steps

    \b
    Keys of --json:
      scenes, out, csv         what was charted; the files written
      rows                     the rows of the CSV file
      advantages               [{scene, label, wanted, time_ratio, bound, error_ratio}]: a stepped engine's time over that
                               of the event-driven one at the error wanted (bound ">": not reached in so much time),
                               its error over that of the event-driven one in equal time (null: no run so short)
      conclusions              [{question, answer}]
      left_out                 sentences

    Exit codes: 0 done; 2 bad usage or scene; 130 interrupted: what was measured is written, and said to be a part.
    """
    figure, page = drawable(out, "--out"), drawable(details, "--details")
    assert figure is not None
    table = writable(csv if csv is not None else str(figure.with_suffix(".csv")), "--csv", (".csv",))
    assert table is not None
    if not patience > 0.0:
        raise click.UsageError(f"--patience {patience!r}: must be above 0")

    from dataclasses import asdict

    from eventsim.cli.progress import status_line
    from eventsim.cli.words import as_json_text
    from eventsim.show.versus.precision import write_chart
    from eventsim.show.versus.summary import write_summary
    from eventsim.validation.advantages import advantages
    from eventsim.validation.chart import chart_of, default_tasks
    from eventsim.validation.conclusions import conclusions
    from eventsim.validation.table import chart_rows, provenance_lines, write_csv

    try:
        with status_line(quiet or as_json) as tell:
            tasks = [seeded_task(name) for name in scenes] if scenes else default_tasks()
            chart = chart_of(tasks, patience, further=not scenes, tell=tell, keeps=True)
    except KeyboardInterrupt:
        say("interrupted before two engines were measured: nothing is written", err=True)
        click.get_current_context().exit(INTERRUPTED)
    names = [task.name for task in tasks]
    rows = chart_rows(chart)
    command_line = click.get_current_context().obj
    write_csv(table, rows, provenance_lines(command_line, {"scenes": names, "patience_s": patience}))
    write_summary(chart, figure)
    if page is not None:
        write_chart(chart, page)
    if as_json:
        data = {
            "scenes": names,
            "out": str(figure),
            "csv": str(table),
            "rows": rows,
            "advantages": [asdict(advantage) for advantage in advantages(chart)],
            "left_out": chart.left_out,
            "conclusions": [answer._asdict() for answer in conclusions(chart)],
        }
        say_data(as_json_text(data))
    elif not quiet:
        say(_text(chart))
        say(f"\ncharted in {figure}, numbers in {table}")
    if chart.interrupted:
        click.get_current_context().exit(INTERRUPTED)


def seeded_task(name: str) -> Task:
    """The task on a scene, and on the same with other seeds where it draws random numbers."""
    from dataclasses import replace

    from eventsim.cli.source import draws_at_random, seeded_scene
    from eventsim.validation.chart import SEEDS, task_of

    scene = seeded_scene(name, (), None)
    task = task_of(scene, scene.called)
    if not draws_at_random(name, ()):
        return task
    return replace(task, others=tuple(seeded_scene(name, (), seed) for seed in SEEDS))


def _text(chart: Chart) -> str:
    """Who was left out, the answers, and the table of advantages."""
    from eventsim.cli.folding import tables
    from eventsim.validation.advantages import table
    from eventsim.validation.conclusions import conclusions

    lines = [*chart.left_out, *([""] if chart.left_out else []), *map(str, conclusions(chart)), "", TABLE]
    return "\n".join([*lines, *tables(*table(chart))])
