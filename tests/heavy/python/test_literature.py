"""The page of the literature: the closed form of the half sine in two ways, the model against the closed forms."""

import pytest

from evidence.literature import overturning
from evidence.literature.slender_block import HALF_SINE, ONE_SINE, boundaries, follow, half_sine_boundary


@pytest.mark.parametrize("omega", [1.5, 2, 4, 8])
def test_the_half_sine_by_its_one_equation(omega):
    (of,) = boundaries(HALF_SINE, omega, 0.9, 8, step=0.05)
    assert of.amplitude == pytest.approx(half_sine_boundary(omega), rel=1e-13)
    assert follow(HALF_SINE, omega, 0.9, of.amplitude * (1 - 1e-12))[1] < 0


def test_the_extrapolated_boundaries_are_the_closed_forms():
    """One sine at omega = 4 p: after an impact and without."""
    first, _, last = boundaries(ONE_SINE, 4, overturning.R, 6, step=0.02)
    for of in (first, last):
        case = overturning.Case(ONE_SINE, 4, of)
        assert case.rate == pytest.approx(2, abs=0.02)
        assert case.error < 1e-6
        assert abs(case.differences[-1]) > 1e-6, "the extrapolation has something to do"
        assert case.impacts == of.impacts
