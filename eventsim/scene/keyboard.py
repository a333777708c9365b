"""Characters that look like those of a keyboard and are others, as word processors and web pages write them."""

from __future__ import annotations

import re

BLANKS = "\u00a0\u1680\u2000-\u200a\u202f\u205f\u3000"
UNSEEN = "\u00ad\u061c\u200b-\u200f\u202a-\u202e\u2060-\u2064\u2066-\u2069\ufeff"
HYPHENS = "\u2010-\u2015\u2212\ufe58\ufe63"
WIDE = "\uff01-\uff5e"
"""Letters, digits and marks as wide as Chinese characters: so much above their own codes."""

WIDER = 0xFEE0

SIGNS = {"\u00d7": "*", "\u22c5": "*", "\u00b7": "*", "\u00f7": "/", "\u2215": "/", "\u221e": "inf", "\u2236": ":"}


def without_foreign_blanks(text: str) -> str:
    """A text with the blanks of a keyboard, and without characters that nobody sees."""
    return re.sub(f"[{UNSEEN}]", "", re.sub(f"[{BLANKS}]", " ", text))


def with_plain_signs(text: str) -> str:
    """A text with the minus, the digits and the signs of a keyboard."""
    text = re.sub(f"[{HYPHENS}]", "-", text)
    text = re.sub(f"[{WIDE}]", lambda letter: chr(ord(letter[0]) - WIDER), text)
    return re.sub("|".join(SIGNS), lambda sign: SIGNS[sign[0]], text)


def plain(text: str) -> str:
    """A text as a keyboard writes it."""
    return with_plain_signs(without_foreign_blanks(text))
