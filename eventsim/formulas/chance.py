"""Chance in laws of contacts: numbers that are a function of a seed, a disk and how many contacts it has had before.

So engines, threads, a pause, a resume and a replay find the same ones.  Samplers use integers, + - * /, square roots and
comparisons alone: each machine has the same bits.

Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC11 (2011),
doi:10.1145/2063384.2063405 (Philox4x32-10); J. von Neumann, Various techniques used in connection with random digits, Applied
Mathematics Series 12, 36 (1951) (the exponential distribution by comparisons); G. Marsaglia, T. A. Bray, SIAM Rev. 6, 260 (1964)
(a direction from a point in the disk).
"""

from typing import TypeAlias

from eventsim.formulas.real import sqrt

WORD = 0xFFFFFFFF
"""The largest number of 32 bits."""

ROUNDS = 10

FIRST, SECOND = 0xD2511F53, 0xCD9E8D57
"""What words of the counter are multiplied by."""

GOLDEN, ROOT = 0x9E3779B9, 0xBB67AE85
"""What is added to the words of the key after each round."""

Key: TypeAlias = tuple[int, int, int]
"""(seed, disk, number of contacts): whose chance it is; the seed below 2^64, the disk below 2^32, the number modulo that."""


def philox(a: int, b: int, c: int, d: int, key: int, second: int) -> tuple[int, int, int, int]:
    """Four words of 32 bits from a counter of four and a key of two."""
    for _ in range(ROUNDS):
        one, other = FIRST * a, SECOND * c
        a, b, c, d = ((other >> 32) & WORD) ^ b ^ key, other & WORD, ((one >> 32) & WORD) ^ d ^ second, one & WORD
        key, second = (key + GOLDEN) & WORD, (second + ROOT) & WORD
    return a, b, c, d


def uniform(key: Key, place: int) -> float:
    """The number at a place of the sequence of a key: a multiple of 2^-53 from 0 to below 1."""
    seed, disk, number = key
    a, b, c, d = philox(place >> 1, number & WORD, disk, 0, seed & WORD, (seed >> 32) & WORD)
    high, low = (c, d) if place & 1 else (a, b)
    return ((high >> 5) * 67108864.0 + (low >> 6)) * 2.0**-53


def exponential(key: Key, place: int) -> tuple[float, int]:
    """(number of mean 1, the next place): a whole number of failures, and a first uniform number whose falling run is odd."""
    whole = 0.0
    while True:
        first = last = uniform(key, place)
        place += 1
        odd = True
        following = uniform(key, place)
        while following < last:
            last, odd = following, not odd
            place += 1
            following = uniform(key, place)
        place += 1
        if odd:
            return whole + first, place
        whole += 1.0


def normals(key: Key, place: int) -> tuple[float, float, int]:
    """(two independent standard normal numbers, the next place): a direction, times the root of twice an exponential one."""
    while True:
        x, y = 2.0 * uniform(key, place) - 1.0, 2.0 * uniform(key, place + 1) - 1.0
        place += 2
        square = x * x + y * y
        if 0.0 < square < 1.0:
            break
    energy, place = exponential(key, place)
    stretch = sqrt((2.0 * energy) / square)
    return x * stretch, y * stretch, place


def flux(key: Key) -> tuple[float, float, float]:
    """What comes through a hole of a gas: the speeds across it, along it, and of a freedom that does not matter.

    Each is over its thermal speed.  The first has the density v exp(-v^2 / 2), the others are normal.
    """
    energy, place = exponential(key, 0)
    along, other, _ = normals(key, place)
    return sqrt(2.0 * energy), along, other
