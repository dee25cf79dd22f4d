"""The Python module: what it returns is what the command line prints, to the bit. `make python` installs it and runs these."""

import ast
import contextlib
import io
import json
import multiprocessing
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT
from first_run import RECORD

fr = pytest.importorskip("flexible_rocking", reason="flexible_rocking is not installed: `make python` does it")
import python_module  # noqa: E402
from flexible_rocking import formats  # noqa: E402

pytestmark = pytest.mark.heavy

PACOIMA = {"time_scale": 0.2, "scale": 1.45}
OPTIONS = [part for name, value in PACOIMA.items() for part in (f"--{name.replace('_', '-')}", str(value))]


@pytest.fixture(scope="module")
def ground():
    return fr.Record.read(RECORD, **PACOIMA)


@pytest.fixture(scope="module")
def run(ground):
    return fr.simulate(fr.Structure(preset="mcmanus"), ground)


@pytest.fixture
def said(exporter, tmp_path):
    """What a command says."""
    def run(*arguments):
        done = subprocess.run([exporter, *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else done.stderr.removeprefix("error: ").strip()

    return run


def test_everything_is_typed_and_works(tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    python_module.use_all(tmp_path)
    command = [sys.executable, "-m", "mypy", "--strict", "tests/python_module.py", "python/flexible_rocking"]
    checked = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout


def test_the_stub_has_the_names_of_the_tables():
    stub = ast.parse((ROOT / "python/flexible_rocking/_native.pyi").read_text())
    typed = {of.name: [each.target.id for each in of.body if isinstance(each, ast.AnnAssign)]
             for of in stub.body if isinstance(of, ast.ClassDef)}
    known = lambda refused: re.search("these are known: (.*)", str(refused.value))[1].split(", ")
    with pytest.raises(ValueError) as refused:
        fr.Structure(none=1)
    assert typed["_Numbers"] == known(refused)
    assert all(re.search(rf"\b{name}\b", fr.Structure.__doc__) for name in typed["_Numbers"])
    with pytest.raises(ValueError) as refused:
        fr.simulate(fr.Structure(preset="evison"), duration=1, none=1)
    assert typed["_InitialValues"] == known(refused)
    assert all(re.search(rf"\b{name}\b", fr.simulate.__doc__) for name in typed["_InitialValues"])


def test_a_run_prints_what_the_command_line_prints(run, said):
    text = said("simulate", "--record", RECORD, *OPTIONS).splitlines()
    assert str(run).splitlines()[1:] == text[1:]
    validity = json.loads(said("simulate", "--record", RECORD, *OPTIONS, "--format", "json"))["validity"]
    assert {name: of.limit for name, of in run.validity.items()} == {of["name"]: of["limit"] for of in validity}


def test_the_motion_between_samples_is_the_command_lines(run, said, tmp_path):
    said("simulate", "--record", RECORD, *OPTIONS, "--interval", "0.001", "-o", "response.csv")
    table = pd.read_csv(tmp_path / "response.csv")
    table = table[table["time[s]"] <= run.end]
    order = np.random.default_rng(1).permutation(len(table))
    response = run.at(table["time[s]"].to_numpy()[order])
    for heading in table:
        name = heading.partition("[")[0]
        assert np.array_equal(response[name], table[heading].to_numpy()[order]), name


def test_a_constant_vertical_acceleration_is_more_weight():
    pier = fr.Structure(preset="mcmanus")
    along = fr.pulse("sine", amplitude=0.6, frequency=2)
    lifted = fr.Record(along.time, along.a_g, np.full(len(along), 0.25 * pier.g))
    assert pickle.loads(pickle.dumps(lifted)) == lifted
    found = fr.simulate(pier, lifted, duration=along.duration)
    expected = fr.simulate(pier.replace(g=1.25 * pier.g), along, duration=along.duration)
    assert len(found.transitions) == len(expected.transitions) > 0
    assert found.peaks["theta"].value == pytest.approx(expected.peaks["theta"].value, rel=1e-9)


def test_the_pushover_is_the_command_lines(run, said, tmp_path):
    said("pushover", "--points", 50, "-o", "curve.csv")
    table = pd.read_csv(tmp_path / "curve.csv").rename(columns=lambda heading: heading.partition("[")[0])
    found = pd.DataFrame(run.structure.pushover(50))
    assert np.array_equal(found, table[list(found)])


def test_the_modes_are_those_of_the_state(run):
    """Eq 16: together they are the rotation, and the vibration mode is the share chi of the strut's."""
    response = run.at(np.linspace(run.start, run.end, 1000))
    modes, structure = run.structure.modes(response), run.structure
    rocks = np.char.startswith(np.array(response["phase"], dtype=str), "rocking")
    assert 100 < rocks.sum() < 1000 and all(np.array_equal(np.isfinite(mode), rocks) for mode in modes.values())
    assert (modes["q_r"] + modes["q_u"])[rocks] == pytest.approx(response["theta"][rocks], rel=1e-14)
    assert structure.H * modes["q_u"][rocks] == pytest.approx(-structure.chi * response["u"][rocks], rel=1e-14)


def test_a_fall_ends_the_motion_and_rest_goes_on():
    fallen = fr.simulate(fr.Structure(preset="mcmanus"), duration=60, theta_0=0.3)
    response = fallen.at([fallen.end + 1, 0, fallen.end])
    assert fallen.overturned and fallen.fall == 0 and np.isnan(response["theta"][0]) and response["transitions"][0] == 1
    assert list(response["theta"][1:]) == [0.3, pytest.approx(np.pi / 2)] and response["phase"][2] == "overturned"
    stands = fr.simulate(fr.Structure(preset="evison"), fr.pulse("sine", amplitude=0.2, frequency=4))
    assert abs(stands.at([stands.end + 5])["u"][0]) < abs(stands.at([stands.end])["u"][0])


@pytest.mark.parametrize("arguments, options", [
    ({"r": 2}, ["--r", 2]), ({"weight": 2, "m": 200}, ["--weight", 2, "--m", 200]), ({"B": -1}, ["--B", -1]),
    ({"p_l": 9}, ["--p-l", 9]), ({"J0": float("nan")}, ["--J0", "nan"]),
])
def test_what_is_refused_has_the_command_lines_text(said, arguments, options):
    with pytest.raises(ValueError) as refused:
        fr.Structure(preset="mcmanus", **arguments)
    assert str(refused.value) == said("describe", "--preset", "mcmanus", *options)


@pytest.mark.parametrize("refused, text", [
    (lambda ground: fr.Record([0, 1], [[0, 1], [1, 0]]), "a_g has the shape [2, 2]: one dimension is needed"),
    (lambda ground: fr.Record([0, 1], [0, float("nan")]), 'acceleration[1] = NaN m/s² is not finite'),
    (lambda ground: fr.Record([0, 1], [0]), "2 time(s) and 1 acceleration(s) instead of as many of each"),
    (lambda ground: fr.Record(0.0, [0, 1]), "dt = 0 is out of range: a finite number greater than 0 is needed"),
    (lambda ground: fr.Record(0.1, ["a", "b"]), "a_g: could not convert string to float"),
    (lambda ground: fr.Structure(preset="mcmanus", r="high"), "r = 'high': it is no number"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus")), "record and duration are missing"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground, detail="fine"), 'detail = "fine" is unknown; these'),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground, tolerance=1), "tolerance = 1 is out of range"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground, theta_0=9), "theta_0 = 9 rad is out of range"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground).validity_within(tension=-1), "tension = -1 is out of range"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground).at([0, -1]), "times[1] = -1 s is out of range"),
    (lambda ground: fr.sweep([], ground), 'structures "structures" is empty: give one or more'),
    (lambda ground: fr.sweep(fr.Structure(preset="mcmanus"), [ground, ground]), "two ground motions have the name"),
    (lambda ground: fr.sweep(fr.Structure(preset="mcmanus"), ground, intensity="PGD"), "intensity = 'PGD' is unknown"),
    (lambda ground: fr.sweep(fr.Structure(preset="mcmanus"), ground, path="/dev/full"), "/dev/full: rows need a file"),
    (lambda ground: fr.advise(fr.Structure(preset="mcmanus"), ground, within=5), "within = 5 is out of range"),
])
def test_what_is_refused_is_named(ground, refused, text):
    with pytest.raises(ValueError) as error:
        refused(ground)
    assert text in str(error.value)


def test_a_file_says_what_would_help(tmp_path):
    (tmp_path / "column.txt").write_text("0.1\n0.2\n-0.1\n")
    with pytest.raises(ValueError, match="give it in seconds as dt"):
        fr.Record.read(tmp_path / "column.txt")
    with pytest.warns(UserWarning, match="a step of 0.5 s: is the time in another unit"):
        fr.Record.read(tmp_path / "column.txt", dt=0.5)
    with pytest.raises(ValueError, match="this would overwrite the input"):
        fr.export(tmp_path / "column.txt", fr.Structure(preset="mcmanus"), record=tmp_path / "column.txt")


def test_a_tendon_has_the_peak_of_its_force(ground):
    peaks = fr.simulate(fr.Structure(preset="mcmanus", P_0=500, k_t=2e5), ground).peaks
    assert peaks["P_t"].value == pytest.approx(500 + 4e5 * 0.285 * np.sin(peaks["theta"].value / 2), rel=1e-12)


def test_threads_and_processes_give_the_same_bits(run, ground):
    structures = [run.structure.replace(f_fc=f) for f in (2, 4, 8, 16)]
    expected = [pickle.dumps(fr.simulate(structure, ground).at(ground.time)["theta"]) for structure in structures]
    with ThreadPoolExecutor() as threads:
        assert list(threads.map(_history, structures, [ground] * 4)) == expected
    with multiprocessing.get_context("spawn").Pool(2) as processes:
        assert processes.starmap(_history, [(structure, ground) for structure in structures]) == expected


def _history(structure, ground):
    return pickle.dumps(pickle.loads(pickle.dumps(fr.simulate(structure, ground))).at(ground.time)["theta"])


def test_a_sweep_goes_on_where_the_command_line_was(exporter, tmp_path):
    ground = fr.pulse("sine", amplitude=0.6, frequency=2)
    ground.write(tmp_path / "sine.csv")
    (tmp_path / "sweep.toml").write_text("records = ['sine.csv']\nscale = { from = 0.5, to = 2, count = 7 }\n"
                                         "[[structures]]\nname = 'piers'\npreset = 'mcmanus'\nvary.f_fc = [2, 4]\n")
    subprocess.run([exporter, "sweep", "sweep.toml", "-o", "rows.csv", "--quiet"], cwd=tmp_path, check=True, capture_output=True)
    before = (tmp_path / "rows.csv").read_bytes()
    piers = [fr.Structure(preset="mcmanus", f_fc=f) for f in (2, 4)]
    motions = {"sine.csv": fr.Record.read(tmp_path / "sine.csv")}
    table = fr.sweep({"piers": piers}, motions, scale=np.linspace(0.5, 2, 7), path=tmp_path / "rows.csv")
    assert (tmp_path / "rows.csv").read_bytes() == before
    pd.testing.assert_frame_equal(table, fr.sweep({"piers": piers}, motions, scale=np.linspace(0.5, 2, 7), threads=1))
    assert list(table["f_fc[Hz]"]) == [2] * 7 + [4] * 7 and list(table["scale"][:7]) == list(np.linspace(0.5, 2, 7))
    alone = fr.simulate(piers[1], motions["sine.csv"].scaled(0.5))
    assert table["peak_theta[rad]"][7] == alone.peaks["theta"].value


def test_a_sweep_that_is_stopped_keeps_its_rows(tmp_path):
    script = ("import flexible_rocking as fr, numpy as np, sys\n"
              "try:\n"
              "    pulse = fr.pulse('sine', amplitude=0.6, frequency=2)\n"
              "    fr.sweep(fr.Structure(preset='mcmanus'), pulse, scale=np.linspace(0.1, 1, 1000000), progress=True)\n"
              "except KeyboardInterrupt as stopped:\n"
              "    print(len(stopped.table), set(stopped.table['ending']))\n")
    command = ["env", "--default-signal=INT", sys.executable, "-c", script]  # where the tests run in the background it is ignored
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as sweep:
        while not re.search("[1-9][0-9]* of", sweep.stderr.read(8)):
            pass
        time.sleep(0.2)
        sweep.send_signal(signal.SIGINT)
        printed, _ = sweep.communicate(timeout=60)
    assert re.fullmatch(r"[1-9]\d+ \{.*'at rest'.*\}\n", printed), printed


def test_the_fragility_is_the_command_lines(exporter, tmp_path):
    for frequency in (1.5, 2, 2.5, 3, 4):
        fr.pulse("cosine", amplitude=0.5, frequency=frequency).write(tmp_path / f"{frequency}.csv")
    (tmp_path / "sweep.toml").write_text("records = ['*.csv']\nscale = { from = 0.3, to = 3, count = 10 }\nintensity = 'S_a'\n"
                                         "[limits]\n'theta/alpha_cg' = [0.1]\n"
                                         "[[structures]]\nname = 'piers'\npreset = 'mcmanus'\nvary.f_fc = [4, 8]\n")
    command = [exporter, "sweep", "sweep.toml", "-o", "rows", "--quiet", "--format", "json"]
    printed = json.loads(subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout)
    motions = {path.name: fr.Record.read(path) for path in sorted(tmp_path.glob("*.csv"))}
    table = fr.sweep({"piers": [fr.Structure(preset="mcmanus", f_fc=f) for f in (4, 8)]}, motions,
                     scale=np.linspace(0.3, 3, 10), intensity="S_a")
    for expected in printed:
        found = fr.fragility(table, expected["limit"])
        assert [found.median, found.dispersion] == pytest.approx([expected["median"], expected["dispersion"]], rel=1e-12)
        assert found.curve.median_range == pytest.approx((expected["median_from"], expected["median_to"]), rel=1e-12)
        assert found.bins.to_dict("records") == [pytest.approx(of, rel=1e-12) for of in expected["bins"]]


def test_the_sweep_on_dask_comes_to_the_same(tmp_path):
    (tmp_path / "out").mkdir()
    shutil.copy(RECORD, tmp_path / "out")
    command = [sys.executable, ROOT / "examples" / "fragility_dask.py"]
    printed = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    found = pd.read_csv(tmp_path / "fragility_dask.csv")
    piers = [fr.Structure(preset="mcmanus", f_fc=f_fc) for f_fc in (2, 4, 8)]
    expected = fr.sweep({"piers": piers}, {RECORD.name: fr.Record.read(RECORD, time_scale=0.2)}, scale=np.linspace(0.2, 2, 10))
    pd.testing.assert_frame_equal(found, expected, check_exact=True)
    assert printed.startswith(f"{sum(expected['ending'] == 'overturned')} of 30 overturned")


def test_formats_read_back(tmp_path):
    pulses = {f"{f} Hz": fr.pulse("sine", amplitude=0.5, frequency=f) for f in (1.0, 1.5, 2.0, 3.0)}
    runs = fr.sweep(fr.Structure(preset="mcmanus"), pulses, scale=np.linspace(0.2, 3, 15), intensity="S_a")
    states = {"slight": fr.fragility(runs, "theta/alpha_cg >= 0.05"), "fallen": fr.fragility(runs)}
    formats.write_pelicun(tmp_path / "piers.csv", {"pier": states.values()}, period=0.2)
    row = pd.read_csv(tmp_path / "piers.csv", index_col="ID").loc["pier"]
    assert [row["Demand-Type"], row["Demand-Unit"], row["LS2-Family"]] == ["Peak Spectral Acceleration|0.20", "g", "lognormal"]
    assert [row[f"LS{i}-Theta_{j}"] for i in (1, 2) for j in (0, 1)] == [
        number for of in states.values() for number in (of.median, of.dispersion)]
    for levels in (None, [0.5, 1.0, 2.0]):
        formats.write_openquake(tmp_path / "piers.xml", {"pier": states}, levels=levels, period=0.2)
        name = {"": "http://openquake.org/xmlns/nrml/0.5"}
        function = ElementTree.parse(tmp_path / "piers.xml").find("fragilityModel/fragilityFunction", name)
        imls = function.find("imls", name)
        numbers = lambda of: [float(number) for number in of.text.split()]
        assert imls.get("imt") == "SA(0.2)"
        for state, of in zip(function.findall("poes", name), states.values(), strict=True):
            counted = (of.bins["exceedances"] / of.bins["known"]).tolist()
            assert numbers(imls) == (levels or of.bins["mean"].tolist())
            assert numbers(state) == (of.probability(levels).tolist() if levels else counted)


def test_the_page_prints_what_it_shows(tmp_path, monkeypatch):
    """WRITE_PAGE=1 writes what is printed into it."""
    page = ROOT / "docs" / "howto" / "python.md"
    text = page.read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    names = {}

    def with_output(block):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(block[1], names)
        return f"```py\n{block[1]}```\n\n```text\n{printed.getvalue().rstrip()}\n```\n"

    shown = re.sub(r"```py\n(.*?)```\n\n```text\n.*?```\n", with_output, text, flags=re.DOTALL)
    if os.environ.get("WRITE_PAGE"):
        page.write_text(shown, encoding="utf-8")
    assert shown == text
