"""`eventsim measure`: numbers from a log or a run, with error bars, and theory beside them."""

from __future__ import annotations

import click

from eventsim.cli.options import json_option, quiet_option, scene_options
from eventsim.cli.output import say
from eventsim.cli.source import stop_options


@click.command()
@scene_options(required=True, metavar="LOG|SCENE")
@stop_options
@click.option("--discard", type=click.FloatRange(min=0), metavar="T", help="Leave out this much time at the beginning.")
@click.option("--structure", is_flag=True, help="Also g(r) at contact and psi_6 of the final state (needs freud).")
@json_option
@quiet_option
def command(
    scene: str,
    settings: tuple[str, ...],
    seed: int | None,
    until: float | None,
    events: int | None,
    discard: float | None,
    structure: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Measure the run that LOG tells, or of SCENE, simulated now without keeping a log.

    Every number has a standard error from block averages; the block length is found, not guessed. Theory stands
    beside it where there is one (equation of state of the fluid, closed forms, Maxwell, Enskog, Haff), with the
    difference in standard errors. The beginning is left out as far as --discard, the scene's key equilibration, or
    else the pressure itself tells. Where a steady state is in doubt, the reasons are printed.

    \b
    Examples:
      eventsim measure gas.csv
      eventsim measure periodic-fluid --set packing_fraction=0.3 --events 1000000
      eventsim measure gas --until 10 --discard 1 --json

    \b
    Keys of --json:
      scene                     as typed
      disks, packing_fraction   those that carry energy; null on the open plane
      duration, discarded       of the run; at its beginning; discard_given: whether it was asked for
      steady, equilibrated      can there be a steady state; was it reached, as far as one can tell
      doubts                    reasons against it, sentences
      quantities                name -> {value, error, unit, blocks, block_length, theory, accuracy, deviation,
                                source}; deviation in standard errors; null where there is none; a unit "2^1800 energy"
                                where speeds are such that the value would be no float in the scene's own
      speeds                    histograms: species, edges, density, error, theory, misfit
      correlations              lag, msd, msd_error, vacf, vacf_error
      structure                 null without --structure; psi_6, r, g

    \b
    Quantities: temperature (kT), Z (P V / N kT from the virial), Z_walls, pressure, collision_rate (pair contacts of a
    disk per time), wall_contact_rate, force_WALL (impacts, and the weight of disks at rest on it), mean_free_time,
    mean_free_path, mean_speed, diffusion, cooling_exponent (-d ln T per contact of a disk); with several species also
    temperature_I, mean_speed_I, collision_rate_I and collision_rate_I_J.

    Exit codes: 0 done; 2 bad usage, scene or file, or nothing to measure; 130 interrupted.
    """
    from eventsim.cli.measured import measured, measures_text
    from eventsim.cli.words import as_json_text

    measures, order = measured(scene, settings, seed, until, events, discard, structure, quiet)
    if as_json:
        found = None if order is None else order.to_dict()
        say(as_json_text({"scene": scene, **measures.to_dict(), "structure": found}))
    elif not quiet:
        say(measures_text(scene, measures, order))
