"""Uses all of the module as users do, for mypy --strict."""

import pickle
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from flexible_rocking import formats
from matplotlib.axes import Axes


def use_all(folder: Path) -> None:
    time = np.linspace(0, 4, 401)
    table = pd.DataFrame({"time": time, "a_g": 0.6 * np.sin(4 * np.pi * time) * (time < 0.5)})
    ground = fr.Record(table["time"], table["a_g"], unit="g", title="sine")
    ground.write(folder / "sine.csv")
    assert fr.Record.read(folder / "sine.csv").scaled(1.0, time_scale=1.0).pga == ground.pga
    assert fr.Record(0.01, ground.a_g).duration == 4.0 and len(ground) == 401 and ground.pgv > 0
    spectrum: np.ndarray = ground.spectrum([0.1, 0.2], zeta=0.02)
    assert spectrum.shape == (2,) and hash(ground)

    pier = fr.Structure(weight=4e6, m0=1e5, alpha_cg=0.2, B=1.5, period_fc=0.4, zeta_fc=0.03, r=0.95)
    wall = fr.Structure(preset="evison").replace(f_fc=8.0)
    assert pier.H > pier.B and pier.derived["chi"] < 1 and wall.parameters["f_fc"] == 8.0
    assert wall.effective_frequency(0.04) > 0 and wall.pushover(points=3)["P"].shape == (6,)

    base = {"m0": 2e4, "J0": 3e4, "B": 1.5}
    shear = fr.Structure(storeys=[{"m": 4e4, "h": 3.5, "k": 6e7}], zeta={"f": (2.0, 9.0), "zeta": 0.02}, **base)
    bent = fr.Structure.from_matrices([4e4], [3.5], [[6e7]], zeta=[0.02], r=0.9, **base)
    found = fr.Structure.from_modes(mass=[4e4], f=[6.2], height=[3.5], zeta=0.02, masses=[4e4], heights=[3.5], **base)
    assert shear.mode_table["f"].shape == (1,) and bent.r == 0.9 and found.derived["m_s"] == 4e4

    run = fr.simulate(wall, ground, detail="auto", tolerance=1e-9, theta_0=0.01)
    theta: fr.Peak = run.peaks["theta"]
    assert float(theta) == theta.value and theta.time > 0 and theta.unit == "rad" and not run.overturned
    first = run.transitions[0]
    rows_of_transitions: pd.DataFrame = run.transitions.to_pandas()
    assert f"{theta:.3f}" and theta > 0 and len(rows_of_transitions) == len(run.transitions) and fr.__version__
    assert first.kind and first.time > 0 and first.before["theta"] != 1 and first.after["theta"] != 1
    response = run.at(np.linspace(0, 4, 401))
    frame: pd.DataFrame = response.to_pandas()
    assert response.units["theta"] == "rad" and len(frame) == 401 and wall.modes(response)["q_r"].shape == (401,)
    assert run.validity_within(friction=0.7)["mu_required"].limit == 0.7 and run.ending and run.fall is None and run.steps and run.evaluations
    assert "<html" in run.page() and run.detail == "auto" and run.tolerance == 1e-9 and run.start < run.end
    assert pickle.loads(pickle.dumps(run)).structure == run.structure == wall and run.record == ground
    run.plot().savefig(folder / "run.svg")

    advice = fr.advise(wall, ground, within=0.1, of=["theta", "a_t"])
    assert advice.detail is None or advice.levels
    assert fr.estimate(wall, ground, amplification=1.5)["C"] == 1.5
    pulses = {f"{frequency} Hz": fr.pulse("cosine", amplitude=0.4, frequency=frequency) for frequency in (1.5, 2.0, 3.0, 4.0, 5.0)}
    walls = [wall, wall.replace(f_fc=11)]
    rows = fr.sweep({"walls": walls}, pulses, scale=np.linspace(0.5, 3, 8), intensity="PGA", path=folder / "rows.csv")
    curve = fr.fragility(rows, "theta/alpha_cg >= 0.1")
    assert curve.median > 0 and curve.dispersion > 0 and curve.curve.median_range and curve.probability([1.0]).shape == (1,)
    axes: Axes = curve.plot()
    formats.write_pelicun(folder / "walls.csv", {"walls": curve})
    formats.write_openquake(folder / "walls.xml", {"walls": {"rocks": curve}})
    assert axes.get_ylabel() == "probability"
    pulses["2.0 Hz"].write(folder / "pulse.csv")
    fr.export(folder / "wall.fmu", wall, record=[ground, folder / "pulse.csv"], name="Wall", fmi=3)
    assert fr.fmu().exists()
