"""`eventsim state`: where the disks are at any times of a run, from its log alone."""

from __future__ import annotations

import sys

import click

from eventsim import suffixes
from eventsim.cli.options import json_option, quiet_option, writable
from eventsim.cli.output import say, say_data


class ManyTimes(click.Command):
    """Lets one --at be followed by several times: `--at 1 2 3` is read as `--at 1 --at 2 --at 3`."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Repeat --at before each further number."""
        spread: list[str] = []
        for word in args:
            after_a_time = spread[-2:-1] == ["--at"]
            if after_a_time and _is_number(word):
                spread.append("--at")
            spread.append(word)
        return super().parse_args(ctx, spread)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


@click.command(cls=ManyTimes)
@click.argument("log")
@click.option("--at", "times", type=float, multiple=True, metavar="T [T ...]", help="Times on the scene's clock.")
@click.option(
    "--frames", type=click.IntRange(min=2), metavar="N", help="N times instead, evenly from beginning to end."
)
@click.option(
    "--out", metavar="FILE", help="Write to FILE (.csv, .npz; .xyz, .gsd, .dump for other programs) instead of stdout."
)
@click.option("--unwrapped", is_flag=True, help="Places that go on over the sides of a periodic domain.")
@json_option
@quiet_option
def command(
    log: str, times: tuple[float, ...], frames: int | None, out: str | None, unwrapped: bool, as_json: bool, quiet: bool
) -> None:
    """Print the positions and velocities of all disks at each time T of the run that LOG tells.

    A table with the columns time, disk, x, y, vx, vy, radius, mass; floats read back as the same bits. At the
    exact time of an event it is the state after it. The table of a single time is a disks_file for a scene.
    .xyz is extended XYZ, .gsd that of HOOMD, .dump (or .lammpstrj) that of LAMMPS; the last two keep how often a
    disk went round a periodic domain.

    \b
    Examples:
      eventsim state break.csv --at 0.5
      eventsim state break.csv --at 0.5 1 1.5 --out states.csv
      eventsim state gas.csv --frames 100 --out gas.xyz        for OVITO, freud, ASE, ...
      eventsim state gas.csv --frames 100 --unwrapped --out walk.csv

    \b
    Keys of --json:
      log, times, disks   the file; the times; the number of disks
      states              a list, one for each time: {time, position, velocity}, [x, y] for each disk;
                          left out where --out is given
      out                 the file written (null without)

    Exit codes: 0 done; 2 bad usage, no such log, or a time that the log does not cover.
    """
    target = writable(out, "--out", suffixes.STATES, source=log)
    if (not times) == (frames is None):
        raise click.UsageError("say at which times: either --at T [T ...] or --frames N")

    from eventsim.cli.words import as_json_text
    from eventsim.replay.filed import open_filed
    from eventsim.replay.images import images_of
    from eventsim.replay.images import unwrapped as going_on
    from eventsim.replay.log import EventLog
    from eventsim.replay.passage import Passage
    from eventsim.replay.states import state_columns, write_csv, write_states
    from eventsim.scene.names import plural

    events = open_filed(log)
    if times and isinstance(events, EventLog):
        events = events.expand(max(times))
    passage = Passage(events)
    if frames is not None:
        begin, end = passage.span
        times = tuple(begin + (end - begin) * (k / (frames - 1)) for k in range(frames))
    ordered = sorted(set(times))
    states = list(passage.states(ordered))
    place = {time: number for number, time in enumerate(ordered)}
    wanted = [place[time] for time in times]
    keeps = target is not None and target.suffix.lower() in suffixes.EXCHANGE and target.suffix.lower() != ".xyz"
    images = images_of(passage, states) if unwrapped or keeps else None
    if unwrapped and not keeps and images is not None:
        states = going_on(passage, states, images)
    states = [states[number] for number in wanted]
    if target is not None:
        write_states(target, events.scene, states, None if images is None else images[wanted])
    if as_json:
        data: dict[str, object] = {"log": log, "times": list(times), "disks": len(events.scene.disks)}
        if target is None:
            data["states"] = [
                {"time": s.time, "position": s.position.tolist(), "velocity": s.velocity.tolist()} for s in states
            ]
        say_data(as_json_text({**data, "out": None if target is None else str(target)}))
    elif target is None:
        write_csv(sys.stdout.buffer, state_columns(events.scene, states))
    elif not quiet:
        disks = plural(len(events.scene.disks), "disk")
        say(f"{disks} at {plural(len(times), 'time')} written to {target}")
