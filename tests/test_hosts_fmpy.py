"""fmpy in all its ways, over Pacoima Dam: with the record inside, and with a_g passed on as far as fmpy can."""

import re
import sys
from html import unescape
from pathlib import Path

import fmpy
import numpy as np
import pytest
from evidence.scenes import PACOIMA_DAM
from fmpy.util import read_csv
from host import events, output, simulate
from pacoima import A_G, END, OUTPUTS, STEP, STEPS, TIME, distance, held, rows

INPUT = np.rec.fromarrays([TIME, A_G], names="time,a_g")


@pytest.mark.parametrize("step", STEPS)
def test_the_record_inside(shaken, mcmanus, pacoima_record, exact, tmp_path, step):
    """By simulate_fmu, and by the command line."""
    result, messages = simulate(shaken["mcmanus"], stop_time=END, output_interval=step, output=OUTPUTS)
    assert len(events(messages)) == 31
    output(sys.executable, "-m", "fmpy", "simulate", mcmanus.path, "--start-values", "record", pacoima_record,
           "--output-file", "out.csv", "--stop-time", END, "--output-interval", step, cwd=tmp_path)
    for found in (result, read_csv(tmp_path / "out.csv")):
        assert distance(rows(found), exact(step)) < 1e-9


def test_simulate_fmu_holds_inputs(mcmanus):
    result, messages = simulate(mcmanus, stop_time=TIME[-1], output_interval=STEP, input=INPUT, output=OUTPUTS)
    assert len(events(messages)) == 31
    assert distance(rows(result), held(mcmanus)) < 1e-10


def test_simulate_fmu_cannot_pass_slopes_on(mcmanus):
    """fmpy 0.3.23 to 0.3.32 make room for nine slopes, whatever the number of inputs."""
    with pytest.raises(ValueError, match="Can only assign sequence of same size"):
        fmpy.simulate_fmu(mcmanus.path, stop_time=1.0, input=INPUT, set_input_derivatives=True)


def test_the_script_of_the_page_inside_runs(mcmanus):
    page = (Path(mcmanus.folder) / "documentation" / "index.html").read_text()
    script = unescape(re.search(r"<pre>(from fmpy.*?)</pre>", page, re.DOTALL)[1])
    script = script.replace("FlexibleRocking.fmu", mcmanus.path).replace("/data/RSN77_SFERN_PUL164.AT2", PACOIMA_DAM["record"])
    peak, instant = map(float, re.fullmatch(r"(\S+) rad at (\S+) s\n", output(sys.executable, "-c", script)).groups())
    assert peak == pytest.approx(0.01200009, abs=5e-9) and 0 < instant < 4


def test_a_run_goes_on_from_bytes(shaken, exact):
    """simulate_fmu with fmu_instance to the middle; from its serialized state to the end."""
    fmu, step, middle = shaken["mcmanus"], 2e-3, 2.0
    arguments = dict(output_interval=step, output=OUTPUTS, terminate=False)
    with fmu.instance() as instance:
        first, _ = simulate(fmu, stop_time=middle, fmu_instance=instance.slave, set_stop_time=False, **arguments)
        second, _ = simulate(fmu, start_time=middle, stop_time=END, fmu_state=instance.bytes(), **arguments)
    assert distance(np.vstack([rows(first), rows(second)[1:]]), exact(step)) < 1e-9
