"""Coupled structures by the masters of examples/coupling, against the same systems integrated as one."""

import functools

import monolithic
import numpy as np
import pytest
import reference
from coupling import bridge_ssp, building_on_soil, convergence, one_system, stability
from coupling.bridge import Bridge, deck, linear, pier, simulate
from coupling.building_on_soil import OnSoil
from coupling.masters import MASTERS, TOLERANCE, Diverged, Iterated, between_transitions
from coupling.masters import extrapolate, gauss_seidel, hold, jacobi
from coupling.swaying_mass import SwayingMass
from reference import EVISON, MCMANUS
from validation.records import pacoima_dam

TIME, A_G = pacoima_dam()
SHORT = slice(700)  # of the record: uplifts, impacts and landings of both piers


@pytest.fixture(scope="module")
def piers(mcmanus, evison):
    return mcmanus.path, evison.path


def strong_motion():
    return TIME[SHORT], A_G[SHORT]


@functools.cache
def as_one(motion):
    """The bridge integrated as one system: time, a_g, the response."""
    time, a_g = motion()
    return time, a_g, monolithic.integrate(convergence.monolithic_bridge(deck()), time, a_g)


def test_without_a_deck_the_monolithic_piers_are_the_single_ones():
    alone = monolithic.Bridge((MCMANUS, EVISON), M=1.0, k=0.0, c=0.0)
    together = monolithic.integrate(alone, TIME[SHORT], A_G[SHORT])
    for i, p in enumerate((MCMANUS, EVISON)):
        single = reference.integrate(p, TIME[SHORT], A_G[SHORT])
        assert len(together.transitions[i]) == len(single.transitions) >= 10
        for column, expected in zip(together.y[:, 2 + 4 * i:].T, (single.u, single.u_dot, single.theta)):
            assert column == pytest.approx(expected, abs=1e-11 * np.max(np.abs(expected)))


@pytest.mark.parametrize("variant", convergence.VARIANTS)
def test_error_falls_with_the_step_at_the_masters_order(piers, variant):
    time, a_g, expected = as_one(convergence.smooth)
    assert expected.transitions == [[], []]
    found = [convergence.cosimulated(time, a_g, piers, deck(), variant, n) for n in (2, 4)]
    errors = [convergence.error(response, convergence.columns(expected)) for response in found]
    order = convergence.VARIANTS[variant][-1]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.12)


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


@pytest.mark.parametrize("master, guess", [(jacobi, extrapolate), (gauss_seidel, hold), (gauss_seidel, extrapolate)])
def test_weak_coupling_blows_up_at_the_step_that_theory_gives(piers, master, guess):
    """Free vibration, bases down: it dies out below the limit of the amplification matrix and grows above it."""
    ratio = 10.0
    limit = stability.first_unstable(lambda h: stability.growth(master, guess, ratio, h, False) > 0,
                                   np.geomspace(1e-3, 30e-3, 70))
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


def test_one_solver_over_bridge_and_piers_in_model_exchange(piers):
    """As near as its tolerance, over every transition of the independent integration."""
    time, _, expected = as_one(strong_motion)
    errors = []
    for tolerance, longest_step in ((1e-4, 0.0), (1e-8, 0.0), (1e-10, 0.2e-3)):
        found, system = one_system.response(piers, deck(), tolerance, time, longest_step)
        errors.append(convergence.error(found, convergence.columns(expected)))
    assert system.transitions() == sum(map(len, expected.transitions)) > 20
    loose, tight, tightest = errors
    assert tightest < 1e-6 < tight < 1e-4 < loose < 0.3


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
    step = functools.partial(between_transitions, MASTERS["iqn-ils"]())
    errors = [convergence.error(on_soil(mcmanus.path, 50.0, time, a_g, step, n), expected) for n in (1, 2, 4)]
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


@pytest.mark.parametrize("variant", ["Jacobi, held", "Jacobi, extrapolated"])
def test_ssp_archive_of_the_bridge(piers, exporter, tmp_path, variant):
    """fmpy runs it as what it is: every value handed on after the step."""
    archive, (time, a_g) = tmp_path / "bridge.ssp", strong_motion()
    bridge_ssp.write_archive(archive, time, a_g, exporter)
    result = bridge_ssp.run(archive, time[-1], time[1] / 2, variant == "Jacobi, extrapolated")
    x = convergence.cosimulated(time, a_g, piers, deck(), variant, 2)[1:, 0]
    assert result["deck.x"][1::2] == pytest.approx(x, abs=1e-9 * np.max(np.abs(x)))
