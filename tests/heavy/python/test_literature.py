"""The page of the literature: its closed forms against integration, the model against the closed forms."""

import pytest
from scipy.integrate import solve_ivp

from evidence.literature import overturning
from evidence.literature.slender_block import HALF_SINE, ONE_COSINE, ONE_SINE, boundaries, follow, half_sine_boundary


def integrated(pulse, omega, r, amplitude):
    """Impacts until the slender block lies (y beyond 5) or has rocked for 25/p after the pulse, and whether it lies."""
    end = pulse.duration(omega)
    t, y, v, s, impacts = pulse.lift_off(omega, amplitude), 0.0, 0.0, 1, 0

    def fall(t, z, s):
        return z[1], z[0] - s + (amplitude * pulse.shape(omega, t)[0] if t < end else 0.0)

    def touches(t, z, s):
        return s * z[0]

    def lies(t, z, s):
        return s * z[0] - 5

    touches.terminal, touches.direction, lies.terminal = True, -1, True
    while t < end + 25:
        stop = end if t < end else end + 25  # the load jumps at the end of the pulse
        found = solve_ivp(fall, (t, stop), (y, v), "DOP853", events=(touches, lies), args=(s,), rtol=1e-11, atol=1e-13)
        t, (y, v) = found.t[-1], found.y[:, -1]
        if found.t_events[1].size:
            return impacts, True
        if found.t_events[0].size:
            impacts, y, v, s = impacts + 1, 0.0, r * v, -s
    return impacts, False


@pytest.mark.parametrize(("pulse", "omega"), [(HALF_SINE, 4), (ONE_SINE, 3), (ONE_SINE, 5), (ONE_COSINE, 2)],
                         ids=lambda value: getattr(value, "name", value))
def test_boundaries_are_those_of_an_integration(pulse, omega):
    """A millionth off a boundary the integration has the fate, and the impacts, of its side."""
    found = list(boundaries(pulse, omega, 0.9, 10, step=0.02))
    assert [of.impacts for of in found] == ([0] if pulse is HALF_SINE else [1, 1, 0])
    for of in found:
        for side in (-1, 1):
            impacts, lies = integrated(pulse, omega, 0.9, of.amplitude * (1 + 1e-6 * side))
            assert lies == ((side == 1) != of.upper), of
            assert not lies or impacts == of.impacts, of


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
