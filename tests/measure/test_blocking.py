"""Error bars from block averages."""

import math

import numpy as np
import pytest

from eventsim.measure.blocking import block_average, ratio_average


def correlated(rng, n, memory):
    """A first-order autoregressive series of unit variance: x' = memory x + noise."""
    noise = rng.standard_normal(n) * math.sqrt(1.0 - memory**2)
    series = np.empty(n)
    x = rng.standard_normal()
    for k in range(n):
        x = memory * x + noise[k]
        series[k] = x
    return series


def test_independent_entries_have_the_textbook_error():
    series = np.random.default_rng(1).standard_normal(4096)
    bar = block_average(series)
    assert bar.length <= 4
    # the scatter of a standard error from n blocks is 1 / sqrt(2 n); five of these
    assert bar.error == pytest.approx(1.0 / 64.0, rel=5.0 / math.sqrt(2.0 * bar.blocks))


@pytest.mark.parametrize("memory", [0.5, 0.9, 0.97])
def test_a_correlated_series_has_a_larger_error_and_longer_blocks(memory):
    bar = block_average(correlated(np.random.default_rng(2), 1 << 14, memory))
    # the mean of n entries scatters with variance (1 + memory) / (1 - memory) / n
    expected = math.sqrt((1.0 + memory) / (1.0 - memory) / (1 << 14))
    assert bar.independent
    assert bar.length > 1
    assert bar.error == pytest.approx(expected, rel=5.0 / math.sqrt(2.0 * bar.blocks))


def test_error_bars_cover_the_truth_as_often_as_they_say():
    rng = np.random.default_rng(3)
    inside = 0
    for _ in range(400):
        bar = block_average(correlated(rng, 1024, 0.7))
        inside += abs(bar.mean) <= bar.error
    # 68.3 % of 400, four standard deviations of the binomial (9.3) to either side
    assert 236 <= inside <= 310


def test_a_series_without_end_of_its_correlation_is_told():
    bar = block_average(np.cumsum(np.random.default_rng(4).standard_normal(1024)))
    assert not bar.independent


def test_too_few_entries_have_no_error_bar():
    assert math.isnan(block_average(np.ones(7)).error)


def test_a_ratio_of_sums_knows_that_its_parts_go_together():
    rng = np.random.default_rng(5)
    below = 1.0 + rng.random(1000)
    bar = ratio_average(3.0 * below, below)
    assert bar.mean == pytest.approx(3.0, rel=1e-15)
    assert bar.error < 1e-15


@pytest.mark.parametrize("unit", [-900, -300, 300, 900])
def test_error_bars_scale_exactly_with_the_unit_of_the_series(unit):
    series = correlated(np.random.default_rng(3), 2048, 0.8)
    one, other = block_average(series), block_average(np.ldexp(series, unit))
    assert other == one._replace(mean=math.ldexp(one.mean, unit), error=math.ldexp(one.error, unit))
