"""What a gallery scene asks of its parameters."""

from eventsim.errors import SceneError


def demand(holds: bool, parameter: str, value: float | int | str, rule: str) -> None:
    """Raise SceneError naming `parameter`, its `value` and the `rule` unless the rule `holds`."""
    if not holds:
        raise SceneError([f"{parameter} = {value}: {rule}"])
