import numpy as np
import pytest

from synth.geometry import least_values

TOLERANCE = 1e-4


def waves(seed: int, sides: int):
    """Return sums of sines, how fast they can change, and where they are looked at."""
    rng = np.random.default_rng(seed)
    count = 6
    waves = rng.normal(size=(count, 3, sides)) * 4
    phases = rng.uniform(0, 6, (count, 3))

    def f(which, at):
        return np.sin(np.einsum("kws,ks->kw", waves[which], at) + phases[which]).sum(axis=1)

    lower = rng.uniform(-1, 0, (count, sides))
    upper = lower + rng.uniform(0, 1.5, (count, sides)) * rng.integers(0, 2, (count, sides))
    return f, lower, upper, np.abs(waves).sum(axis=1)


@pytest.mark.parametrize("sides", [1, 2])
@pytest.mark.parametrize("seed", range(20))
def test_is_below_all_values_and_near_the_least(seed, sides):
    f, lower, upper, rates = waves(seed, sides)
    least, at = least_values(f, lower, upper, rates, TOLERANCE, ceiling=10.0)
    rng = np.random.default_rng(seed)
    for which in range(len(lower)):
        points = rng.uniform(lower[which], upper[which], (20_000, sides))
        values = f(np.full(len(points), which), points)
        assert least[which] <= values.min()
        assert ((lower[which] <= at[which]) & (at[which] <= upper[which])).all()
        seen = f(np.array([which]), at[which : which + 1])[0]
        assert least[which] == pytest.approx(seen - TOLERANCE)


def test_values_above_the_ceiling_are_not_told_apart():
    f, lower, upper, rates = waves(0, 2)
    least, _ = least_values(f, lower, upper, rates, TOLERANCE, ceiling=-3.5)
    assert (least == -3.5).all()


def test_too_many_cells_still_give_a_bound():
    def flat(which, _at):
        return np.ones(len(which))

    least, _ = least_values(flat, np.zeros((1, 2)), np.ones((1, 2)), np.full((1, 2), 9.0), 1e-9, 10.0)
    assert 0.9 < least[0] < 1.0
