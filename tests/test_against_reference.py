"""The FMU against the independent integrations of reference.py and frames_reference.py, on real records and in free vibration."""

from dataclasses import asdict

import frames_reference
import numpy as np
import pytest
import reference
from frames import Ties, of_one_mass
from host import G, ground_motion, pacoima
from reference import EVISON, MCMANUS, Structure

PIER = Structure(m=1e5, m0=5e4, H=8.0, B=1.5, J0=4e4, f_fc=2.0, zeta_fc=0.05, r=0.85, c_ratio=0.4)
NEAR_A_TRANSITION = 1e-6  # s; a_t jumps at a landing, and its instant is known to the tolerance only
WEIGHT = (MCMANUS.m + MCMANUS.m0) * G
MOVES = ("theta", "u", "delta_t", "v_t", "uplift")
STATE = ("u", "u_dot", "theta", "theta_dot")
SEEN = ("u", "a_t", "u_dot", "theta", "theta_dot", "E_viscous", "P_t", "F_d1", "F_d2", "e_p1", "e_p2", "E_hysteretic")

FREE = {  # structure, time, a_g, initial state, force on the top mass
    "free vibration": lambda: (EVISON, np.linspace(0, 2.5, 1251), np.zeros(1251), (EVISON.u_cr, 0, 0.04, 0)),
    "Pacoima Dam 164": lambda: (MCMANUS, *pacoima("pul164")),
    "Pacoima Dam 254": lambda: (MCMANUS, *pacoima("pul254")),
    "El Centro 180, small": lambda: (
        MCMANUS, *ground_motion("imperialValley_elCentro_1940", "elc180", time_scale=5, scale=1.75)),
    "El Centro 180, pier": lambda: (PIER, *ground_motion("imperialValley_elCentro_1940", "elc180", scale=1.5)),
    "Corralitos 000": lambda: (EVISON, *ground_motion("lomaPrieta_corralitos_1989", "cls000")),
    "Pacoima Dam 164, a neighbour pulls": lambda: (MCMANUS, *pacoima("pul164"), np.zeros(4), 120 * np.sin(7 * pacoima("pul164")[0])),
}
RESTRAINED = {  # of McManus's specimen: ties, and a record with its real vertical component
    "El Centro, vertical alone": (Ties(), "imperialValley_elCentro_1940", "elc180", 800, dict(time_scale=5, scale=1.75)),
    "El Centro, tendon": (Ties(P_0=0.3 * WEIGHT, k_t=2e5), "imperialValley_elCentro_1940", "elc180", 800, dict(scale=3)),
    "Corralitos, dissipators": (Ties(xi_d=0.2, k_d=1e6, F_y=0.15 * WEIGHT), "lomaPrieta_corralitos_1989", "cls000", 900, {}),
    "Pacoima Dam, all": (Ties(0.3 * WEIGHT, 2e5, 0.35, 500.0, 1e6, 0.1 * WEIGHT), "sanFernando_pacoidaDam_1971", "pul164", 1000,
                         dict(scale=5 * 0.29, time_scale=5)),
    "Sylmar, viscous": (Ties(P_0=500.0, xi_d=0.285, c_d=2000.0), "northridge_sylmar_1994", "syl360", 500, dict(scale=20)),
}


def assert_same_transitions(events, transitions, limit):
    assert [event.kind for event in events] == [transition.kind for transition in transitions]
    np.testing.assert_allclose([event.time for event in events], [transition.time for transition in transitions], rtol=limit)


@pytest.fixture(scope="module", params=FREE)
def solved(request):
    """A structure, a_g, F_t and the reference."""
    structure, time, a_g, initial, F_t = (*FREE[request.param](), np.zeros(4), None)[:5]
    F_t = np.zeros(len(time)) if F_t is None else F_t
    return structure, a_g, F_t, reference.integrate(structure, time, a_g, initial, F_t=F_t)


@pytest.mark.parametrize(("tolerance", "limit"), [(None, 1e-6), (1e-11, 1e-9)], ids=["default", "1e-11"])
def test_response(solved, tolerance, limit, mcmanus):
    """The motion, the reactions of the free bodies, and the momentum lost at impacts."""
    structure, a_g, F_t, exact = solved
    start = asdict(structure) | {f"{name}_0": getattr(exact, name)[0] for name in STATE}
    with mcmanus.start(tolerance=tolerance, **start) as instance:
        instance.set(a_g=a_g[0], F_t=F_t[0])
        rows = instance.follow(exact.t, a_g, F_t=F_t).view(np.recarray)
        events = instance.events
    assert_same_transitions(events, exact.transitions, limit)
    instants = np.array([transition.time for transition in exact.transitions])
    away = (np.abs(exact.t[:, None] - instants) > NEAR_A_TRANSITION).all(axis=1)
    expected = {name: getattr(exact, name) for name in MOVES}
    loads = [reference.Load(*acting) for acting in zip(exact.t, a_g, 0 * exact.t, F_t)]
    states = np.column_stack([getattr(exact, name) for name in STATE])
    reactions = [reference.reactions(structure, *each) for each in zip(exact.phase, states, loads)]
    sums = np.cumsum([np.zeros(3), *(reference.impulses(structure, transition) for transition in exact.transitions)], axis=0)
    expected |= dict(zip(("R_h", "R_v", "R_m", "I_h", "I_v", "I_m"), [*np.transpose(reactions), *sums[np.searchsorted(instants, exact.t)].T]))
    expected["a_t"] = exact.a_t + F_t / structure.m * np.cos(exact.theta)
    for name, numbers in expected.items():
        where = slice(None) if name in MOVES else away  # the others jump
        np.testing.assert_allclose(rows[name][where], numbers[where], rtol=0, atol=limit * np.abs(numbers).max(), err_msg=name)
    np.testing.assert_allclose(rows.V_t, structure.m * rows.a_t, rtol=1e-14, atol=1e-15 * np.abs(rows.V_t).max())
    np.testing.assert_allclose(rows.M_t, structure.H * rows.V_t, rtol=1e-14, atol=1e-15 * np.abs(rows.M_t).max())


@pytest.mark.parametrize("scene", RESTRAINED)
def test_response_with_ties_under_both_components(scene, mcmanus):
    """Every transition, of yielding and unloading too, and every number at every sample, to 1e-9."""
    ties, event, component, samples, scales = RESTRAINED[scene]
    (time, a_g), (_, a_v) = (ground_motion(event, which, samples, **scales) for which in (component, "up"))
    exact = frames_reference.simulate(of_one_mass(MCMANUS), time[1], a_g, a_v, ties)
    with mcmanus.start(tolerance=1e-12, **asdict(MCMANUS), **asdict(ties)) as instance:
        rows = instance.follow(time, a_g, SEEN, a_v=a_v)
        events = instance.events
    assert_same_transitions(events, exact.transitions, 1e-9)
    assert len(events) > 10
    for name in SEEN:
        expected = vars(exact)["a" if name == "a_t" else name].reshape(len(time))
        np.testing.assert_allclose(rows[name], expected, rtol=0, atol=1e-9 * max(np.abs(expected).max(), 1e-300), err_msg=name)
