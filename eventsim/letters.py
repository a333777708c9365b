"""Letters of others: which of them can stand in a line that is read, printed or kept in a log."""

import unicodedata

COMMANDS = ("Cc", "Cs", "Zl", "Zp")
"""Unicode categories of what is no letter: control characters, halves of pairs, separators of lines and paragraphs."""


def is_letter(character: str) -> bool:
    """Whether a character controls no terminal, breaks no line and is not half of a pair."""
    return unicodedata.category(character) not in COMMANDS


def is_name(text: str) -> bool:
    """Whether a text is one line of letters."""
    return all(map(is_letter, text))
