"""The Python module returns the numbers that the command line prints, to the bit. `make heavy PARTS=python` installs it and runs these."""

import ast
import contextlib
import copy
import importlib.metadata
import inspect
import io
import json
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import time
from xml.etree import ElementTree

import flexible_rocking as fr
import numpy as np
import pages
import pandas as pd
import pytest
import statsmodels.api as api
from conftest import ROOT
from evidence.scenes import RECORD
from flexible_rocking import formats
from fmpy import simulate_fmu
from scipy import stats

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
    """Runs a command and returns its output or its error."""
    def run(*arguments):
        done = subprocess.run([exporter, *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else done.stderr.removeprefix("error: ").strip()

    return run


def test_the_package_and_the_scripts_of_the_pages_are_typed(tmp_path):
    for page in pages.PAGES:
        (tmp_path / f"of_{page.stem}.py").write_text("".join(script for script, _ in pages.scripts(page.read_text(encoding="utf-8"))))
    for options in (["--strict", "python/flexible_rocking"], ["--check-untyped-defs", "--ignore-missing-imports", tmp_path]):
        checked = subprocess.run([sys.executable, "-m", "mypy", *options], cwd=ROOT, capture_output=True, text=True)
        assert checked.returncode == 0, checked.stdout


def test_the_stub_has_the_names_and_defaults_of_the_module():
    stub = ast.parse((ROOT / "python/flexible_rocking/_native.pyi").read_text()).body
    known = lambda refused: re.search("these are known: (.*)", str(refused.value))[1].split(", ")
    typed = {of.name: [each.target.id for each in of.body if isinstance(each, ast.AnnAssign)] for of in stub if isinstance(of, ast.ClassDef)}
    with pytest.raises(ValueError) as refused:
        fr.Structure(none=1)
    assert typed["_Numbers"] == known(refused)
    with pytest.raises(ValueError) as refused:
        fr.simulate(fr.Structure(preset="evison"), duration=1, none=1)
    assert [*typed["_InitialValues"], "detail", "tolerance", "duration", "condition"] == known(refused)
    units = {of.target.id: unit.value.value for each in stub if isinstance(each, ast.ClassDef) for of, unit in zip(each.body, each.body[1:])
             if isinstance(of, ast.AnnAssign) and isinstance(unit, ast.Expr) and isinstance(unit.value, ast.Constant)}
    for names, documented in (("_Numbers", fr.Structure), ("_InitialValues", fr.simulate)):
        assert all(re.search(rf"\b{name}\b", documented.__doc__) for name in typed[names])
        assert all(re.search(rf"\b{name} \({re.escape(units[name])}[,)]", documented.__doc__) for name in typed[names] if units.get(name, "1") != "1"), names
    assert {*typed["_Numbers"], "preset", "storeys", "modes", "K"} < {*inspect.signature(fr.Structure).parameters}
    assert not {"Iterable", "Path", "PathLike", "distribution"} & {*dir(fr)}
    defaults = {of.name: dict(zip((each.arg for each in of.args.kwonlyargs), of.args.kw_defaults)) for of in stub if isinstance(of, ast.FunctionDef)}
    for function in (fr.simulate, fr.advise, fr.estimate, fr.pulse):
        for name, shown in inspect.signature(function).parameters.items():
            if default := defaults[function.__name__].get(name):
                assert shown.default == ast.literal_eval(default), name
    assert fr.simulate(fr.Structure(preset="evison"), duration=1).tolerance == inspect.signature(fr.simulate).parameters["tolerance"].default
    assert fr.__version__ == importlib.metadata.version("flexible-rocking")


def test_a_run_prints_what_the_command_line_prints(run, said):
    text = said("simulate", "--record", RECORD, *OPTIONS).splitlines()
    assert str(run).splitlines()[1:] == text[1:]
    validity = json.loads(said("simulate", "--record", RECORD, *OPTIONS, "--format", "json"))["validity"]
    assert {name: of.limit for name, of in run.validity.items()} == {of["name"]: of["limit"] for of in validity}
    assert run.validity_within(friction=0.7)["mu_required"].limit == 0.7


def test_sure_digits_are_the_same_at_each_door(said, tmp_path, ground):
    pier = fr.Structure(preset="mcmanus")
    run = fr.simulate(pier, ground, condition=True)
    told = json.loads(said("simulate", "--record", RECORD, *OPTIONS, "--condition", "--format", "json"))
    assert {of["name"]: of["digits"] for of in told["peaks"]} == {name: peak.digits for name, peak in run.peaks.items()}
    assert run.condition == (told["digits"], told["overturning_digits"], told["overturning_change"])
    assert run.condition.digits == run.peaks["theta"].digits
    assert said("simulate", "--record", RECORD, *OPTIONS, "--condition").splitlines()[1:] == str(run).splitlines()[1:]
    same = pickle.loads(pickle.dumps(run))
    assert (same, same.condition, same.peaks["u"].digits) == (run, run.condition, run.peaks["u"].digits)
    usual = fr.simulate(pier, ground)
    assert (usual.condition, usual.peaks["u"].digits, usual.peaks) == (None, None, run.peaks)
    ground.write(tmp_path / "ground.csv")
    (tmp_path / "sweep.toml").write_text("records = ['ground.csv']\ncondition = true\n[[structures]]\nname = 'structures'\npreset = 'mcmanus'\n")
    assert "sure digits    fewer than two in 0 of 1 runs (0.000 %)\n" in said("sweep", "sweep.toml", "-o", "rows.csv")
    for validity in (False, True):
        table = fr.sweep(pier, {"ground.csv": fr.Record.read(tmp_path / "ground.csv")}, condition=True, validity=validity)
        assert table["digits"].tolist() == pd.read_csv(tmp_path / "rows.csv")["digits"].tolist() == [run.condition.digits]


def test_the_change_that_decides_about_overturning_is_the_least_of_those_tried():
    pier, found = fr.Structure(preset="mcmanus"), set()
    for amplitude in np.linspace(0.3, 0.6, 40):
        ground = fr.pulse("sine", amplitude=amplitude, frequency=1, cycles=8)
        run = fr.simulate(pier, ground, condition=True)
        overturned = lambda change: fr.simulate(pier, ground.scaled(1 + change)).overturned
        change = run.condition.overturning_change
        tried = [sign * 10.0 ** -decade for decade in range(14, 1, -1) for sign in (1, -1)]
        assert [of for of in tried if overturned(of) != run.overturned][:1] == ([] if change is None else [pytest.approx(change)])
        found.add(run.condition.overturning_digits)
        assert run.condition.overturning_digits == (13 if change is None else 14 + round(np.log10(abs(change))))
    assert {9, 10, 11, 13} <= found


def test_initial_values_and_a_force_are_changed_with_the_ground():
    pier = fr.Structure(preset="mcmanus")
    for below, decides in ((3e-6, 1e-5), (3e-4, 1e-3)):  # a rigid block at rest falls from alpha_cg on
        run = fr.simulate(pier, duration=20, theta_0=pier.alpha_cg * (1 - below), detail="rigid", condition=True)
        assert (run.overturned, run.condition.overturning_change) == (False, decides)
    pushed = lambda F_t: fr.simulate(pier, fr.Record(1, [0, 0]).with_force([0, 0.5, 1], [0, F_t, 0]), condition=True)
    low, high = 100.0, 1e4
    while high > low * (1 + 1e-5):
        low, high = (low, middle) if pushed(middle := (low * high) ** 0.5).overturned else (middle, high)
    assert not pushed(low).overturned and 0 < pushed(low).condition.overturning_change <= 1e-5


def test_weights_are_in_newtons_and_a_tendon_in_kilonewtons_is_doubted():
    pier = fr.Structure(preset="mcmanus")
    assert (pier.weight, pier.weight0) == (pier.m * pier.g, pier.m0 * pier.g)
    assert fr.Structure(weight=pier.weight, m0=1, H=1, B=0.3, f_fc=3, zeta_fc=0.02, r=0.9).m == pytest.approx(pier.m, rel=1e-15)
    with pytest.warns(UserWarning, match="P_0 = 0.95.* N changes next to nothing under the weight of the structure"):
        pier.replace(P_0=0.5e-3 * (pier.weight + pier.weight0))


def test_a_fall_ends_the_motion_and_rest_goes_on(monkeypatch):
    fallen = fr.simulate(fr.Structure(preset="mcmanus"), duration=60, theta_0=0.3)
    response = fallen.at([fallen.end + 1, 0, fallen.end])
    assert fallen.overturned and fallen.fall == 0 and np.isnan(response["theta"][0]) and response["transitions"][0] == 1
    assert fallen.plot().get_suptitle().endswith(", falls from 0 s on")
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ImportError, match=r"matplotlib is missing: run pip install .flexible-rocking\[all\]."):
        fallen.plot()
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
    (lambda ground: fr.Record([0, 1], [0]), "2 time(s) and 1 acceleration(s) instead of two or more of each"),
    (lambda ground: fr.Record(0.0, [0, 1]), "dt = 0 is out of range: a finite number greater than 0 is needed"),
    (lambda ground: fr.Record(0.1, ["a", "b"]), "a_g: numbers are needed, not text or other objects"),
    (lambda ground: fr.Record(pd.date_range("2026", periods=2), [0, 1]), "time: these are dates"),
    (lambda ground: fr.Record(pd.to_timedelta([0, 5], unit="ms"), [0, 1]), "time: these are durations: numbers are needed, in s"),
    (lambda ground: fr.Record(0.1, np.array(["1", 2.0], object)), "a_g: numbers are needed"),
    (lambda ground: fr.Record(0.1, [True, 1.0]), "a_g: these are bools"),
    (lambda ground: fr.Record(0.1, np.array([0.0, np.True_], object)), "a_g: these are bools"),
    (lambda ground: fr.Record(0.1, [0, 1], unit="m"), 'unit = "m" is unknown; these are known: g, m/s2'),
    (lambda ground: fr.export("a.fmu", fr.Structure(preset="mcmanus"), fmi="3.0"), 'fmi = "3.0" is unknown; these are known: 2, 3'),
    (lambda ground: fr.advise(fr.Structure(preset="mcmanus"), ground, within="5%"), "within = '5%': it is no number"),
    (lambda ground: fr.advise(fr.Structure(preset="mcmanus"), ground, of=["theta", 3]), 'of = "3" is unknown'),
    (lambda ground: fr.advise(fr.Structure(preset="mcmanus"), ground, detail="rigid"), "detail is no argument of this function"),
    (lambda ground: fr.Record(0.1, [1j, 2j]), "a_g: these are complex"),
    (lambda ground: fr.Structure(preset="mcmanus", m=True), "m = True: it is no number"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), duration=np.timedelta64(9, "ns")), "it is no number"),
    (lambda ground: ground.spectrum([0.2, 1e-9]), "period = 1e-9 s is out of range: it must lie between 0.0001 and 1000 s"),
    (lambda ground: ground.spectrum(0.2, zeta=-0.1), "zeta = -0.1 is out of range: it must lie between 0 and 10"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus")), "record and duration are missing"),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground, detail="fine"), 'detail = "fine" is unknown; these'),
    (lambda ground: fr.simulate(fr.Structure(preset="mcmanus"), ground).at([0, -1]), "times[1] = -1 s is out of range"),
    (lambda ground: fr.sweep(fr.Structure(preset="mcmanus"), ground, path="/dev/full"), "/dev/full: rows need a file"),
    (lambda ground: fr.sweep(fr.Structure(preset="mcmanus"), ground, threads=-1), "threads = -1 is out of range: 0, which is one per core"),
    (lambda ground: fr.Structure(preset="mcmanus", P_0=500).effective_frequency(0.04), "hold only without tendon"),
    (lambda ground: fr.Structure(preset="mcmanus", P_0=500).modes(fr.simulate(fr.Structure(preset="mcmanus"), ground).at(0)), "hold only without tendon"),
])
def test_what_is_refused_is_named(ground, refused, text):
    with pytest.raises(ValueError) as error:
        refused(ground)
    assert text in str(error.value)


def test_a_file_says_what_would_help(tmp_path):
    (tmp_path / "column.txt").write_text("0.1\n0.2\n-0.1\n")
    with pytest.raises(ValueError, match="give it in seconds as dt"):
        fr.Record.read(tmp_path / "column.txt")
    with pytest.warns(UserWarning) as warned:
        fr.Record.read(tmp_path / "column.txt", dt=0.5)
    assumed, doubted = (str(warning.message) for warning in warned)
    assert "the file states no unit of acceleration: m/s2 is assumed" in assumed and "a step of 0.5 s: is the time in another unit" in doubted
    assert {warning.filename for warning in warned} == {__file__}
    (tmp_path / "table.txt").write_text("0 1\n0.01 2\n0.02 0\n")
    with pytest.warns(UserWarning, match="table.txt: .*m/s2 is assumed"):
        fr.export(tmp_path / "table.fmu", fr.Structure(preset="mcmanus"), record=tmp_path / "table.txt")
    with pytest.warns(UserWarning, match="mine: a peak of 6 g: is the unit right"):
        fr.Record(0.01, [0, 6, -6, 0], unit="g", title="mine")
    with pytest.raises(ValueError, match="this would overwrite the input"):
        fr.export(tmp_path / "column.txt", fr.Structure(preset="mcmanus"), record=tmp_path / "column.txt")


def test_arrays_are_read_whatever_their_strides(ground):
    """A field beside an int32, as fmpy returns, and every other thing that has the same numbers."""
    pier = fr.Structure(preset="mcmanus")
    fields = np.zeros(len(ground), dtype=[("transitions", "i4"), ("time", "f8"), ("a_g", ">f8")])
    fields["time"], fields["a_g"] = ground.time, ground.a_g
    assert fields["time"].strides[0] % 8 != 0
    for time_, a_g in [(fields["time"], fields["a_g"]), (pd.Series(ground.time), ground.a_g[::-1][::-1]),
                       (ground.time.tolist(), ground.a_g.astype(object))]:
        same = fr.Record(time_, a_g, title=ground.title)
        assert np.array_equal(same.time, ground.time) and np.array_equal(same.a_g, ground.a_g)
    times = fields["time"][100:200]
    assert np.array_equal(ground.spectrum(times), ground.spectrum(times.copy()))
    run = fr.simulate(pier, ground)
    assert np.array_equal(run.at(times)["theta"], run.at(times.copy())["theta"])
    assert fr.sweep(pier, ground, scale=times[:3])["scale"].tolist() == times[:3].tolist()
    assert fr.Record(np.float32(0.0625), np.ones(3, np.int64)).duration == 0.125 and run.at(np.int64(1))["time"].tolist() == [1.0]


@pytest.mark.parametrize("unit, per_g", [("g", 1), ("mg", 1000), ("%g", 100)])
def test_a_unit_of_g_is_that_of_the_structure(said, tmp_path, unit, per_g):
    moon = fr.Structure(preset="mcmanus", g=1.62)
    time_ = np.arange(0, 1, 0.01)
    in_g = per_g * 0.9 * np.sin(4 * np.pi * time_)
    ground = fr.Record(time_, in_g, unit=unit).scaled(1.1)
    in_si = fr.Record(time_, in_g * {"g": 1.62, "mg": 1.62 / 1e3, "%g": 1.62 / 1e2}[unit]).scaled(1.1)
    run, expected = (fr.simulate(moon, of) for of in (ground, in_si))
    assert run.peaks == expected.peaks and np.array_equal(run.at(time_)["a_g"], expected.at(time_)["a_g"])
    assert pickle.loads(pickle.dumps(run)).peaks == run.peaks and ground.pga == pytest.approx(9.81 * 1.1 * 0.9, rel=2e-3)
    swept = fr.sweep(moon, ground, scale=[1, 0.815])
    assert swept["peak_theta[rad]"].tolist() == [run.peaks["theta"], fr.simulate(moon, ground.scaled(0.815)).peaks["theta"]]
    assert swept["record_scale"].tolist() == [1.1, 1.1]
    assert fr.estimate(moon, ground)["a_t"] == fr.estimate(moon, in_si)["a_t"]
    with pytest.raises(ValueError, match="g = 9.81 m/s2 and g = 1.62 m/s2: a sweep has one g"):
        fr.sweep([moon, fr.Structure(preset="mcmanus")], ground)
    fr.Record(time_, in_g, unit=unit).write(tmp_path / "g.csv")
    printed = json.loads(said("simulate", "--preset", "mcmanus", "--g", 1.62, "--record", "g.csv", "--scale", 1.1, "--format", "json", "-o", "rows.csv"))
    assert {of["name"]: of["peak"] for of in printed["peaks"]} == run.peaks


def test_a_record_that_is_written_is_the_same_again(tmp_path, ground):
    both = fr.Record(0.01, [0, 2, 0], [1, 0, 3], unit="g", title="acceleration in m/s2 of both")
    with pytest.raises(ValueError, match="the record has a vertical component: give its file as record_v"):
        both.write(tmp_path / "h.csv")
    both.write(tmp_path / "h.csv", record_v=tmp_path / "v.csv")
    read = fr.Record.read(tmp_path / "h.csv", record_v=tmp_path / "v.csv")
    assert read == both and np.array_equal(read.a_g, both.a_g) and np.array_equal(read.a_v, both.a_v)
    ground.write(tmp_path / "ground.csv")
    assert fr.Record.read(tmp_path / "ground.csv") == ground and hash(fr.Record.read(tmp_path / "ground.csv")) == hash(ground)
    with pytest.raises(ValueError, match="the record has no vertical component: leave record_v out"):
        fr.Record(0.01, [0, 2, 0]).write(tmp_path / "h.csv", record_v=tmp_path / "v.csv")
    file = tmp_path / "array.csv"
    file.write_text("t (s),north (g),up (g)\n0,0,1\n.01,2,0\n.02,0,3\n")
    assert np.array_equal(fr.Record.read(file, column=2, record_v=file, column_v="up").a_v, both.a_v)
    assert np.array_equal(fr.Record.read(file, column=2, column_v="up").a_v, both.a_v)
    for same in ({"record_v": file}, {"column_v": 2}):
        with pytest.raises(ValueError, match='"array" has the samples of the horizontal one: use another file for it, or another column, column_v'):
            fr.Record.read(file, column=2, **same)


def test_a_force_goes_with_a_record_and_no_scale_changes_it(tmp_path, ground):
    pushed = ground.with_force([0, 1, 60], [0, 300, 0])
    assert pushed != ground and pushed.F_t.max() == pushed.scaled(2).F_t.max() == 300 and ground.F_t is None
    assert pickle.loads(pickle.dumps(pushed.scaled(2, time_scale=0.5))) == copy.copy(pushed).scaled(2, time_scale=0.5)
    released = ground.with_force([0, 0.125], [300, 300])
    assert released.F_t.shape == released.time.shape and np.all((released.F_t == 300) == (released.time <= 0.125))
    pier = fr.Structure(preset="mcmanus")
    assert fr.sweep(pier, pushed, scale=[2])["peak_theta[rad]"][0] == fr.simulate(pier, pushed.scaled(2)).peaks["theta"]
    for refuse in (lambda: pushed.write(tmp_path / "a.csv"), lambda: fr.export(tmp_path / "a.fmu", pier, record=pushed)):
        with pytest.raises(ValueError, match="a file or an FMU cannot hold the record's force: write the record without with_force, and set"):
            refuse()


@pytest.fixture(scope="module")
def long_run():
    time_ = np.arange(4_000_000) * 0.01
    return fr.simulate(fr.Structure(preset="mcmanus"), fr.Record(time_, 2.2 * np.sin(9 * time_)))


@pytest.mark.parametrize("computes", [
    lambda run: fr.simulate(run.structure, run.record),
    lambda run, times=np.linspace(0, 1, 5_000_000): run.at(times),
    lambda run: fr.advise(run.structure, fr.Record(0.01, run.record.a_g[:200_000])),
    lambda run: run.record.spectrum(np.linspace(0.1, 2, 200)),
    lambda run: run.structure.pushover(points=1_000_000),
    lambda run: run.validity,
    lambda run: str(run),
], ids=["simulate", "at", "advise", "spectrum", "pushover", "validity", "str"])
def test_signals_are_answered_while_it_computes(long_run, computes):
    """A timer ticks. Python hears of it once after a call that answers to nothing, and several times during one that does."""
    heard = []

    def hear(_, frame):
        heard.append(frame.f_code.co_filename == __file__)
        if sum(heard) == 3:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, hear)
    signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)
    try:
        with pytest.raises(KeyboardInterrupt):
            computes(long_run)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_results_are_pickled_and_copied(run, ground):
    pulses = {f"{f} Hz": fr.pulse("sine", amplitude=0.5, frequency=f) for f in (1.0, 1.5, 2.0, 2.5, 3.0)}
    fragility = fr.fragility(fr.sweep(run.structure, pulses, scale=np.linspace(0.2, 3, 15)))
    for same in (lambda of: pickle.loads(pickle.dumps(of)), copy.deepcopy):
        for result in (run, run.peaks["theta"], run.transitions, run.validity["mu_required"], fr.advise(run.structure, ground), ground):
            assert same(result) == result and type(same(result)) is type(result) and repr(same(result)) == repr(result)
        assert (same(run.peaks["u"]).time, same(run.peaks["u"]).unit) == (run.peaks["u"].time, "m")
        copied = same(fragility)
        assert (copied.median, copied.curve.median_range) == (fragility.median, fragility.curve.median_range)
        assert copied.curve.band([0.5]).tolist() == fragility.curve.band([0.5]).tolist()


def test_a_peak_is_a_float(run):
    peak = run.peaks["theta"]
    assert f"{peak:.3f}" == f"{peak.value:.3f}" and peak > 0.01 and 2 * peak == 2 * peak.value and max(peak, 0.0) is peak
    assert json.dumps(peak) == str(peak.value) and np.sqrt([peak]).dtype == float and str(peak).endswith(" s")


def test_a_table_has_its_units(run, monkeypatch):
    some, curve = run.transitions[:2], {"theta": "rad", "u": "m", "delta_t": "m", "P": "N", "M": "N.m"}
    assert len(some) == 2 and some.to_pandas().attrs["units"]["u_dot_before"] == "m/s"
    for table, units in ((run.structure.pushover(3), curve), (run.spectrum(1, [0.1]), {"period": "s", "S_a": "m/s2"}), (run.at(1.0), run.at(1.0).units)):
        assert table.to_pandas().attrs["units"] == units
    assert run.record.spectrum(1.1) == run.record.spectrum([1.1])[0]
    monkeypatch.setenv("MPLBACKEND", "agg")
    assert run.record.plot().axes[0].get_ylabel() == "acceleration (g)"


def test_what_is_asked_for_in_another_form_is_taken_or_refused_by_name(run, ground, tmp_path):
    pier = run.structure
    assert fr.advise(pier, ground, of="theta").detail == fr.advise(pier, ground, of=["theta"]).detail
    assert run.at(1.0)["theta"].tolist() == run.at([1.0])["theta"].tolist()
    for ask in (fr.simulate, fr.advise, fr.sweep, fr.estimate, lambda pier, path: fr.sweep(pier, [path]), lambda pier, path: fr.sweep(pier, {"a": path}),
                lambda _, path: fr.Record.read(path), lambda pier, path: fr.export(tmp_path / "a.fmu", pier, record=path), lambda _, path: fr.Structure.read(path)):
        with pytest.raises(FileNotFoundError, match="none.AT2"):
            ask(pier, "none.AT2")
    for ask in (fr.simulate, lambda pier, record: fr.export(tmp_path / "a.fmu", pier, record=record), lambda pier, record: fr.sweep(pier, [record])):
        with pytest.raises(TypeError, match="record = 3 is no Record and no path of a file"):
            ask(pier, 3)
    assert fr.simulate(pier, RECORD) == fr.simulate(pier, fr.Record.read(RECORD)) != fr.simulate(pier, ground)
    series = pd.Series(ground.a_g, index=ground.time, name=ground.title)
    assert fr.Record(series) == fr.Record(ground.time, ground.a_g, title=ground.title)
    with pytest.raises(AttributeError, match=re.escape("H is read-only: use replace(H=3)")):
        pier.H = 3
    with pytest.raises(TypeError, match="structure = .* is no Structure"):
        fr.simulate(ground, pier)
    assert hash(ground) == hash(copy.copy(ground)) and len({ground, ground.scaled(2)}) == 2
    flat = fr.Structure(preset="evison", J0=-0.0)
    assert flat == fr.Structure(preset="evison") and hash(flat) == hash(fr.Structure(preset="evison"))


def test_pip_installs_a_fresh_clone(tmp_path):
    """With nothing but cargo and pip: the script of README, an FMU that the module packs, and the program."""
    if not (ROOT / ".git").exists():
        pytest.skip("this is no clone: of the package of the source, see test_wheel.py")
    clone, python = tmp_path / "clone", tmp_path / "venv/bin/python"
    built = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release"
    shutil.copytree(built, tmp_path / "target/release")  # in which cargo finds the packages that others have written
    environment = os.environ | {"CARGO_TARGET_DIR": str(tmp_path / "target")}

    def run(*command):
        done = subprocess.run([str(part) for part in command], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("git", "clone", "--quiet", ROOT, clone)
    run(sys.executable, "-m", "venv", "venv")
    run(python, "-m", "pip", "install", "--quiet", clone)
    [(script, printed)] = pages.scripts((clone / "README.md").read_text(encoding="utf-8"))
    assert run(python, "-c", script) == printed
    run(python, "-c", "import flexible_rocking as fr; "
                      "fr.export('own.fmu', fr.Structure(preset='evison'), record=fr.pulse('sine', amplitude=0.5, frequency=2))")
    assert np.abs(simulate_fmu(tmp_path / "own.fmu", stop_time=2)["theta"]).max() > 0
    run(python.with_name("rocking-fmu"), "export", "-o", "packed.fmu")
    assert (tmp_path / "packed.fmu").stat().st_size > 500_000


def test_a_table_in_memory_is_that_of_the_file_of_rows(tmp_path):
    with pytest.warns(UserWarning, match="far from the usual frequency"):
        soft = fr.Structure(preset="mcmanus", m0=0, J0=0, f_fc=0.2)  # some runs fail
    groups = {"piers": [fr.Structure(preset="mcmanus", f_fc=f) for f in (2, 4)], "soft": soft}
    pulses = {f"{f} Hz": fr.pulse("sine", amplitude=0.6, frequency=f) for f in (1, 2)}
    for options in ({}, {"validity": True, "duration": 3, "theta_0": 0.01}, {"groups": {"piers": groups["piers"]}}):
        structures = options.pop("groups", groups)
        options["scale"] = [0.5, 2, 6]
        in_memory = fr.sweep(structures, pulses, **options)
        rows = tmp_path / f"{len(options)}{len(structures)}.csv"
        written, read = (fr.sweep(structures, pulses, path=rows, **options) for _ in range(2))
        by_pandas = pd.read_csv(rows, dtype={"structure_digest": "str", "record_digest": "str"})
        by_pandas = by_pandas.set_index("run").loc[in_memory["run"]].reset_index()
        for table in (written, read, by_pandas):
            pd.testing.assert_frame_equal(in_memory, table)
        assert ("energy_gains" in in_memory) == ("validity" in options)
        assert set(in_memory["ending"]) >= ({"failed"} if "soft" in structures else {"overturned"})


def test_a_sweep_says_how_far_it_is(capsys, monkeypatch):
    pier, pulse = fr.Structure(preset="mcmanus"), fr.pulse("sine", amplitude=0.6, frequency=2)
    told = []
    fr.sweep(pier, pulse, scale=np.linspace(0.1, 1, 2000), threads=1, progress=lambda done, of: told.append((done, of)))
    assert told == sorted(told) and told[-1] == (2000, 2000) and len(told) > 1
    fr.sweep(pier, pulse, scale=[0.1, 0.2], progress=True)
    assert re.search(r"100%.*2/2 .*runs/s", capsys.readouterr().err)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError, match="tqdm.auto is missing: run pip install"):
        fr.sweep(pier, pulse, scale=[0.1, 0.2], progress=True)

    def stop(done, of):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as stopped:
        fr.sweep(pier, pulse, scale=np.linspace(0.1, 1, 100_000), progress=stop)
    assert 0 < len(stopped.value.table) < 100_000


def test_a_sweep_that_is_stopped_keeps_its_rows():
    script = ("import flexible_rocking as fr, numpy as np, sys\n"
              "say = lambda done, of: print(done, 'of', of, file=sys.stderr, flush=True)\n"
              "try:\n"
              "    pulse = fr.pulse('sine', amplitude=0.6, frequency=2)\n"
              "    fr.sweep(fr.Structure(preset='mcmanus'), pulse, scale=np.linspace(0.1, 1, 1000000), progress=say)\n"
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


def test_a_sweep_and_its_fragility_go_on_where_the_command_line_was(exporter, tmp_path):
    for frequency in (1.5, 2, 2.5, 3, 4):
        fr.pulse("cosine", amplitude=0.5, frequency=frequency).write(tmp_path / f"{frequency}.csv")
    scales = np.linspace(0.3, 3, 10).tolist()
    (tmp_path / "sweep.toml").write_text(f"records = ['*.csv']\nscale = {scales}\nintensity = 'S_a'\n"
                                         "[limits]\n'theta/alpha_cg' = [0.1]\ntheta = '1 deg'\nuplift = '1 cm'\na_t = '0.5 g'\n"
                                         "[[structures]]\nname = 'piers'\npreset = 'mcmanus'\nvary.f_fc = [4, 8]\n")
    command = [exporter, "sweep", "sweep.toml", "-o", "rows", "--quiet", "--format", "json"]
    printed = json.loads(subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout)
    motions = {path.name: fr.Record.read(path) for path in sorted(tmp_path.glob("*.csv"))}
    before = (tmp_path / "rows").read_bytes()
    runs = dict(structures={"piers": [fr.Structure(preset="mcmanus", f_fc=f) for f in (4, 8)]}, records=motions, scale=scales,
                intensity="S_a")
    table = fr.sweep(**runs, path=tmp_path / "rows")
    assert (tmp_path / "rows").read_bytes() == before
    pd.testing.assert_frame_equal(table, fr.sweep(**runs, threads=1))
    for expected in printed:
        found = fr.fragility(table, expected["limit"])
        assert [found.median, found.dispersion] == pytest.approx([expected["median"], expected["dispersion"]], rel=1e-12)
        assert found.curve.median_range == pytest.approx((expected["median_from"], expected["median_to"]), rel=1e-12)
        assert found.bins.to_dict("records") == [pytest.approx(of, rel=1e-12) for of in expected["bins"]]


@pytest.fixture(scope="module")
def two_populations():
    pulses = {f"{f} Hz": fr.pulse("sine", amplitude=0.3, frequency=f) for f in (0.5, 0.7, 0.9, 1.1, 1.3, 1.6)}
    structures = {name: fr.Structure(preset=name) for name in ("mcmanus", "evison")}
    return fr.sweep(structures, pulses, scale=np.linspace(0.5, 3, 16), intensity="PGV")


def test_a_curve_is_of_one_population_under_one_measure(two_populations):
    limit, alone = "theta/alpha_cg >= 0.3", two_populations[two_populations["structures"] == "mcmanus"]
    lost = pd.read_csv(io.StringIO(alone.to_csv(index=False)))
    for table, refused in [
        (two_populations, "the table has 2 values of structures, 'mcmanus', 'evison', and a curve is of one: choose"),
        (pd.concat([alone, alone.assign(detail="linear")]), "the table has 2 values of detail, 'auto', 'linear'"),
        (pd.concat([alone, alone.assign(**{"u_0[m]": 0.01})]), "the table has 2 values of u_0[m], 0.0, 0.01, and"),
        (pd.concat([alone, alone[:2]]), "the table has 2 rows of runs that it has already: leave them out by table.drop_duplicates"),
        (lost, "intensity is needed: the table has lost the measure of its sweep; give one, such as PGA, or a column"),
        (alone.assign(**{"peak_theta/alpha_cg": np.nan}), "peak_theta/alpha_cg is NaN in"),
        (alone.assign(ending=np.nan), "unknown variant `nan`"),
    ]:
        with pytest.raises(ValueError, match=re.escape(refused)):
            fr.fragility(table, limit)
    over_pgv = fr.fragility(alone, limit)
    named = fr.fragility(lost, limit, intensity="PGV")
    doubled = fr.fragility(alone.assign(twice=2 * alone["PGV[m/s]"]), limit, intensity="twice")
    assert [named.median, doubled.median / 2] == pytest.approx([over_pgv.median] * 2, rel=1e-9)


def test_curves_by_a_column_are_those_of_its_rows(two_populations):
    limit = "theta/alpha_cg >= 0.3"
    curves = fr.fragility(two_populations, limit, by="structures")
    medians = {name: fr.fragility(rows, limit).median for name, rows in two_populations.groupby("structures", sort=False)}
    assert {name: curve.median for name, curve in curves.items()} == medians
    alone = two_populations[two_populations["structures"] == "mcmanus"]
    assert fr.fragility(alone, "theta >= 0.5 %").median == fr.fragility(alone, "theta >= 0.005").median
    low = two_populations["PGV[m/s]"] < two_populations["PGV[m/s]"].min() * 1.01
    for refused, options in [("structures = 'mcmanus': never exceeded: raise", {"table": two_populations[low], "by": "structures"}),
                             ("by = 'period' is no column of the table: give one of run, ", {"table": two_populations, "by": "period"}),
                             ("the table has no g[m/s2], B[m]: a table with the columns of `sweep`",
                              {"table": two_populations.drop(columns=["run", "g[m/s2]", "B[m]"])})]:
        with pytest.raises(ValueError, match=re.escape(refused)):
            fr.fragility(limit=limit, **options)


def probit(x, over):
    """The regression of statsmodels of what is `over` a limit on x, with its constant and its slope."""
    model = api.GLM(over.astype(float), api.add_constant(x), family=api.families.Binomial(api.families.links.Probit()))
    return model, model.fit(tol=1e-12).params


def test_curve_and_band_are_those_of_statsmodels(two_populations):
    """A probit regression with a covariance that is robust against clusters; the band by Student's distribution."""
    rows = two_populations[two_populations["structures"] == "mcmanus"]
    found = fr.fragility(rows, "theta/alpha_cg >= 0.3")
    x, over = np.log(rows["PGV[m/s]"]), (rows["peak_theta/alpha_cg"] >= 0.3) | (rows["ending"] == "overturned")
    model, (a, b) = probit(x, over)
    params = np.array([a, b])
    assert [found.median, found.dispersion] == pytest.approx([np.exp(-a / b), 1 / b], rel=1e-6)
    scores = pd.DataFrame(model.score_obs(params)).groupby(rows["record"].to_numpy()).sum().to_numpy()
    information, groups = np.linalg.inv(model.hessian(params, observed=False)), len(scores)
    covariance = groups / (groups - 1) * information @ scores.T @ scores @ information
    at = np.array([0.2, 0.4, 0.9])
    table = found.table(at)
    assert table["probability"].to_numpy() == pytest.approx(stats.norm.cdf(np.log(at / found.median) / found.dispersion), rel=1e-12)
    row = np.column_stack([np.ones(3), np.log(at)])
    half = stats.t.ppf(0.975, groups - 1) * np.sqrt(np.sum(row @ covariance * row, axis=1))
    for name, sign in (("low", -1), ("high", 1)):
        assert table[name].to_numpy() == pytest.approx(stats.norm.cdf(row @ params + sign * half), rel=5e-3)


def test_the_weakest_motion_that_reaches_a_limit_is_found():
    pier = fr.Structure(preset="mcmanus")
    pulses = {f"{f} Hz": fr.pulse("sine", amplitude=0.3, frequency=f).scaled(0.7) for f in (0.8, 1.5, 2.5)}
    limit = "theta/alpha_cg >= 0.3"
    found = fr.intensity_at(pier, pulses, limit, accuracy=1e-6).set_index("record")
    for name, pulse in pulses.items():
        scale = found["scale"][name]
        below, at = (fr.simulate(pier, pulse.scaled(scale * factor)).peaks["theta"] / pier.alpha_cg for factor in (1 - 2e-6, 1))
        assert below < 0.3 <= at == found["peak_theta/alpha_cg"][name]
        assert [found["PGA[g]"][name], found["record_scale"][name]] == pytest.approx([scale * pulse.pga / pier.g, 0.7], rel=1e-12)
        weaker = fr.sweep(pier, pulse, scale=np.linspace(0.1, 0.999, 200) * scale)
        assert (weaker["peak_theta/alpha_cg"] < 0.3).all()


def test_stripes_that_begin_too_high_or_do_not_rise_are_told():
    """The page of the study prints the other notes."""
    pier, pulse = fr.Structure(preset="mcmanus"), {"pulse": fr.pulse("cosine", amplitude=0.5, frequency=1)}
    assert fr.intensity_at(pier, pulse, scale=[7.5, 8])["note"][0] == "reached at the weakest stripe, scale 7.5: begin lower"
    with pytest.raises(ValueError, match="increasing factors greater than 0 are needed"):
        fr.intensity_at(pier, pulse, scale=[2, 1])


@pytest.mark.filterwarnings("ignore")
def test_a_trace_of_obspy_is_a_record():
    import obspy

    trace = obspy.Trace(np.array([0, 100, -50, 25], "int32"), {"delta": 0.02, "network": "NZ", "station": "CBGS", "channel": "HNE"})
    record = fr.Record(trace, unit="cm/s2")
    assert record == fr.Record(0.02, [0, 100, -50, 25], unit="cm/s2", title="NZ.CBGS..HNE") == fr.Record(obspy.Stream([trace]), unit="cm/s2")
    refused = [(lambda: fr.Record(trace), "the trace NZ.CBGS..HNE does not state the unit of its samples: say unit="),
               (lambda: fr.Record(obspy.Stream([trace, trace]), unit="g"), "the stream has 2 traces, NZ.CBGS..HNE, NZ.CBGS..HNE, and"),
               (lambda: fr.Record([0, 1]), "a_g is needed beside time = [0, 1]")]
    gap = trace.copy()
    gap.data = np.ma.masked_equal(gap.data, 25)
    for make, text in [*refused, (lambda: fr.Record(gap, unit="g"), "a_g: some of it is masked")]:
        with pytest.raises(ValueError, match=re.escape(text)):
            make()


@pytest.mark.filterwarnings("ignore")
def test_the_lines_of_a_refusal_hand_the_record_over(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    a = np.round(100 * np.sin(0.1 * np.arange(101)), 4)
    pytest.importorskip("obspy").Trace(a, {"delta": 0.005}).write("file", format="MSEED")
    with pytest.raises(ValueError, match="obspy may read it, in Python:\n") as refused:
        fr.Record.read("file")
    exec(str(refused.value).partition("\n")[2], {"FILE": "file", "UNIT": "cm/s2"})
    assert np.allclose(fr.Record.read("record.csv").a_g, a / 100, atol=1e-5)


def test_the_sweep_on_dask_comes_to_the_same(tmp_path):
    (tmp_path / "out").mkdir()
    shutil.copy(RECORD, tmp_path / "out")
    command = [sys.executable, ROOT / "examples" / "fragility_dask.py"]
    printed = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    found = pd.read_csv(tmp_path / "fragility_dask.csv")
    piers = [fr.Structure(preset="mcmanus", f_fc=f_fc) for f_fc in np.geomspace(2, 8, 8)]
    expected = fr.sweep({"piers": piers}, {RECORD.name: fr.Record.read(RECORD, time_scale=0.2)}, scale=np.linspace(0.2, 2, 10))
    pd.testing.assert_frame_equal(found, expected, check_exact=True)
    assert printed.startswith(f"{sum(expected['ending'] == 'overturned')} of 80 overturned")


def test_formats_read_back(tmp_path):
    pulses = {f"{f} Hz": fr.pulse("sine", amplitude=0.3 + 0.1 * f, frequency=f) for f in (1.0, 1.5, 2.0, 3.0)}
    runs = fr.sweep(fr.Structure(preset="mcmanus"), pulses, scale=np.linspace(0.2, 3, 15), intensity="S_a(0.2 s)")
    runs["SA(0.20)"] = runs["record"].map({name: of.spectrum(0.2) / 9.81 for name, of in pulses.items()}) * runs["scale"]
    assert runs["S_a(0.2 s)[g]"].tolist() == pytest.approx(runs["SA(0.20)"].tolist())
    over = lambda measure: {name: fr.fragility(runs, limit, intensity=measure)
                            for name, limit in (("slight", "theta/alpha_cg >= 0.3"), ("fallen", "overturned"))}
    states = over("SA(0.20)")
    formats.write_pelicun(tmp_path / "piers.csv", {"pier": states.values()})
    row = pd.read_csv(tmp_path / "piers.csv", index_col="ID").loc["pier"]
    assert [row["Demand-Type"], row["Demand-Unit"], row["LS2-Family"]] == ["Peak Spectral Acceleration|0.20", "g", "lognormal"]
    assert [row[f"LS{i}-Theta_{j}"] for i in (1, 2) for j in (0, 1)] == [
        number for of in states.values() for number in (of.median, of.dispersion)]
    for measure, kind, factor in (("SA(0.20)", "SA(0.20)", 1), ("S_a(0.2 s)", "SA(0.2)", 1), ("PGA", "PGA", 1), ("PGV", "PGV", 100), ("CAV", "CAV", 1 / 9.80665),
                                  ("I_A", "IA", 1), ("D_5_95", "RSD", 1)):
        states = over(measure)
        for levels in (None, [0.5, 1.0, 2.0]):
            formats.write_openquake(tmp_path / "piers.xml", {"pier": states}, levels=levels)
            name = {"": "http://openquake.org/xmlns/nrml/0.5"}
            function = ElementTree.parse(tmp_path / "piers.xml").find("fragilityModel/fragilityFunction", name)
            imls = function.find("imls", name)
            numbers = lambda of: [float(number) for number in of.text.split()]
            assert imls.get("imt") == kind
            for state, of in zip(function.findall("poes", name), states.values(), strict=True):
                known = of.bins[of.bins["known"] > 0]
                assert numbers(imls) == [factor * at for at in levels or known["mean"]]
                assert numbers(state) == (of.probability(levels) if levels else known["exceedances"] / known["known"]).tolist()
    for measure in ("S_a", "scale"):
        for write in (formats.write_pelicun, formats.write_openquake):
            with pytest.raises(ValueError, match=re.escape("which the format does not have: give fr.fragility an intensity of PGA[g]")):
                write(tmp_path / "none", {"pier": over(measure)} if write is formats.write_openquake else {"pier": over(measure).values()})
    assert not (tmp_path / "none").exists()


def test_statistics_of_the_page_of_the_study_are_those_of_statsmodels(tmp_path, monkeypatch):
    text = (ROOT / "docs" / "howto" / "fragility_study.md").read_text(encoding="utf-8")
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(tmp_path)
    of = {}
    with contextlib.redirect_stdout(io.StringIO()):
        exec("".join(script for script, _ in pages.scripts(text)), of)
    printed = re.search(r"\n +median    beta.*\n((?:.*\n)+?)```", text)[1].splitlines()
    for line, name in zip(printed, of["measures"], strict=True):
        values = of["target"][name]
        deviation, _, median = stats.lognorm.fit(values, floc=0)
        p = [api.OLS(np.log(values).to_numpy(), api.add_constant(other.to_numpy())).fit().pvalues[1] for other in of["others"].values()]
        expected = [median, deviation * np.sqrt(len(values) / (len(values) - 1)), *p]
        assert [float(number) for number in line.split()[-4:]] == pytest.approx(expected, abs=6e-4)
    assert of["rate"] == pytest.approx(of["closed"], rel=1e-3)
    runs = of["runs"]
    table = pd.DataFrame({"S": runs["S_a(1 s)[g]"], "PID": runs.filter(regex=r"peak_drift_ratio").max(axis=1), "record": runs["record"]})
    _, (a, b) = probit(np.log(table["S"]), table["PID"] >= 0.004)
    own = fr.fragility(table, "PID >= 0.004", intensity="S")
    for curve in (fr.fragility(runs, "drift_ratio >= 0.4 %"), own):
        assert [curve.median, curve.dispersion] == pytest.approx([np.exp(-a / b), 1 / b], rel=1e-6)
        assert curve.curve.median_range == own.curve.median_range
    with pytest.raises(ValueError, match="COLUMN >= VALUE is needed, with a column of S, PID, record and a number"):
        fr.fragility(table, "drift >= 0.004", intensity="S")
    for column, value, refused in [("PID", np.nan, "PID is NaN in 1 rows: write inf where the structure collapsed"),
                                   ("S", "0,5", "S has text in 1 rows, such as '0,5': give numbers")]:
        with pytest.raises(ValueError, match=re.escape(refused)):
            fr.fragility(table.assign(**{column: [value, *table[column][1:]]}), "PID >= 0.004", intensity="S")
    formats.write_demands("demands.csv", runs)
    demands = pd.read_csv("demands.csv", index_col=0)
    stands = runs[runs["ending"] != "overturned"]
    assert demands.loc["Units", ["1-PFA-0-1", "1-PFA-6-1", "1-PID-6-1", "1-IM-0-1"]].tolist() == ["mps2", "mps2", "rad", "g"]
    found = demands.drop("Units").astype(float)
    assert found["1-PFA-6-1"].tolist() == stands["peak_a_t[6][m/s2]"].tolist() and found["1-PID-1-1"].tolist() == stands["peak_drift_ratio[1]"].tolist()
    assert found["1-ROT-0-1"].tolist() == stands["peak_theta[rad]"].tolist() and found.index[0] == "El Centro 180 x 0.2"
