"""Chance in laws: the published test vectors of the generator, and the distributions of the samplers."""

import math

import numpy as np
import pytest

from eventsim.formulas.chance import WORD, exponential, flux, normals, philox, uniform

COUNT = 40_000
"""Numbers that are drawn: a mean is within four bars of 1 / sqrt(COUNT) but once in 16,000 tests, and the seed is fixed."""

VECTORS = [
    ((0, 0, 0, 0), (0, 0), "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
    ((WORD,) * 4, (WORD,) * 2, "408f276d 41c83b0e a20bc7c6 6d5451fd"),
    (
        (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
        (0xA4093822, 0x299F31D0),
        "d16cfe09 94fdcceb 5001e420 24126ea1",
    ),
]
"""Philox4x32-10, counter and key: kat_vectors of Random123, https://github.com/DEShawResearch/random123."""


@pytest.mark.parametrize(("counter", "key", "words"), VECTORS)
def test_the_generator_gives_the_published_words(counter, key, words):
    assert philox(*counter, *key) == tuple(int(word, 16) for word in words.split())


def test_a_uniform_number_is_made_of_two_words():
    high, low, *others = philox(0, 7, 3, 0, 5, 1)
    assert uniform((5 + (1 << 32), 3, 7), 0) == ((high >> 5) * 2**26 + (low >> 6)) / 2**53
    assert uniform((5 + (1 << 32), 3, 7), 1) == ((others[0] >> 5) * 2**26 + (others[1] >> 6)) / 2**53


def test_chance_is_a_function_of_seed_disk_and_number():
    found = {flux(key) for key in ((1, 2, 3), (2, 2, 3), (1, 3, 3), (1, 2, 4), (1 + (1 << 32), 2, 3))}
    assert len(found) == 5
    assert flux((1, 2, 3)) in found


def is_like(found, mean, variance):
    """Whether the mean of numbers is what it should be, by their own variance."""
    return abs(float(np.mean(found)) - mean) < 4.0 * math.sqrt(variance / len(found))


def test_exponential_numbers_have_the_moments_and_the_tail_of_their_law():
    found = np.array([exponential((1, 0, k), 0)[0] for k in range(COUNT)])
    for power, variance in ((1, 1.0), (2, 24.0 - 4.0), (3, 720.0 - 36.0)):
        assert is_like(found**power, math.factorial(power), variance)
    for edge in (0.5, 1.0, 3.0):
        share = math.exp(-edge)
        assert is_like(found > edge, share, share * (1.0 - share))


def test_normal_numbers_have_the_moments_of_their_law_and_are_independent():
    x, y = np.array([normals((2, 0, k), 0)[:2] for k in range(COUNT)]).T
    for one in (x, y):
        assert is_like(one, 0.0, 1.0)
        assert is_like(one**2, 1.0, 2.0)
        assert is_like(one**4, 3.0, 105.0 - 9.0)
        assert is_like(one < 1.0, 0.5 * (1.0 + math.erf(math.sqrt(0.5))), 0.2)
    assert is_like(x * y, 0.0, 1.0)
    assert is_like(x**2 * y**2, 1.0, 8.0)


def test_a_flux_has_more_of_the_fast():
    out, along, other = np.array([flux((3, 1, k)) for k in range(COUNT)]).T
    assert np.all(out > 0.0)
    assert is_like(out, math.sqrt(0.5 * math.pi), 2.0 - 0.5 * math.pi)
    assert is_like(out**2, 2.0, 4.0)
    assert is_like(along**2, 1.0, 2.0)
    assert is_like(other**2, 1.0, 2.0)
    assert is_like(out**2 * along**2, 2.0, 20.0)
