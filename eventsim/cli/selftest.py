"""`eventsim selftest`: whether this machine computes the bits that the package promises; what a bug report should say."""

from __future__ import annotations

import click

from eventsim.cli.options import json_option, quiet_option
from eventsim.cli.output import FAILED, say, say_data


@click.command()
@json_option
@quiet_option
def command(as_json: bool, quiet: bool) -> None:
    """Compare what this machine computes with the table of what every machine must compute.

    It looks at floats (nothing fused, nothing flushed to zero), at the logs of all built-in scenes and of a gas, at their
    replay from what compact logs keep, and at the engines against each other. That takes at most a minute; kernels that are
    not compiled by then are left to the next call. A report of a fault should contain what it prints.

    \b
    Examples:
      eventsim selftest                     what this machine computes, and a verdict
      eventsim selftest --json > report     the same for a report of a fault

    \b
    Keys of --json:
      verdict               "well" or "wrong"
      findings              a list of {question, answer, words}; answer: well, wrong, open
      versions              of what is installed, and the machine

    Exit codes: 0 all that was asked is well; 1 something is wrong.
    """
    from eventsim.cli.words import as_json_text
    from eventsim.validation.selftest import bug_report, selftest

    findings = []
    for finding in selftest():
        findings.append(finding)
        if not (as_json or quiet) and finding.answer != "well":
            say(f"{finding.answer:5}  {finding.question}: {finding.words}")
    count = {answer: sum(one.answer == answer for one in findings) for answer in ("well", "wrong", "open")}
    wrong, about = count["wrong"] > 0, bug_report()
    if as_json:
        told = [{"question": one.question, "answer": one.answer, "words": one.words} for one in findings]
        say_data(as_json_text({"verdict": "wrong" if wrong else "well", "findings": told, "versions": about}))
    else:
        if not quiet:
            say("\n".join(f"{name}: {value}" for name, value in about.items()))
        say(
            f"{count['wrong']} answers are wrong: do not trust results of this machine, and please report this"
            if wrong
            else f"all is well: {count['well']} answers as they must be, {count['open']} left open"
        )
    if wrong:
        click.get_current_context().exit(FAILED)
