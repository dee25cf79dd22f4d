"""The FMU against the independent integration of reference.py, on real records and in free vibration."""

from dataclasses import dataclass, fields

import numpy as np
import pytest
import reference
from host import ground_motion, pacoima
from reference import EVISON, MCMANUS, Structure

PIER = Structure(m=1e5, m0=5e4, H=8.0, B=1.5, J0=4e4, f_fc=2.0, zeta_fc=0.05, r=0.85, c_ratio=0.4)
DEFAULT = None
NEAR_A_TRANSITION = 1e-6  # s; a_t jumps at a landing, and its instant is known to the tolerance only


@dataclass
class Scene:
    """A structure and what it goes through."""

    structure: Structure
    time: np.ndarray
    a_g: np.ndarray
    initial: tuple = (0.0, 0.0, 0.0, 0.0)


SCENES = {
    "free vibration": lambda: Scene(EVISON, np.linspace(0, 2.5, 1251), np.zeros(1251), (EVISON.u_cr, 0, 0.04, 0)),
    "Pacoima Dam 164": lambda: Scene(MCMANUS, *pacoima("pul164")),
    "Pacoima Dam 254": lambda: Scene(MCMANUS, *pacoima("pul254")),
    "El Centro 180, small": lambda: Scene(
        MCMANUS, *ground_motion("imperialValley_elCentro_1940", "elc180", time_scale=5, scale=1.75)),
    "El Centro 180, pier": lambda: Scene(PIER, *ground_motion("imperialValley_elCentro_1940", "elc180", scale=1.5)),
    "Corralitos 000": lambda: Scene(EVISON, *ground_motion("lomaPrieta_corralitos_1989", "cls000")),
}


@pytest.fixture(scope="module", params=SCENES)
def solved(request):
    """A scene and its reference."""
    scene = SCENES[request.param]()
    return scene, reference.integrate(scene.structure, scene.time, scene.a_g, scene.initial)


def differences(exact, other) -> dict[str, float]:
    """max|difference|/max|exact| of the motion and, away from transitions, of a_t."""
    away = np.ones(len(exact.t), dtype=bool)
    for transition in exact.transitions:
        away &= np.abs(exact.t - transition.time) > NEAR_A_TRANSITION
    result = {}
    for name, where in (*((name, slice(None)) for name in ("theta", "u", "delta_t", "v_t", "uplift")), ("a_t", away)):
        a, b = getattr(exact, name), getattr(other, name)
        result[name] = float(np.max(np.abs(a - b)[where]) / np.max(np.abs(a)))
    return result


@pytest.mark.parametrize(("tolerance", "limit"), [(DEFAULT, 1e-6), (1e-11, 1e-9)], ids=["default", "1e-11"])
def test_response(solved, tolerance, limit, mcmanus):
    scene, exact = solved
    start = {field.name: getattr(scene.structure, field.name) for field in fields(scene.structure)}
    start |= dict(zip(("u_0", "u_dot_0", "theta_0", "theta_dot_0"), scene.initial))
    with mcmanus.start(tolerance=tolerance, **start) as instance:
        rows = instance.follow(scene.time, scene.a_g).view(np.recarray)
        events = instance.events
    assert [event.kind for event in events] == [transition.kind for transition in exact.transitions], (
        first_difference(events, exact.transitions))
    instants = [transition.time for transition in exact.transitions]
    np.testing.assert_allclose([event.time for event in events], instants, rtol=limit)
    for name, error in differences(exact, rows).items():
        assert error <= limit, f"{name}: relative error {error:.1e} > {limit:.0e}"
    np.testing.assert_allclose(rows.V_t, scene.structure.m * rows.a_t, rtol=1e-14)
    np.testing.assert_allclose(rows.M_t, scene.structure.H * rows.V_t, rtol=1e-14)


def first_difference(events, transitions) -> str:
    for event, transition in zip(events, transitions):
        if event.kind != transition.kind:
            return f"{event.kind} at {event.time} s, not {transition.kind} at {transition.time} s"
    longer = max(events, transitions, key=len)[min(len(events), len(transitions))]
    return f"{longer.kind} at {longer.time} s in one alone"
