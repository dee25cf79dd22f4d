"""The value of a number at which limits hold: against sweeps, and the command line."""

import subprocess

import flexible_rocking as fr
import numpy as np
import pandas as pd
import pytest

WALL = fr.Structure(preset="evison", J0=1.2)
PULSES = {name: fr.pulse("sine", amplitude=amplitude, frequency=frequency) for name, amplitude, frequency in
          (("a.csv", 0.45, 3), ("b.csv", 0.3, 1.5), ("c.csv", 0.6, 4))}


@pytest.mark.parametrize("structure, vary, between, share, with_value", [
    (WALL, "P_0", (0, 5e3), 0.7, lambda value: WALL.replace(P_0=value)), (WALL, "slenderness", (2.5, 5), 0.6, lambda value: WALL.replace(H=value * WALL.B)),
    (WALL.replace(ground=fr.Ground(f_v=25, zeta_v=0.2)), "f_v", (5, 60), 0.6, lambda value: WALL.replace(ground=fr.Ground(f_v=value, zeta_v=0.2))),
], ids=["tendon", "slenderness", "ground"])
def test_the_curve_is_that_of_a_sweep(structure, vary, between, share, with_value):
    found = fr.design(structure, PULSES, vary, between, ["theta <= 4 %", "a_t <= 1.2 g"], share=share, count=7, refine=2)
    runs = fr.sweep([with_value(value) for value in found.curve.iloc[:, 0]], PULSES)
    is_within = (runs["peak_theta[rad]"] < 0.04) & (runs["peak_a_t[m/s2]"] < 1.2 * 9.81) & (runs["ending"] != "overturned")
    within = is_within.to_numpy().reshape(-1, 3).mean(1)
    assert found.curve["within"].tolist() == within.tolist() and found.curve["holds"].tolist() == (within >= share).tolist()
    assert len(found.crossings) == np.abs(np.diff(within >= share)).sum() > 0 and found.plot().get_xlabel().startswith(vary)
    assert found.structure == (with_value(found.value) if found.value else None)


def test_a_design_is_that_of_the_command_line(exporter, tmp_path):
    for name, record in PULSES.items():
        record.write(tmp_path / name)
    WALL.write(tmp_path / "wall.toml")
    (tmp_path / "slender.toml").write_text("records = ['?.csv']\n[design]\nvary = 'slenderness'\nbetween = [2.5, 5]\nlimit = ['theta <= 4 %', 'stands']\n"
                                       "share = 0.6\ncount = 5\n[[structures]]\nname = 'wall'\nfile = 'wall.toml'\n")
    command = [exporter, "--quiet", "design", "slender.toml", "-o", "curve.txt", "--picture", "curve.svg"]
    printed = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    found = fr.design(WALL, [tmp_path / name for name in PULSES], "slenderness", (2.5, 5), ["theta <= 4 %", "stands"], share=0.6, count=5)
    assert printed.splitlines()[0] == str(found)
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "curve.txt"), found.curve, check_exact=True)


def test_what_has_no_meaning_is_refused_by_name():
    for options, text in (({"share": 84}, r"share = 84\.0 is out of range"), ({"between": (1, 1)}, r"between = 1\.0, 1\.0: P_0 needs two rising"),
                          ({"vary": "f_v"}, '"f_v" cannot vary: these can: m, '), ({"limit": "theta >= 3 deg"}, "MEASURE <= VALUE or stands is needed"),
                          ({"records": [PULSES["a.csv"]] * 2}, "two ground motions have the name|are the same")):
        with pytest.raises(ValueError, match=text):
            fr.design(**{"structure": WALL, "records": PULSES, "vary": "P_0", "between": (0, 1e3), "limit": "theta <= 3 deg"} | options)
