"""The page of the literature: the model against the closed forms."""

import pytest

from evidence.literature import overturning
from evidence.literature.slender_block import ONE_SINE, boundaries


def test_the_extrapolated_boundaries_are_the_closed_forms():
    """One sine at omega = 4 p: after an impact and without."""
    first, _, last = boundaries(ONE_SINE, 4, overturning.R, 6, step=0.02)
    for of in (first, last):
        case = overturning.Case(ONE_SINE, 4, of)
        assert case.rate == pytest.approx(2, abs=0.02)
        assert case.error < 1e-6
        assert abs(case.differences[-1]) > 1e-6, "the extrapolation has something to do"
        assert case.impacts == of.impacts
