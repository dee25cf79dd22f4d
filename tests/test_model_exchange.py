"""The FMU under solvers of hosts: never below the floor, and the nearer to co-simulation the tighter they are.

docs/evidence/model_exchange.md has three records and all tolerances; these are a few quick ones."""

import numpy as np
import pytest
from evidence.model_exchange.hosts import Scene, co_simulation, dop853, fmpy_cvode, sundae
from evidence.scenes import PACOIMA_DAM

BAND = 1e-9 * 0.23  # rad, of alpha_cg


@pytest.fixture(scope="module")
def scene(mcmanus):
    return Scene("Pacoima Dam", mcmanus.path, tuple(PACOIMA_DAM.items()), 1.99, 0.01)


@pytest.mark.parametrize("host", [fmpy_cvode, sundae])
def test_a_solver_follows_co_simulation_as_close_as_its_tolerance(scene, host):
    exact = co_simulation(scene)
    loose, tight = host(scene, 1e-4), host(scene, 1e-8)
    assert loose.depth <= BAND and tight.depth <= BAND
    assert exact.transitions > 15
    assert tight.transitions == exact.transitions
    assert tight.error(exact) < 1e-4 < loose.error(exact) < 0.3
    assert np.array_equal(tight.rows["phase"], exact.rows["phase"])


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-10])
def test_a_solver_of_one_step_stays_within_its_tolerance_times_the_scenes_amplification(scene, tolerance):
    """The FMU and going over the host's steps add nothing to that."""
    exact, change = co_simulation(scene), 1e-12
    amplification = co_simulation(scene, change).error(exact) / change
    result = dop853(scene, tolerance)
    assert result.error(exact) <= tolerance * amplification
    assert result.depth <= BAND and np.array_equal(result.rows["transitions"], exact.rows["transitions"])
