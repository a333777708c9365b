"""Letters of others: which of them can stand in a line that is read, printed or kept in a log."""

import unicodedata

COMMANDS = ("Cc", "Cs", "Zl", "Zp")
"""Unicode categories of what is no letter: control characters, halves of pairs, separators of lines and paragraphs."""


TURNS = "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"
"""What turns the direction of the letters that follow, beyond the name that it is in.  Source: Unicode Standard Annex 9, 2."""


def is_letter(character: str) -> bool:
    """Whether a character controls no terminal, breaks and turns no line and is not half of a pair."""
    return unicodedata.category(character) not in COMMANDS and character not in TURNS


def is_name(text: str) -> bool:
    """Whether a text is one line of letters."""
    return all(map(is_letter, text))
