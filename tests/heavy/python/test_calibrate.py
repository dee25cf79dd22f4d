"""Noisy histories of known structures give back their numbers."""

import re
import sys

import flexible_rocking as fr
import numpy as np
import pandas as pd
import pytest

WALL = fr.Structure(preset="evison", J0=1.2)
ON_CLAY = WALL.replace(ground=fr.Ground(f_v=25, zeta_v=0.15))
NOISE = {"uplift": 1e-4, "settlement": 1e-4, "theta": 2e-4, "a_t": 0.3}


def traces(structure, names, seed, record=None, duration=1.0, **initial):
    t, draw = np.arange(0, duration, 0.005), np.random.default_rng(seed)
    motion = fr.simulate(structure, record, duration=duration, **initial).at(t)
    return {name: (t, motion[name] + draw.normal(0, NOISE[name], len(t))) for name in names}


@pytest.mark.parametrize("true, guess, names, fit, initial", [
    (WALL, dict(r=0.9, zeta_fc=0.03, f_fc=9), ["uplift", "a_t"], ("r", "zeta_fc", "f_fc"), dict(theta_0=0.04, u_0=WALL.u_cr)),
    (ON_CLAY, dict(ground=fr.Ground(f_v=35, zeta_v=0.3)), ["theta", "settlement"], ("f_v", "zeta_v"), dict(theta_0=0.03)),
], ids=["snap-back", "ground"])
def test_95_percent_intervals_have_the_numbers_in_about_19_of_20_seeds(true, guess, names, fit, initial):
    inside = dict.fromkeys(fit, 0)
    for seed in range(20):
        found = fr.calibrate(true.replace(**guess), traces(true, names, seed, **initial), fit=fit, **initial)
        table = found.to_pandas()
        assert (table.high - table.low < 0.1 * table.value).all() and not found.notes
        assert found.structure.parameters == true.replace(**{of: value for of, value in found.values.items() if true is WALL},
                                                          **({} if true is WALL else {"ground": found.values})).parameters
        for name in fit:
            inside[name] += table.low[name] <= getattr(true, name) <= table.high[name]
    assert sum(inside.values()) >= 0.9 * 20 * len(fit), inside


def test_the_ratio_of_amplitudes_and_the_last_vibration_give_start_values():
    found = fr.calibrate(WALL.replace(r=0.9, zeta_fc=0.03, f_fc=9), traces(WALL, ["uplift", "a_t"], 0, duration=6, theta_0=0.04, u_0=WALL.u_cr),
                         fit=("r", "zeta_fc", "f_fc", "theta_0", "u_0")).to_pandas()
    for name, within in {"r": 0.005, "f_fc": 0.02, "zeta_fc": 0.2}.items():
        assert abs(found.start[name] / getattr(WALL, name) - 1) < within and found.low[name] < getattr(WALL, name) < found.high[name]


def test_each_trace_may_have_its_own_clock_and_zero_under_a_record():
    ground = fr.pulse("ricker", amplitude=0.6, frequency=2)
    measured = traces(WALL, ["uplift", "a_t"], 1, ground, duration=2.0)
    late = pd.Series(measured["uplift"][1] + 1e-3, index=measured["uplift"][0] + 12.3)
    found = fr.calibrate(WALL.replace(r=0.9), measured | {"uplift": late}, ground, start=True, offset=True)
    table, true = found.to_pandas(), {"r": WALL.r, "start[uplift]": -12.3, "offset[uplift]": 1e-3, "start[a_t]": 0.0}
    for name, value in true.items():
        assert abs(table.value[name] - value) < 2 * (table.high[name] - table.low[name]) and table.high[name] - table.low[name] < 3e-3, name
    assert [axis.get_ylabel() for axis in found.plot().axes[::2]] == ["uplift (m)", "a_t (m/s2)"]


def test_a_number_that_the_traces_do_not_determine_is_named():
    down = fr.calibrate(WALL, traces(WALL, ["a_t"], 2, u_0=0.9 * WALL.u_cr), fit=("r", "zeta_fc"), u_0=0.9 * WALL.u_cr)
    assert down.notes == ["the traces do not determine r: half its interval is inf"] and down.values["r"] == WALL.r
    assert re.search(r"^r +0.96 +-inf +inf", str(down), re.MULTILINE)
    rocks = traces(WALL, ["a_t"], 3, duration=0.15, theta_0=0.04)  # the damper's constant alone, before the first impact
    alike = fr.calibrate(WALL, rocks, fit=("zeta_fc", "c_ratio"), theta_0=0.04)
    assert len(alike.notes) == 3 and "c_ratio and zeta_fc move the traces alike: correlation -1.000; fix one of them, or add a trace" in alike.notes
    stiffer = traces(WALL.replace(H=1.2), ["uplift"], 4, theta_0=0.04)
    assert any(note.startswith("the residuals of uplift follow each other") for note in fr.calibrate(WALL, stiffer, fit=["r"], theta_0=0.04).notes)


@pytest.mark.parametrize("given, options, text", [
    ({"tehta": ([0, 1], [1, 2])}, {}, "traces: 'tehta' is unknown, or the structure does not have it: choose from a_g, theta, u,"),
    ({}, {}, "traces: 'nothing' is unknown"), ({"theta": ([0, 1], [1, 2])}, {"fit": ["f_v"]}, "fit: 'f_v' is unknown"),
    ({"theta": pd.Series([1.0, np.nan])}, {}, "traces: theta needs finite values"), ({"theta": ([0, 0], [1, 2])}, {}, "at times that rise"),
    ({"theta": ([0, 1], [1])}, {}, r"traces: theta has times of the shape \(2,\) and values of \(1,\)"),
    ({"theta": ([0, 1], [1, 2])}, {"fit": ["P_0"]}, "P_0 = 0 is no start value"), ({"theta": ([0, 1], [0.1, 0.2])}, {}, "2 samples are too few for 3 numbers"),
])
def test_what_cannot_be_fitted_is_refused_by_name(given, options, text):
    with pytest.raises(ValueError, match=text):
        fr.calibrate(WALL, given, theta_0=0.1, **options)


def test_scipy_is_asked_for(monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy", None)
    with pytest.raises(ImportError, match=r"scipy is missing: run pip install .flexible-rocking\[all\]."):
        fr.calibrate(WALL, {"theta": ([0, 1], [1, 2])})
