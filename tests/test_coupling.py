"""Coupled structures by the masters of evidence/coupling, against the same systems integrated as one."""

import functools

import monolithic
import numpy as np
import pytest
from evidence.coupling import building_on_soil, convergence, stability
from evidence.coupling.bridge import Bridge, deck, linear, pier, simulate
from evidence.coupling.building_on_soil import OnSoil
from evidence.coupling.masters import MASTERS, Diverged, Iterated, extrapolate, gauss_seidel, hold, jacobi
from evidence.coupling.swaying_mass import SwayingMass
from evidence.scenes import pacoima_dam
from reference import MCMANUS

TIME, A_G = pacoima_dam()


@pytest.fixture(scope="module")
def piers(mcmanus, evison):
    return mcmanus.path, evison.path


def strong_motion():
    """Uplifts, impacts and landings of both piers."""
    return TIME[:700], A_G[:700]


@functools.cache
def as_one(motion):
    """The bridge integrated as one system: time, a_g, the response."""
    time, a_g = motion()
    return time, a_g, monolithic.integrate(convergence.monolithic_bridge(deck()), time, a_g)


@pytest.mark.parametrize("variant", convergence.VARIANTS)
def test_error_falls_with_the_step_at_the_masters_order(piers, variant):
    time, a_g, expected = as_one(convergence.smooth)
    assert expected.transitions == [[], []]
    found = [convergence.cosimulated(time, a_g, piers, deck(), variant, n) for n in (2, 4)]
    errors = [convergence.error(response, convergence.columns(expected)) for response in found]
    order = convergence.VARIANTS[variant][-1]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.12)


@pytest.mark.parametrize("master, guess", [(jacobi, extrapolate), (gauss_seidel, hold), (gauss_seidel, extrapolate)])
def test_weak_coupling_blows_up_at_the_step_that_theory_gives(piers, master, guess):
    """Free vibration, bases down: it dies out below the limit of the amplification matrix and grows above it."""
    ratio = 10.0
    limit = stability.first_unstable(master, guess, ratio, np.geomspace(1e-3, 30e-3, 70))
    for part, grows in ((0.9, False), (1.05, True)):
        h = part * limit
        bridge = Bridge([pier(fmu) for fmu in piers], deck(stability.mass(ratio), stability.FREQUENCY),
                        lambda t, h: np.zeros(2), moments=False)
        bridge.deck.v = 1e-6
        size = []
        for n in range(3000):
            master(bridge, n * h, h, guess)
            size.append(np.max(np.abs(bridge.w[1])))
            if not size[-1] < 1.0:
                break
        assert (max(size[-50:]) > max(size[:50])) == grows


@functools.cache
def on_soil_as_one(M: float, motion):
    """McManus's specimen on soil integrated as one system: time, a_g; the foundation's x, theta, u; transitions."""
    time, a_g = motion()
    system = monolithic.OnSoil((MCMANUS,), M, building_on_soil.STIFFNESS, building_on_soil.DAMPING)
    response = monolithic.integrate(system, time, a_g)
    return time, a_g, response.y[:, [0, 4, 2]], response.transitions[0]


def on_soil(fmu, M, time, a_g, step, per_sample, solve_loop=True):
    foundation = SwayingMass(M, building_on_soil.STIFFNESS, building_on_soil.DAMPING)
    structure = building_on_soil.structure(fmu)
    system = OnSoil(structure, foundation, linear(time, a_g), solve_loop)
    return simulate(system, step, extrapolate, time, per_sample,
                    lambda: [foundation.x, *structure.read("theta", "u")])


@pytest.mark.parametrize("M", [20.0, 50.0, 200.0])
def test_a_structure_on_soil_with_the_loop_solved(mcmanus, M):
    """Of second order without iteration, whether the foundation mass is more or less than m0 = 65.4 kg."""
    time, a_g, expected, transitions = on_soil_as_one(M, convergence.smooth)
    assert not transitions
    errors = [convergence.error(on_soil(mcmanus.path, M, time, a_g, gauss_seidel, n), expected) for n in (8, 16)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)


def test_impacts_push_the_soil(mcmanus):
    """Of second order through them, with the steps in which they fall halved."""
    time, a_g, expected, transitions = on_soil_as_one(50.0, strong_motion)
    assert {"impact", "landing"} <= {transition.kind for transition in transitions}
    errors = [convergence.error(on_soil(mcmanus.path, 50.0, time, a_g, MASTERS["halving"](), n), expected) for n in (1, 2, 4)]
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(2, abs=0.3)
    assert errors[2] < 1e-3


def test_passed_around_as_it_is_the_soils_loop_blows_up_at_any_step(mcmanus):
    """Each exchange multiplies an error by m0/M."""
    time, a_g = convergence.smooth()
    for per_sample in (1, 100):
        with pytest.raises(Diverged):
            on_soil(mcmanus.path, 50.0, time, a_g, Iterated(), per_sample, solve_loop=False)
    time, a_g, expected, _ = on_soil_as_one(200.0, convergence.smooth)
    for solve_loop in (False, True):
        found = on_soil(mcmanus.path, 200.0, time, a_g, Iterated(), 4, solve_loop)
        assert convergence.error(found, expected) < 1e-3
