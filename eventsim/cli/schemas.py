"""Schemas: what `--json` prints, verb by verb, as JSON Schema. The help of a verb says what its keys mean."""

from __future__ import annotations

from typing import Any

DIALECT = "https://json-schema.org/draft/2020-12/schema"
NULL = "_or_null"


def form(optional: str = "", **keys: str) -> dict[str, Any]:
    """The schema of an object.

    Args:
        optional: keys that may be missing.
        **keys: a type, or with `_or_null` a type or null, and the keys of that type. A number that is not finite is null.
    """
    properties = {}
    for kind, names in keys.items():
        plain = kind.removesuffix(NULL)
        for name in names.split():
            properties[name] = {"type": [plain, "null"] if kind != plain else plain}
    required = sorted(set(properties) - set(optional.split()))
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


FORMS: dict[str, tuple[dict[str, Any], ...]] = {
    "run": (
        form(
            string="scene version engine stopped",
            string_or_null="name begun_by digest reason log state checkpoint",
            integer="disks events pair_contacts wall_contacts",
            number="elapsed_s compile_s write_s",
            number_or_null="start_time time events_per_s",
            object="counters residuals",
            object_or_null="horizon trust",
        ),
    ),
    "check": (
        form(
            string="scene domain engine",
            string_or_null="name",
            integer="disks moving immovable obstacles tracers species_count gap_bits images touching_pairs",
            integer_or_null="events",
            number="fastest start_time epoch_length",
            number_or_null="temperature packing_fraction contact_duration until",
            array="species radii masses touching_notes near_ties",
            array_or_null="size origin gravity table restitution",
            object="walls shapes search explanation",
            object_or_null="law horizon",
            boolean="low_parts points",
        ),
        form(
            string="log engine version",
            string_or_null="digest stopped",
            integer="rows bits",
            number_or_null="begin end",
            array="notes",
            boolean="compact",
        ),
    ),
    "gallery": (
        form(array="scenes"),
        form(string="name title text about", string_or_null="copied", object="parameters"),
    ),
    "state": (form("states", string="log", string_or_null="out", integer="disks", array="times states"),),
    "measure": (
        form(
            string="scene",
            integer="disks tracers",
            number="duration discarded",
            number_or_null="packing_fraction",
            boolean="discard_given steady driven equilibrated",
            array="doubts speeds",
            object="quantities correlations series",
            object_or_null="table profile structure transport lyapunov boundary escape recurrence",
        ),
    ),
    "sweep": (
        form(string="scene out", string_or_null="figure", integer="runs failed equilibrated", number="elapsed_s"),
    ),
    "animate": (form(string="scene out format", integer="events bytes", number="elapsed_s"),),
    "figure": (form(string="scene kind out", integer="events bytes", number="elapsed_s"),),
    "validate": (
        form(
            string="scene engine",
            number_or_null="horizon",
            boolean="agrees",
            array="checks rows left_out verdict",
            object="orders settings versions",
        ),
        form(
            string="scene source told",
            integer="compared",
            number_or_null="tolerance lost believed energy momentum elapsed_per_time",
            array="faults remarks verdict",
            object="contacts late positions versions",
            object_or_null="first_fault parting deepest_overlap",
        ),
    ),
    "chart": (form(string="out csv", array="scenes rows advantages left_out conclusions"),),
    "stress": (
        form(string_or_null="out csv", integer="faults", array="scenes engines verdicts"),
        form(integer="soak seed faults", array="engines findings"),
    ),
    "certify": (
        form(
            string="scene stopped",
            string_or_null="name reason float64_stopped float64_reason log",
            integer="proven bits agreed surplus near_ties",
            number="elapsed_s",
            number_or_null="time time_deviation deviation deviation_share velocity_deviation velocity_deviation_share",
            boolean="traced",
            array="attempts enclosures",
            object_or_null="difference",
        ),
    ),
    "selftest": (form(string="verdict", array="findings", object="versions"),),
    "warm": ({"type": "object", "additionalProperties": form(number="compile_s")},),
    "live": (form(string="address", string_or_null="scene"),),
}
"""verb -> the objects that it may print."""


def schema_of(verb: str) -> dict[str, Any]:
    """The schema of what a verb prints with --json."""
    forms = FORMS[verb]
    body = forms[0] if len(forms) == 1 else {"anyOf": list(forms)}
    return {"$schema": DIALECT, "title": f"eventsim {verb} --json", **body}
