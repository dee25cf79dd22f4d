"""The example of a model behind the crate of FMI's interfaces: a ball that bounces, against its closed form."""

import numpy as np
import pytest
from conftest import ROOT
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from host import output

G, E, H, REST = 9.81, 0.7, 1.0, 1e-2


@pytest.fixture(scope="module")
def balls(tmp_path_factory):
    """The FMU of the example in FMI 2.0 and 3.0, written as the page says."""
    paths = {version: tmp_path_factory.mktemp("ball") / "BouncingBall.fmu" for version in "23"}
    for version, path in paths.items():
        output("cargo", "run", "--quiet", "--release", "--example", "bouncing_ball", "--", path, version, cwd=ROOT)
    return paths


def closed_form(times, start=0.0):
    """Height and velocity: the n-th flight begins with the speed e^n √(2 g h), the last at rest."""
    speed, begins = E * np.sqrt(2 * G * H), start + np.sqrt(2 * H / G)
    h, v = H - G * (times - start) ** 2 / 2, -G * (times - start)
    while True:
        flies = times >= begins
        speed = speed if speed >= REST else 0.0
        tau = times[flies] - begins
        h[flies], v[flies] = (speed * tau - G * tau**2 / 2, speed - G * tau) if speed else (0.0, 0.0)
        if not speed:
            return h, v
        begins, speed = begins + 2 * speed / G, E * speed


@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("fmi_type", ["CoSimulation", "ModelExchange"])
def test_the_ball_follows_its_closed_form_and_comes_to_rest(balls, version, fmi_type):
    assert validate_fmu(balls[version]) == []
    start = 0.25
    events = {"early_return_allowed": True, "use_event_mode": True} if (version, fmi_type) == ("3", "CoSimulation") else {}
    result = simulate_fmu(balls[version], fmi_type=fmi_type, start_time=start, stop_time=start + 3.5, output_interval=0.01,
                          relative_tolerance=1e-13, record_events=False, output=["h", "v", "bounces"], **events)
    h, v = closed_form(result["time"].copy(), start)
    assert np.abs(result["h"] - h).max() < 1e-12
    flies = (h > 1e-9) | (result["bounces"] == result["bounces"][-1])  # a step that ends at a contact shows v before it
    assert np.abs(result["v"] - v)[flies].max() < 1e-11
    assert result["bounces"][-1] == np.ceil(np.log(REST / np.sqrt(2 * G * H)) / np.log(E))
    assert result["h"][-1] == result["v"][-1] == 0
