"""The reference integration itself, held against the published numbers and against its own tolerance."""

from dataclasses import replace

import numpy as np
import pytest
import reference
from host import G, pacoima, peak
from reference import EVISON, MCMANUS


def test_derived_quantities():
    for p, numbers in [
        (EVISON, dict(J_P=152.488, p_l=2.9151, alpha_cg=0.35122, chi=0.90954, f_u=36.574, u_cr=0.752467e-3)),
        (MCMANUS, dict(J_P=467.046, p_l=2.24234, alpha_cg=0.22868, chi=0.94309, f_u=20.959, u_cr=2.313480e-3)),
    ]:
        for name, number in numbers.items():
            assert getattr(p, name) == pytest.approx(number, rel=2e-5), name


def test_evison_free_vibration():
    time = np.concatenate([np.linspace(0, 1.33, 1331), np.linspace(1.33, 1.34, 1001), np.linspace(1.34, 2, 661)])
    time = np.unique(time)
    response = reference.integrate(EVISON, time, np.zeros_like(time), (EVISON.u_cr, 0, 0.04, 0))
    impacts = [f"{instant:.9f}" for instant in response.times("impact")[:6]]
    assert impacts == ["0.168487319", "0.486378723", "0.783968665", "1.062370970", "1.321721172", "1.562668213"]
    largest = np.argmax(np.abs(response.a_t))
    assert f"{abs(response.a_t[largest]) / G:.5f}" == "0.92061"
    assert response.t[largest] == pytest.approx(1.3349, abs=1e-4)


def test_mcmanus_under_pacoima_dam():
    time, a_g = pacoima("pul164")
    response = reference.integrate(MCMANUS, time, a_g, per_sample=10)
    theta = peak(response.t, response.theta, response.theta_dot)
    too_wide_to_lift = reference.integrate(replace(MCMANUS, B=100.0), time, a_g, per_sample=10)
    assert f"{np.max(np.abs(a_g)) / G:.4f}" == "1.7676"
    assert f"{np.max(np.abs(too_wide_to_lift.a_t)) / G:.3f}" == "2.098"
    assert f"{np.max(np.abs(response.a_t)) / G:.5f}" == "0.53823"
    assert f"{theta:.8f}" == "0.01200009"
    assert f"{2 * MCMANUS.B * np.sin(theta) * 1e3:.5f}" == "6.83989"
    assert f"{response.times('uplift')[0]:.6f}" == "0.539955"
    assert f"{response.times('impact')[0]:.6f}" == "0.740986"
    assert len(response.transitions) == 31


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
