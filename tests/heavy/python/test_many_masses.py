"""Structures of many masses as users give them: three ways in Python and in files, against modes by scipy."""

import copy
import json
import math
import pickle
import re
import subprocess
import tomllib

import flexible_rocking as fr
import numpy as np
import pandas as pd
import pytest
from frames import FRAMES, Frame, toml
from scipy.linalg import eigh

FRAME = FRAMES["frame"]
BASE = {"m0": FRAME.m0, "J0": FRAME.J0, "B": FRAME.B, "r": FRAME.r}
STOREYS = [{"m": m, "h": h, "k": k} for m, h, k in zip(FRAME.masses, FRAME.heights, FRAME.stiffness, strict=True)]
TALL = Frame((3e4,) * 10, tuple(3.0 * (i + 1) for i in range(10)), tuple(9e7 - 5e6 * i for i in range(10)), m0=5e4, J0=2e5, B=4.0, r=0.92, zeta=0.03)


def of_storeys(**changes):
    return fr.Structure(**{"storeys": STOREYS, "zeta": 0.02, **BASE, **changes})


GAMMA, KAPPA = FRAME.m @ FRAME.phi, FRAME.m * FRAME.h @ FRAME.phi
MODES = {"period": 2 * math.pi / FRAME.omega, "mass": GAMMA**2, "moment": GAMMA * KAPPA, "shapes": 5 * FRAME.phi}


def of_modes(**changes):
    return fr.Structure.from_modes(**{**MODES, "masses": FRAME.m, "heights": FRAME.h, "zeta": 0.02, **BASE, **changes})


@pytest.mark.parametrize("name", FRAMES)
def test_the_modes_are_those_of_scipy(name):
    frame = FRAMES[name]
    base = {"m0": frame.m0, "J0": frame.J0, "B": frame.B, **({"r": frame.r} if frame.r else {})}
    structure = fr.Structure.from_matrices(frame.masses, frame.heights, frame.K, zeta=0.02, **base)
    gamma, kappa = frame.m @ frame.phi, frame.m * frame.h @ frame.phi
    expected = {"f": frame.omega / (2 * math.pi), "zeta": 0.02, "mass": gamma**2, "share": gamma**2 / frame.m.sum(),
                "height": kappa / gamma, "chi": kappa**2 / frame.J_P, "f_u": frame.omega_r / (2 * math.pi)}
    assert structure.mode_table.keys() == expected.keys()
    for column, values in expected.items():
        np.testing.assert_allclose(structure.mode_table[column], values, rtol=1e-8, err_msg=column)
    momentum = 1 - 2 * frame.m_t * frame.B**2 / frame.J_P
    for number, value in {"S_1": frame.S_1, "J_P": frame.J_P, "m_t": frame.m_t, "r": frame.r or momentum}.items():
        assert structure.derived[number] == pytest.approx(value, rel=1e-12), number
    assert ("r is not given" in str(structure)) == (frame.r is None)


def test_p_delta_subtracts_the_weights_above_from_the_storeys(exporter, tmp_path):
    drift = np.eye(3) - np.eye(3, k=-1)
    weights = 9.81 * drift.T @ np.diag((np.triu(np.ones((3, 3))) @ FRAME.m) / np.diff(FRAME.h, prepend=0)) @ drift
    squares = eigh(FRAME.K - weights, np.diag(FRAME.m), eigvals_only=True)
    structure = of_storeys(p_delta=True)
    np.testing.assert_allclose(structure.mode_table["f"], np.sqrt(squares) / (2 * math.pi), rtol=1e-12)
    assert structure.replace(p_delta=False) == of_storeys() and (1 - structure.mode_table["f"] / FRAME.omega * 2 * math.pi > 1e-3).all()
    (tmp_path / "frame.toml").write_text("p_delta = true\n" + toml(FRAME))
    describe = [exporter, "describe", "--parameters", tmp_path / "frame.toml"]
    assert subprocess.check_output(describe, text=True) == str(structure)


def test_three_ways_and_a_file_are_one_structure(exporter, tmp_path):
    storeys = of_storeys()
    matrices = fr.Structure.from_matrices(FRAME.masses, FRAME.heights, FRAME.K, zeta=[0.02] * 3, **BASE)
    for other in (matrices, of_modes()):
        for column, values in storeys.mode_table.items():
            np.testing.assert_allclose(other.mode_table[column], values, rtol=1e-10, err_msg=column)
        assert other.derived == pytest.approx(storeys.derived, rel=1e-13)
    (tmp_path / "frame.toml").write_text(toml(FRAME))
    describe = [exporter, "describe", "--parameters", tmp_path / "frame.toml"]
    assert subprocess.check_output(describe, text=True) == str(storeys)
    listed = {of["name"]: of["value"] for of in json.loads(subprocess.check_output([*describe, "--format", "json"]))}
    assert listed["f_u[3]"] == storeys.mode_table["f_u"][2]
    (tmp_path / "frame.toml").write_text(toml(FRAME) + "[ground]\nf_v = 12\n")
    on_ground = {of["name"]: of["value"] for of in json.loads(subprocess.check_output([*describe, "--format", "json"])) if "[" not in of["name"]}
    with pytest.warns(UserWarning, match="^r = 0.93 is not used on ground that gives"):
        soft = storeys.replace(ground=fr.Ground(f_v=12))
    assert soft.derived == on_ground and {"k_v", "f_g", "y_s"} <= {*on_ground}
    large = {**BASE, "m0": FRAME.m0 / 1e3, "J0": FRAME.J0 / 1e3, "units": "kN, m, t"}
    tonnes = FRAME.m / 1e3
    modes = {"masses": tonnes, **{name: MODES[name] / 1e3 for name in ("mass", "moment")}}
    for of, same in ((fr.Structure(storeys=[of | {"m": of["m"] / 1e3, "k": of["k"] / 1e3} for of in STOREYS], zeta=0.02, **large), storeys),
                     (fr.Structure.from_matrices(tonnes, FRAME.heights, FRAME.K / 1e3, zeta=[0.02] * 3, **large), matrices),
                     (of_modes(**modes | large), of_modes()),
                     (fr.Structure(preset="mcmanus", m=0.2, P_0=3, k_t=5, units="kN, m, t"), fr.Structure(preset="mcmanus", m=200, P_0=3e3, k_t=5e3))):
        assert of.derived == pytest.approx(same.derived, rel=1e-15, abs=0)


def test_an_fmu_is_the_one_of_the_command_line(exporter, tmp_path):
    (tmp_path / "frame.toml").write_text(toml(FRAME))
    for strings, option in (True, []), (False, ["--no-strings"]):
        subprocess.run([exporter, "export", "--parameters", tmp_path / "frame.toml", *option, "-o", tmp_path / "a.fmu"], check=True)
        fr.export(tmp_path / "b.fmu", of_storeys(), library=tmp_path / "a.fmu", strings=strings)
        assert (tmp_path / "a.fmu").read_bytes() == (tmp_path / "b.fmu").read_bytes()


@pytest.mark.parametrize("structure", [
    lambda: of_storeys(p_delta=True, keep=2), lambda: of_modes(r=None), lambda: of_storeys(zeta={"f": (2, 9), "zeta": 0.05}, ground=fr.Ground(f_v=12), r=None),
    lambda: fr.Structure.from_matrices(FRAME.m, FRAME.h, FRAME.K, zeta=[0.02] * 3, **BASE), lambda: fr.Structure(preset="mcmanus", P_0=500),
    lambda: fr.Structure(preset="mcmanus", ground=fr.Ground(f_v=12)), lambda: of_pier(r=None), lambda: fr.Structure(storeys=pd.DataFrame(STOREYS), zeta=0.02, **BASE),
])
def test_a_file_and_a_pickle_are_the_same_structure(structure, exporter, tmp_path):
    structure, file = structure(), tmp_path / "file.toml"
    structure.write(file)
    assert fr.Structure.read(file) == structure == pickle.loads(pickle.dumps(structure)) == eval(repr(structure), vars(fr))
    assert fr.Structure(**tomllib.loads(file.read_text())) == structure == structure.replace(g=9.81)
    assert subprocess.check_output([exporter, "describe", "--parameters", file], text=True) == str(structure)


def of_pier(**changes):
    return fr.Structure(**{"m": 4e5, "m0": 1e5, "H": 9, "B": 1.5, "J0": 1e5, "f_fc": 2.5, "zeta_fc": 0.03, **changes})


def test_one_mass_without_r_is_a_storey_without_r():
    pier = of_pier()
    storey = fr.Structure(storeys=[{"m": 4e5, "h": 9, "k": 4e5 * (2 * math.pi * 2.5) ** 2}], zeta=0.03, m0=1e5, J0=1e5, B=1.5)
    one, other = (fr.simulate(of, wavelet()) for of in (pier, storey))
    assert len(one.transitions) > 5 and "a_t" in one.peaks and "r is not given: momentum" in str(pier)
    for name in ("theta", "uplift", "u", "a_t"):
        assert one.peaks[name] == pytest.approx(other.peaks[name if name in other.peaks else f"{name}[1]"], rel=1e-9)
    with pytest.raises(ValueError, match="estimate needs a number r, because Eqs 10 to 24 have one"):
        fr.estimate(pier)


def test_a_structure_of_many_masses_is_a_value():
    structure = of_modes()
    assert pickle.loads(pickle.dumps(structure)) == copy.copy(structure) == structure != of_storeys()
    assert hash(of_storeys()) == hash(of_storeys())
    wide = of_storeys().replace(B=2.0)
    assert wide.B == 2 and wide == of_storeys(B=2.0)
    by_width = of_storeys(B=None, width=4)
    assert by_width.replace(B=1.5) == of_storeys(B=1.5) == wide.replace(width=3)
    pier = fr.Structure(preset="mcmanus", J0=10).replace(ground=fr.Ground(f_v=40))
    assert pickle.loads(pickle.dumps(pier)) == pier == fr.Structure(preset="mcmanus", J0=10, ground={"f_v": 40}) and "r" not in pier.parameters
    assert of_storeys(r=0.9).replace(r=None) == of_storeys(r=None) != of_storeys(r=0.9)
    masses = np.array(FRAME.masses)
    kept = fr.Structure.from_matrices(masses, FRAME.heights, FRAME.K, zeta=0.02, **BASE)
    masses[0] = 1
    assert kept.replace(r=1).m_s == kept.m_s


@pytest.mark.parametrize("refused, text", [
    (lambda: of_storeys(storeys=[{"m": 1, "h": 2}]), "missing field `k`; in `storeys`"),
    (lambda: of_storeys(storeys=[{"m": 1, "h": 2, "k": "stiff"}]), "storeys[1].k = 'stiff': it is no number"),
    (lambda: of_storeys(zeta={"f": [1], "zeta": 1}), "{f = [Hz, Hz], zeta = number} for Rayleigh damping"),
    (lambda: of_modes(f=[1, 2, 3]), "mode 1 needs f (Hz) or period (s), and not both"),
    (lambda: of_modes(zeta=None), "missing field `zeta`"),
    (lambda: of_modes(masses=FRAME.m[:2]), "heights has 3 numbers and must have 2, one for each mass"),
    (lambda: of_modes(m_s=110e3), "missing field `S_1`; in `total`"),
    (lambda: of_modes(shapes=FRAME.phi[:, :2]), "shapes has 2 columns and must have 3, one for each mode"),
    (lambda: fr.Structure.from_matrices([1], [1], [1, 2], zeta=0), "K has the shape [2]: two dimensions are needed"),
    (lambda: of_storeys(kep=2), "did you mean keep?"),
    (lambda: of_storeys(zeta=None, zeta_fc=0.02), "did you mean zeta?"),
    (lambda: fr.simulate(of_storeys(), wavelet(), theta0=0.1), "did you mean theta_0?"),
    (lambda: fr.Ground(fv=10), "did you mean f_v?"),
    (lambda: fr.Structure(preset="mcmanus", grund=fr.Ground(f_v=10)), "did you mean ground?"),
    (lambda: of_storeys(units="kN, mm, t"), "unknown variant `kN, mm, t`, expected `N, m, kg` or `kN, m, t`"),
    (lambda: of_storeys(p_delta="no"), "p_delta = 'no': True or False is needed"),
    (lambda: of_modes(p_delta=True), "p_delta = true needs storeys"),
    (lambda: of_storeys(keep=2.5), "keep = 2.5: a whole number is needed"),
    (lambda: of_storeys(preset="mcmanus"), "preset is a structure of one mass, and storeys makes one of many"),
    (lambda: fr.Structure(preset="mcmanus", m=[1, 2]), "m = [1, 2]: it is no number"),
    (lambda: of_storeys(storeys=3), "expected a sequence; in `storeys`"),
    (lambda: of_storeys().replace(m0=20, units="kN, m, t"), "units: replace takes SI units"),
    (lambda: fr.Structure(preset="mcmanus", ground=40), "ground = 40: flexible_rocking.Ground(f_v=...) is needed"),
    (lambda: of_storeys().effective_frequency(0.1), "effective_frequency needs a structure of one mass, because Eqs 10 to 24 have one mode"),
    (lambda: fr.Structure(preset="mcmanus").mode_table, "mode_table needs a structure of many masses"),
    (lambda: fr.simulate(of_storeys(), wavelet()).spectrum(4), "floor = 4 is out of range: the structure has floors 1 to 3"),
    (lambda: fr.simulate(of_storeys(), wavelet()).spectrum("top"), "floor = 'top': a whole number is needed"),
    (lambda: fr.simulate(of_storeys(), wavelet()).plot("heights"), "kind = 'heights' is unknown"),
    (lambda: fr.sweep(of_storeys(), wavelet(), u_dot_0=[0.1] * 9), "0.1] m/s: the structure has 3 floors"),
])
def test_what_is_refused_is_named(refused, text):
    with pytest.raises(ValueError) as error:
        refused()
    assert text in str(error.value)


def wavelet(amplitude=6.0):
    t = np.arange(301) * 0.01
    return fr.Record(t, amplitude * np.sin(2 * np.pi * 1.1 * t) * np.sin(np.pi * t / 3), 0.2 * amplitude * np.sin(20 * t))


def building():
    """Ten storeys that rock under the wavelet."""
    storeys = [{"m": m, "h": h, "k": k} for m, h, k in zip(TALL.masses, TALL.heights, TALL.stiffness)]
    return fr.Structure(storeys=storeys, zeta=TALL.zeta, m0=TALL.m0, J0=TALL.J0, B=TALL.B, r=TALL.r)


@pytest.fixture(scope="module")
def run():
    return fr.simulate(building(), wavelet())


def test_the_floors_of_a_building_hang_together(run):
    assert run.overturned is False and len(run.transitions) > 5 and run.peaks["uplift"] > 0.01
    response = run.at(np.linspace(run.start, run.end, 5001))
    floors = range(1, 11)
    of = lambda name: np.array([response[f"{name}[{i}]"] for i in floors])
    shear = 3e4 * np.cumsum(of("a_t")[::-1], axis=0)[::-1]
    close = lambda one, other: np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())
    close(of("V"), shear)
    close(of("M"), 3.0 * np.cumsum(shear[::-1], axis=0)[::-1])
    close(of("drift"), np.diff(of("u"), axis=0, prepend=0))
    close(response["V[1]"], response["V_t"])
    close(response["M[1]"], response["M_t"])
    profile = run.profile.to_pandas()
    assert list(profile.index) == list(floors) and list(profile["h"]) == [3.0 * i for i in floors]
    for name in ("u", "drift", "delta_t", "a_t", "V", "M"):
        assert list(profile[name]) == [run.peaks[f"{name}[{i}]"] for i in floors]
    moved = run.transitions.to_pandas()
    assert {"u[10]_before", "u_dot[10]_after", "theta_after"} < set(moved.columns) and len(moved) == len(run.transitions)


def test_the_spectrum_of_a_floor_is_that_of_its_acceleration(run):
    periods = [0.03, 0.1, 0.3, 1.0]
    times = np.linspace(run.start, run.end, 100_001)
    with pytest.warns(UserWarning, match="is the time in another unit"):
        fine = fr.Record(times, run.at(times)["a_t[10]"]).spectrum(periods, zeta=0.02)
    np.testing.assert_allclose(run.spectrum(10, periods, zeta=0.02)["S_a"], fine, rtol=2e-4)
    usual = run.spectrum(10)
    assert usual["period"][[0, -1]] == pytest.approx([0.02, 4]) and len(usual["S_a"]) == 100


def test_pictures_of_a_building_show_its_top_and_its_height(run, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    assert [axis.get_ylabel() for axis in run.plot().axes][2:] == ["$u$[10] (mm)", "$a_{t}$[10] (g)"]
    axes = run.plot("profile").axes
    assert [line.get_label() for line in axes[0].lines] == ["rocking", "fixed base"]
    fixed = fr.simulate(building(), wavelet(), detail="fixed_base", duration=run.end - run.start)
    np.testing.assert_allclose(axes[0].lines[1].get_xdata()[1:], fixed.profile["a_t"] / 9.81)
    in_si = {"acceleration (g)": ("a_t", 9.81), "drift (mm)": ("drift", 1e-3), "storey shear (kN)": ("V", 1e3), "storey moment (kN.m)": ("M", 1e3)}
    assert [axis.get_xlabel() for axis in axes] == list(in_si)
    for axis, (name, size) in zip(axes, in_si.values()):
        largest = max(of.profile[name].max() for of in (run, fixed)) / size
        assert largest < axis.get_xlim()[1] < 1.5 * largest
    bare = of_modes(masses=None, heights=None, shapes=None, m_s=110e3, S_1=FRAME.S_1, I_2=FRAME.m @ FRAME.h**2)
    bare = fr.simulate(bare, wavelet())
    assert len(bare.profile["h"]) == 0 and len(bare.plot().axes) == 2
    assert "base shear" in bare.page()
    with pytest.raises(ValueError, match="no floors"):
        bare.plot("profile")
    with pytest.raises(ValueError, match="floor = 1 is out of range: the structure has no floors; give masses, heights and shapes"):
        bare.spectrum(1)
    assert "floor " not in str(bare)
    tipped = fr.simulate(building(), wavelet(), theta_0=0.02)
    fixed = fr.simulate(building(), wavelet(), detail="fixed_base", duration=tipped.end - tipped.start)
    drawn = json.loads(re.search(r'"fixed":(\[.*?\]\])', tipped.page())[1])
    assert {name: (value, time) for name, value, time in drawn} == {name: (peak.value, peak.time) for name, peak in fixed.peaks.items()}


def test_the_command_line_shows_a_building_as_the_module_does(run, exporter, tmp_path):
    (tmp_path / "building.toml").write_text(toml(TALL))
    run.record.write(tmp_path / "record.csv", record_v=tmp_path / "v.csv")
    record = fr.Record.read(tmp_path / "record.csv", record_v=tmp_path / "v.csv")
    run = fr.simulate(run.structure, record)
    simulate = [exporter, "simulate", "--parameters", "building.toml", "--record", "record.csv", "--record-v", "v.csv"]

    files = ["-o", "response.csv", "--picture", "run.svg", "--profile", "profile.svg"]
    text = subprocess.run([*simulate, *files], cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert text.split("\n", 1)[1] == str(run).split("\n", 1)[1] + "\n"
    expected = run.at(run.start)
    assert list(pd.read_csv(tmp_path / "response.csv", nrows=1)) == [
        name if name in ("phase", "transitions") else f"{name}[{expected.units[name]}]" for name in expected]
    subprocess.run([exporter, "view", *simulate[2:], "-o", "view.html"], cwd=tmp_path, check=True)
    assert (tmp_path / "view.html").read_text() == run.page() and "<iframe" in run._repr_html_()
    assert "a_t[10]" in (tmp_path / "run.svg").read_text() and "storey moment" in (tmp_path / "profile.svg").read_text()
