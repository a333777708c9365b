"""`eventsim warm`: compiles kernels ahead of the runs that need them."""

from __future__ import annotations

import sys

import click

from eventsim.cli.options import complete_scene, json_option, quiet_option
from eventsim.cli.output import say, say_data

USUAL = ("gas", "mixture", "sinai", "jar")
"""Built-in scenes whose kernels serve many others: disks alone, of several sizes, at posts, under gravity between walls."""


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE ...]", shell_complete=complete_scene)
@json_option
@quiet_option
@click.option("--job", is_flag=True, hidden=True, help="Read from stdin what a run of this package wants.")
def command(scenes: tuple[str, ...], as_json: bool, quiet: bool, job: bool) -> None:
    """Compile the fast engine's kernels for scenes, so that no run has to wait for them.

    SCENE is a scene file or a built-in scene; without one, kernels that serve most scenes are compiled: those of gas,
    mixture, sinai and jar.  Kernels are kept in the user's cache (EVENTSIM_CACHE_DIR names another folder), until eventsim
    or numba is another one.  Scenes of one kind share them.

    A run that is long enough compiles what is missing, half of it in a second process if a second core is free;
    EVENTSIM_WARM=0 lets it compile all for itself.

    \b
    Examples:
      eventsim warm                       what most scenes need
      eventsim warm galperin mine.toml    what these need

    
    Keys of --json: the scenes by name, each with
      compile_s             seconds of compiling; little where kernels were there

    Exit codes: 0 done; 2 bad usage or scene, or nothing can be compiled; 130 interrupted.
    """
    from eventsim.engines.warming import work

    if job:
        work(sys.stdin.buffer)
        return
    from eventsim.cli.source import chosen_scene
    from eventsim.compiler import has_compiler
    from eventsim.engines.warming import warm
    from eventsim.scene.stage import stage_of

    if not has_compiler():
        raise click.UsageError("nothing can be compiled here: numba is not installed, or is told not to compile")
    found = {}
    for name in scenes or USUAL:
        stage = stage_of(chosen_scene(name, (), None))
        logs = (True,) if stage.law.loses_energy() else (True, False)
        found[name] = {"compile_s": sum(warm(stage, keep_rows) for keep_rows in logs)}
        if not (quiet or as_json):
            say(f"{name}: compiled in {found[name]['compile_s']:.1f} s")
    if as_json:
        from eventsim.cli.words import as_json_text

        say_data(as_json_text(found))
