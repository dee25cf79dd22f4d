"""The peaks that several commands print are the same in all of them. Under the first record the structure overturns."""

import json
import math
import re
from functools import partial

import numpy as np
import pandas as pd
import pytest
from evidence.scenes import RECORDS
from host import output, write


@pytest.mark.parametrize("pattern, scale", [("*PUL254*", 1.0), ("*ELC180*", 1.461)])
def test_simulate_advise_sweep_and_view_have_the_same_peaks(exporter, tmp_path, pattern, scale):
    record, run = next(RECORDS.glob(f"*/{pattern}.AT2")), partial(output, exporter, cwd=tmp_path)
    write(tmp_path / "push.csv", "", time := 0.0973 * np.arange(80), 100 * np.sin(time), heading="time[s],F_t[N]")
    ground = ["--record", record, "--force", "push.csv", "--scale", scale]
    simulated = {of["name"]: of["peak"] for of in json.loads(run("simulate", *ground, "--format", "json"))["peaks"]}
    advised = re.search(r"peaks: (.*)", run("advise", *ground))[1].split(", ")
    assert len(advised) == 5
    for name, number, unit in map(str.split, advised):
        size = {"mm": 1e-3, "g": 9.81, "kN": 1e3, "kN.m": 1e3}.get(unit, 1.0)
        assert float(number) * size == pytest.approx(simulated[name], rel=5e-6)
    (tmp_path / "one.toml").write_text(f'scale = [{scale}]\n[[records]]\nfile = "{record}"\nforce = "push.csv"\n'
                                       '[[structures]]\nname = "one"\npreset = "mcmanus"\n')
    run("sweep", "one.toml", "-o", "rows.csv")
    swept = pd.read_csv(tmp_path / "rows.csv").filter(like="peak_").rename(columns=lambda name: re.sub(r"peak_|\[.*", "", name)).iloc[0]
    assert len(swept) > 7 and swept[swept.index.intersection(simulated)].to_dict().items() <= simulated.items()
    run("view", *ground, "-o", "view.html")
    scene = json.loads(re.search(r'<script[^>]*id="data"[^>]*>(.*?)</script>', (tmp_path / "view.html").read_text(), re.DOTALL)[1])
    viewed = {name: magnitude for name, magnitude, _ in scene["peaks"]}
    assert len(viewed) > 7 and viewed.items() <= simulated.items()


def test_the_errors_of_advice_are_those_of_the_runs(exporter, tmp_path):
    """Under a sine that lifts and lands the specimen, every 0.2 ms."""
    run = partial(output, exporter, cwd=tmp_path)
    run("pulse", "sine", "--amplitude", 0.6, "--period", 0.5, "--preset", "mcmanus", "-o", "sine.csv")
    ground = ["--record", "sine.csv", "--preset", "mcmanus"]
    table = run("advise", *ground, "--duration", 4)
    rows = {row[0]: row[1:] for line in table.splitlines() if (row := line.removeprefix(">").split())}

    def seen(detail, tolerance):
        scene = ["simulate", *ground, "--duration", 4, "--detail", detail, "--tolerance", tolerance]
        run(*scene, "--interval", 2e-4, "-o", "run.csv")
        return pd.read_csv(tmp_path / "run.csv")[["theta[rad]", "u[m]", "a_t[m/s2]"]]

    exact = seen("nonlinear", 1e-12)
    largest = exact.abs().max()
    for detail in ("fixed_base", "rigid", "modal", "linear"):
        found = seen(detail, 1e-9)
        errors = [*((found.abs().max() - largest).abs() / largest), *((found - exact).abs().max() / largest)]
        assert [float(shown) for shown in rows[detail][:6]] == pytest.approx([100 * error for error in errors], rel=5e-3, abs=0.02), detail
        scene = ["simulate", *ground, "--duration", 4, "--detail", detail, "--format", "json", "--quiet"]
        simulated = json.loads(run(*scene))
        assert rows[detail][7:9] == [str(simulated[name]) for name in ("steps", "evaluations")]
    alpha = float(re.search(r"alpha_cg +(\S+)", run("describe", "--preset", "mcmanus"))[1])
    amplitude = largest["theta[rad]"] / math.tan(alpha)
    estimate = run("estimate", *ground, "--amplitudes", amplitude)
    a_t = float(re.search(r"a_t +(\S+) m/s2", estimate)[1])
    assert float(rows["estimate"][2]) == pytest.approx(100 * abs(a_t / largest["a_t[m/s2]"] - 1), rel=2e-3)
    f_r, shown = re.search(r"f_r\S+ +(\S+) Hz", estimate)[1], re.search(r"at that theta: (\S+) Hz", table)[1]
    assert float(shown) == pytest.approx(float(f_r), rel=1e-5)
