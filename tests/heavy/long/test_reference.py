"""The reference integration itself, held against its own tolerance and closed forms."""

import numpy as np
import pytest
import reference
from host import pacoima
from reference import EVISON, MCMANUS


def test_tolerance_no_longer_matters():
    time, a_g = pacoima("pul164")
    coarser, finer = (reference.integrate(MCMANUS, time, a_g, rtol=rtol, atol=1e-3 * rtol) for rtol in (1e-12, 3e-14))
    for name in ("theta", "u"):
        a, b = getattr(coarser, name), getattr(finer, name)
        difference = np.max(np.abs(a - b)) / np.max(np.abs(b))
        assert difference < 1e-12, f"{name} differs by {difference:.1e} between rtol 1e-12 and 3e-14"


def test_two_crossings_within_a_step_are_both_found():
    polynomial = np.polynomial.Polynomial.fromroots([0.3, 0.3001, -2, 3, 4, 5, 6]).coef
    assert reference.unit_roots(polynomial) == pytest.approx([0.3, 0.3001], abs=1e-9)


def test_a_return_to_zero_within_microseconds_is_found():
    """After a slow impact with u = 0 the base falls back at g B (m + m0)/(J0 + (m + m0) B²), here g/B."""
    time = np.array([0.0, 0.01])
    theta_dot = 1e-4
    run = reference.integrate(EVISON, time, np.zeros(2), (0.0, 0.0, -1e-15, theta_dot))
    first, second = run.transitions[:2]
    assert (first.kind, first.side) == ("impact", -1)
    assert second.time - first.time == pytest.approx(2 * EVISON.r * theta_dot * EVISON.B / EVISON.g, rel=1e-3)
