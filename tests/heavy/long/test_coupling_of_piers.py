"""The bridge of test_coupling.py through uplifts and impacts, and masters that iterate less."""

import numpy as np
import pytest
from evidence.coupling import bridge_model_exchange, convergence, stability
from evidence.coupling.bridge import Bridge, deck, linear, pier, simulate
from evidence.coupling.masters import MASTERS, TOLERANCE, extrapolate
from reference import EVISON, MCMANUS
from test_coupling import A_G, TIME, as_one, piers, strong_motion  # noqa: F401


def test_iterated_master_follows_uplifts_impacts_and_landings(piers):
    """Fourth order through them, to 1e-8 of every peak."""
    time, a_g, expected = as_one(strong_motion)
    for transitions in expected.transitions:
        assert {transition.kind for transition in transitions} == {"uplift", "impact", "landing"}
    halved = "the same, steps with transitions halved"
    found = [convergence.cosimulated(time, a_g, piers, deck(), halved, n) for n in (1, 2, 4)]
    errors = [convergence.error(response, convergence.columns(expected)) for response in found]
    assert errors[2] < 1e-8
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(4, abs=0.4)


def test_accelerated_iterations_find_the_fixed_point_in_fewer_sweeps(piers):
    """A stiff and heavy deck: a sweep leaves the sixth part of an error, as the linear bridge tells."""
    left = stability.contraction(3000.0 / (MCMANUS.m + EVISON.m), TIME[1], False, frequency=25.0)
    assert left == pytest.approx(1 / 6, rel=0.1)
    for h in (0.05e-3, TIME[1]):  # the estimate for short steps
        k, c, m = deck(3000.0, 25.0).k / 2, deck(3000.0, 25.0).c / 2, EVISON.m
        contraction = stability.contraction(3000.0 / (MCMANUS.m + EVISON.m), h, True, frequency=25.0)
        assert contraction == pytest.approx(k * h**2 / (15.5 * m) + c * h / (3.5 * m), rel=0.1)
    found, sweeps = {}, {}
    for name in ("fixed-point", "anderson", "iqn-ils"):
        master, of_deck = MASTERS[name](), deck(3000.0, frequency=25.0)
        bridge = Bridge([pier(fmu) for fmu in piers], of_deck, linear(TIME, A_G))
        found[name] = simulate(bridge, master, extrapolate, TIME[:300], 1, lambda: [of_deck.x, *bridge.y[1]])
        sweeps[name] = master.sweeps / 299
    for name in ("anderson", "iqn-ils"):
        assert convergence.error(found[name], found["fixed-point"]) < 1e-9
    assert sweeps["fixed-point"] == pytest.approx(np.log(TOLERANCE) / np.log(left), rel=0.2)
    assert sweeps["anderson"] < 7
    assert sweeps["iqn-ils"] < 3


def test_one_solver_over_bridge_and_piers_in_model_exchange(piers):
    """As near as its tolerance, over every transition of the independent integration."""
    time, _, expected = as_one(strong_motion)
    errors = []
    for tolerance, longest_step in ((1e-4, 0.0), (1e-8, 0.0), (1e-10, 0.2e-3)):
        found, system = bridge_model_exchange.response(piers, deck(), tolerance, time, longest_step)
        errors.append(convergence.error(found, convergence.columns(expected)))
    assert system.transitions() == sum(map(len, expected.transitions)) > 20
    loose, tight, tightest = errors
    assert tightest < 1e-6 < tight < 1e-4 < loose < 0.3
