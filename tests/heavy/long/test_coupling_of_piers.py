"""The bridge of test_coupling.py through uplifts and impacts, by a master and by one solver."""

import numpy as np
import pytest
from evidence.coupling import bridge_model_exchange, convergence
from evidence.coupling.bridge import deck
from test_coupling import as_one, piers, strong_motion  # noqa: F401


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
