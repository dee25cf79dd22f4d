"""The commands that estimate, push over and split, against formulas written out here and against the FMU."""

import csv
import subprocess

import numpy as np
import pytest
from host import G, simulate
from reference import EVISON, MCMANUS
from validation.records import pacoima_dam


@pytest.fixture(scope="module")
def rocking_fmu(exporter):
    """Runs the executable and returns the lines of the CSV that it prints."""

    def run(*arguments):
        done = subprocess.run([exporter, *map(str, arguments)], check=True, capture_output=True, text=True)
        return list(csv.DictReader(done.stdout.splitlines()))

    return run


def refusal(exporter, *arguments) -> str:
    done = subprocess.run([exporter, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode != 0
    return done.stderr


def values(lines) -> dict[str, float]:
    return {line["name"]: float(line["value"]) for line in lines}


@pytest.fixture(scope="module")
def estimate(rocking_fmu, pacoima_record):
    return values(rocking_fmu("estimate", "--record", pacoima_record, "--format", "csv"))


def test_spectral_acceleration_is_that_of_the_fmu_on_a_fixed_base(estimate, shaken):
    result, _ = simulate(shaken["mcmanus"], stop_time=4.0, output_interval=4.0,
                         start_values={"B": 100.0, "peaks": True}, output=["a_t_max"])
    assert estimate["S_a(T_fc, zeta_fc)"] == pytest.approx(result["a_t_max"][-1], rel=1e-9)
    assert f"{estimate['S_a(T_fc, zeta_fc)'] / G:.4f}" == "2.0982"


def test_demand_is_the_sum_of_its_terms(estimate):
    one_minus_chi, rocking = 1 - MCMANUS.chi, MCMANUS.chi * G * MCMANUS.tan_alpha_cg
    expected = {
        "PGA": np.max(np.abs(pacoima_dam()[1])),
        "T_u": 1 / MCMANUS.f_u,
        "u_ddot_gr": 2 * rocking / one_minus_chi,
        "(1-chi) S_a": one_minus_chi * estimate["S_a(T_u, zeta_u)"],
        "chi g tan": rocking,
        "C chi g tan": 2 * rocking,
        "a_t": one_minus_chi * estimate["S_a(T_u, zeta_u)"] + 3 * rocking,
        "V_t": MCMANUS.m * estimate["a_t"],
        "M_t": MCMANUS.m * MCMANUS.H * estimate["a_t"],
    }
    assert {name: estimate[name] for name in expected} == pytest.approx(expected, rel=1e-12)


def test_effective_frequency_is_equation_14(rocking_fmu):
    amplitudes = [0.01, 0.3, 0.95]
    lines = values(rocking_fmu("estimate", "--preset", "evison", "--amplitudes", "0.01,0.3,0.95", "--format", "csv"))
    expected = [EVISON.p_l / (4 * np.arccosh(1 / (1 - amplitude))) for amplitude in amplitudes]
    assert [lines[f"f_r({amplitude})"] for amplitude in amplitudes] == pytest.approx(expected, rel=1e-12)


def test_without_a_record_the_ground_is_at_rest(rocking_fmu):
    lines = values(rocking_fmu("estimate", "--preset", "evison", "--amplification", "1.4", "--format", "csv"))
    assert lines["a_t"] == pytest.approx(2.4 * EVISON.chi * G * EVISON.tan_alpha_cg, rel=1e-12)
    assert "PGA" not in lines


def test_refusals_name_the_value_and_the_limit(exporter):
    message = refusal(exporter, "estimate", "--amplification", 2.5)
    assert "C = 2.5 is out of range: it must lie between 0 and 2" in message
    assert "between 0 and 1" in refusal(exporter, "estimate", "--amplitudes", "0.5,1.5")
    assert "--record" in refusal(exporter, "estimate", "--scale", 2)


def test_pushover_runs_from_rest_over_uplift_to_overturning(rocking_fmu):
    curve = rocking_fmu("pushover", "--preset", "evison", "--points", 50, "-o", "-")
    contact = [line for line in curve if line["phase"] == "full contact"]
    rocking = [line for line in curve if line["phase"] == "rocking right"]
    assert (len(contact), len(rocking)) == (50, 50)
    assert float(contact[0]["M[N.m]"]) == 0
    assert float(contact[-1]["delta_t[m]"]) == pytest.approx(EVISON.u_cr, rel=1e-15)
    assert float(contact[-1]["M[N.m]"]) == pytest.approx((EVISON.m + EVISON.m0) * G * EVISON.B, rel=1e-12)
    moments = [float(line["M[N.m]"]) for line in rocking]
    assert all(later < earlier for earlier, later in zip(moments, moments[1:]))
    assert abs(moments[-1]) < 1e-9 * moments[0]
    # the last point against Eqs 5 and 6 without a force: k u = m g sin, and the moments of the two weights
    theta, u = float(rocking[-1]["theta[rad]"]), float(rocking[-1]["u[m]"])
    assert EVISON.k * u == pytest.approx(EVISON.m * G * np.sin(theta), rel=1e-12)
    top, foundation = EVISON.B - u - EVISON.H * np.tan(theta), EVISON.B
    assert EVISON.m * top + EVISON.m0 * foundation == pytest.approx(0, abs=1e-10)


def test_modes_add_up_to_the_response(rocking_fmu, tmp_path):
    response = tmp_path / "response.csv"
    rocking_fmu("simulate", "--preset", "evison", "--free", 0.5, "--theta-0", 0.04, "-o", response)
    modes = rocking_fmu("modes", "--preset", "evison", "--response", response, "-o", "-")
    lines = csv.DictReader(response.read_text().splitlines())
    simulated = {line["time[s]"]: line for line in lines if line["phase"].startswith("rocking")}
    assert [line["time[s]"] for line in modes] == list(simulated)
    for line in modes:
        of = simulated[line["time[s]"]]
        assert float(line["q_u[rad]"]) == pytest.approx(-EVISON.p_l**2 / G * float(of["u[m]"]), rel=1e-12)
        total = float(line["q_r[rad]"]) + float(line["q_u[rad]"])
        assert total == pytest.approx(float(of["theta[rad]"]), rel=1e-12, abs=1e-15)
        # Eq 20 differs from the model's own a_t by what the modes neglect, g (theta - chi q_r)
        neglected = G * (float(of["theta[rad]"]) - EVISON.chi * float(line["q_r[rad]"]))
        a_t = float(line["a_t[m/s2]"]) + neglected
        assert a_t == pytest.approx(float(of["a_t[m/s2]"]), abs=2e-4 * G)
