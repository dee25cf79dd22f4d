"""The published numbers, through fmpy."""

import numpy as np
import pytest
from first_run import PACOIMA_DAM
from host import G, simulate
from validation.records import pacoima_dam


@pytest.fixture(scope="module")
def evison_release(evison):
    """Free vibration, released at rest with theta = 0.04 rad and u = u_cr (Fig 5)."""
    with evison.start() as instance:
        u_cr = instance.get("u_cr")
    return simulate(evison, stop_time=2.0, output_interval=2e-5, start_values={"theta_0": 0.04, "u_0": u_cr},
                    output=["a_t"])


@pytest.fixture(scope="module")
def mcmanus_pacoima(mcmanus):
    """The Pacoima Dam record as scaled for the shake table (Fig 9, right)."""
    result, events = simulate(mcmanus, stop_time=4.0, output_interval=4.0, start_values=PACOIMA_DAM | {"peaks": True},
                              output=["theta_max", "uplift_max", "a_t_max", "transitions"])
    return result[-1], events


@pytest.mark.parametrize(
    ("preset", "numbers"),
    [
        ("evison", dict(p_l="2.9151", alpha_cg="0.35122", chi="0.90954", f_u="36.574", u_cr="0.000752467")),
        ("mcmanus", dict(p_l="2.24234", alpha_cg="0.22868", chi="0.94309", f_u="20.959", u_cr="0.002313480")),
    ],
)
def test_derived_quantities(preset, numbers, request):
    with request.getfixturevalue(preset).start() as instance:
        rounded = {name: f"{instance.get(name):.{len(text.partition('.')[2])}f}" for name, text in numbers.items()}
    assert rounded == numbers


def test_evison_impacts(evison_release):
    _, events = evison_release
    impacts = [f"{event.time:.9f}" for event in events if event.kind == "impact"]
    assert impacts[:6] == ["0.168487319", "0.486378723", "0.783968665", "1.062370970", "1.321721172", "1.562668213"]


def test_evison_largest_acceleration(evison_release):
    result, _ = evison_release
    largest = np.argmax(np.abs(result["a_t"]))
    assert f"{abs(result['a_t'][largest]) / G:.5f}" == "0.92061"
    assert result["time"][largest] == pytest.approx(1.3349, abs=1e-4)


def test_pacoima_ground_acceleration():
    _, a_g = pacoima_dam()
    assert f"{np.max(np.abs(a_g)) / G:.4f}" == "1.7676"


def test_pacoima_acceleration(mcmanus_pacoima):
    result, _ = mcmanus_pacoima
    assert f"{result['a_t_max'] / G:.5f}" == "0.53823"


def test_pacoima_rotation_and_uplift(mcmanus_pacoima):
    result, _ = mcmanus_pacoima
    assert f"{result['theta_max']:.8f}" == "0.01200009"
    assert f"{result['uplift_max'] * 1e3:.5f}" == "6.83989"


def test_pacoima_transitions(mcmanus_pacoima):
    result, events = mcmanus_pacoima
    first = {kind: next(event.time for event in events if event.kind == kind) for kind in ("uplift", "impact")}
    assert f"{first['uplift']:.6f}" == "0.539955"
    assert f"{first['impact']:.6f}" == "0.740986"
    assert len(events) == 31
    assert result["transitions"] == 31


def test_pacoima_fixed_base(mcmanus):
    """A base too wide to lift: Eq 1 alone."""
    result, events = simulate(mcmanus, stop_time=4.0, output_interval=4.0, start_values=PACOIMA_DAM | {"B": 100.0, "peaks": True},
                              output=["a_t_max"])
    assert f"{result['a_t_max'][-1] / G:.3f}" == "2.098"
    assert events == []


def test_demand_of_rocking(mcmanus):
    """Second term of Eq 22 with C = 2, in g."""
    with mcmanus.start() as instance:
        chi, alpha_cg = instance.get("chi", "alpha_cg")
    assert f"{3 * chi * np.tan(alpha_cg):.4f}" == "0.6585"
