"""Structures of many masses as users give them: three ways in Python and in files, against modes by scipy."""

import copy
import json
import math
import pickle
import subprocess

import numpy as np
import pytest
from frames import FRAMES

fr = pytest.importorskip("flexible_rocking", reason="flexible_rocking is not installed: `make python` does it")

pytestmark = pytest.mark.heavy

FRAME = FRAMES["frame"]
BASE = {"m0": FRAME.m0, "J0": FRAME.J0, "B": FRAME.B, "r": FRAME.r}
STOREYS = [{"m": m, "h": h, "k": k} for m, h, k in zip(FRAME.masses, FRAME.heights, FRAME.stiffness, strict=True)]


def of_storeys(**changes):
    return fr.Structure(**{"storeys": STOREYS, "zeta": 0.02, **BASE, **changes})


def of_modes(kept=3, **changes):
    gamma, kappa = FRAME.m @ FRAME.phi, FRAME.m * FRAME.h @ FRAME.phi
    modes = {"period": 2 * math.pi / FRAME.omega, "mass": gamma**2, "moment": gamma * kappa, "shapes": (5 * FRAME.phi).T}
    modes = {name: np.asarray(values)[:kept].T for name, values in modes.items()}
    return fr.Structure.from_modes(**{**modes, "masses": FRAME.m, "heights": FRAME.h, "zeta": 0.02, **BASE, **changes})


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


def test_three_ways_and_a_file_are_one_structure(exporter, tmp_path):
    storeys = of_storeys()
    matrices = fr.Structure.from_matrices(FRAME.masses, FRAME.heights, FRAME.K, zeta=[0.02] * 3, **BASE)
    for other in (matrices, of_modes()):
        for column, values in storeys.mode_table.items():
            np.testing.assert_allclose(other.mode_table[column], values, rtol=1e-10, err_msg=column)
        assert other.derived == pytest.approx(storeys.derived, rel=1e-13)
    tables = [f"[[storeys]]\nm = {of['m']}\nh = {of['h']}\nk = {of['k']}\n" for of in STOREYS]
    base = "".join(f"{name} = {value}\n" for name, value in BASE.items())
    (tmp_path / "frame.toml").write_text("zeta = 0.02\n[base]\n" + base + "".join(tables))
    describe = [exporter, "describe", "--parameters", tmp_path / "frame.toml"]
    assert subprocess.check_output(describe, text=True) == str(storeys)
    listed = {of["name"]: of["value"] for of in json.loads(subprocess.check_output([*describe, "--format", "json"]))}
    assert listed["f_u[3]"] == storeys.mode_table["f_u"][2]


def test_modes_left_out_are_told():
    assert "modes carry 97.66 % of m_s, 99.59 % of S_1, 99.94 % of I_2; the rest turns with the base" in str(of_modes(2))


def test_a_structure_of_many_masses_is_a_value():
    structure = of_modes()
    assert pickle.loads(pickle.dumps(structure)) == copy.copy(structure) == structure != of_storeys()
    assert hash(of_storeys()) == hash(of_storeys())
    wide = of_storeys().replace(B=2.0)
    assert wide.B == 2 and wide == of_storeys(B=2.0)
    masses = np.array(FRAME.masses)
    kept = fr.Structure.from_matrices(masses, FRAME.heights, FRAME.K, zeta=0.02, **BASE)
    masses[0] = 1
    assert kept.replace(r=1).m_s == kept.m_s


@pytest.mark.parametrize("refused, text", [
    (lambda: of_storeys(zeta=[0.02]), "zeta has 1 numbers and must have 3, one for each mode"),
    (lambda: of_storeys(storeys=[{"m": 1, "h": 2}]), "storey 1 = {'m': 1, 'h': 2}: dict(m=..., h=..., k=...) is needed"),
    (lambda: of_storeys(storeys=[{"m": 1, "h": 2, "k": "stiff"}]), "storey 1: k = 'stiff': it is no number"),
    (lambda: of_storeys(zeta={"f": [1], "zeta": 1}), "dict(f=(Hz, Hz), zeta=...) is needed"),
    (lambda: of_storeys(H=3), "base: H is a number of a structure of one mass"),
    (lambda: of_storeys(mass=[1, 2]), "give the structure in one way"),
    (lambda: of_modes(f=[1, 2, 3]), "mode 1 needs f (Hz) or period (s), and not both"),
    (lambda: of_modes(zeta=None), "zeta (damping ratio in full contact) is missing"),
    (lambda: of_modes(masses=FRAME.m[:2]), "heights has 3 numbers and must have 2, one for each mass"),
    (lambda: of_modes(m_s=110e3), "S_1 (kg.m) is missing"),
    (lambda: of_modes(shapes=FRAME.phi[:, :2]), "shapes has 2 columns and must have 3, one for each mode"),
    (lambda: fr.Structure.from_matrices([1], [1], [1, 2], zeta=0), "K has the shape [2]: two dimensions are needed"),
    (lambda: of_storeys().pushover(), "pushover needs a structure of one mass, and this structure has 3 modes"),
    (lambda: fr.export("a.fmu", of_storeys()), "export needs a structure of one mass"),
    (lambda: fr.Structure(preset="mcmanus").mode_table, "mode_table needs a structure of many masses"),
])
def test_what_is_refused_is_named(refused, text):
    with pytest.raises(ValueError) as error:
        refused()
    assert text in str(error.value)
