"""Figures of engines against each other: `comparison` of one scene (validate), `precision` of many (chart)."""
