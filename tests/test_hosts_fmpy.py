"""fmpy in all its ways, over Pacoima Dam: with the record inside, and with a_g passed on as far as fmpy can."""

import re
import subprocess
import sys
from html import unescape
from pathlib import Path

import fmpy
import numpy as np
import pytest
from evidence.scenes import PACOIMA_DAM
from fmpy.util import read_csv
from host import events, simulate
from pacoima import A_G, END, OUTPUTS, STEP, STEPS, TIME, distance, held, rows

def table(time, a_g):
    return np.array(list(zip(time, a_g)), dtype=[("time", float), ("a_g", float)])


@pytest.mark.parametrize("step", STEPS)
def test_simulate_fmu_with_the_record_inside(shaken, exact, step):
    result, messages = simulate(shaken["mcmanus"], stop_time=END, output_interval=step, output=OUTPUTS)
    assert len(events(messages)) == 31
    assert distance(rows(result), exact(step)) < 1e-9


@pytest.mark.parametrize("step", STEPS)
def test_command_line_with_the_record_inside(mcmanus, pacoima_record, exact, tmp_path, step):
    command = [sys.executable, "-m", "fmpy", "simulate", mcmanus.path, "--start-values", "record", str(pacoima_record),
               "--output-file", "out.csv", "--stop-time", str(END), "--output-interval", str(step)]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert distance(rows(read_csv(tmp_path / "out.csv")), exact(step)) < 1e-9


def test_simulate_fmu_holds_inputs(mcmanus):
    result, messages = simulate(mcmanus, stop_time=TIME[-1], output_interval=STEP, input=table(TIME, A_G), output=OUTPUTS)
    assert len(events(messages)) == 31
    assert distance(rows(result), held(mcmanus)) < 1e-10


def test_simulate_fmu_cannot_pass_slopes_on(mcmanus):
    """fmpy 0.3.23 to 0.3.32 make room for nine slopes, whatever the number of inputs."""
    with pytest.raises(ValueError, match="Can only assign sequence of same size"):
        fmpy.simulate_fmu(mcmanus.path, stop_time=1.0, input=table(TIME, A_G), set_input_derivatives=True)


def test_the_script_of_the_page_inside_runs(mcmanus):
    page = (Path(mcmanus.folder) / "documentation" / "index.html").read_text()
    script = unescape(re.search(r"<pre>(from fmpy.*?)</pre>", page, re.DOTALL)[1])
    script = script.replace("FlexibleRocking.fmu", mcmanus.path).replace("/data/RSN77_SFERN_PUL164.AT2", PACOIMA_DAM["record"])
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    peak, instant = map(float, re.fullmatch(r"(\S+) rad at (\S+) s\n", done.stdout).groups())
    assert peak == pytest.approx(0.01200009, abs=5e-9) and 0 < instant < 4


def test_a_run_goes_on_from_bytes(shaken, exact):
    """simulate_fmu with fmu_instance to the middle; from its serialized state to the end."""
    fmu, step, middle = shaken["mcmanus"], 2e-3, 2.0
    arguments = dict(output_interval=step, output=OUTPUTS, terminate=False)
    with fmu.instance() as instance:
        first, _ = simulate(fmu, stop_time=middle, fmu_instance=instance.slave, set_stop_time=False, **arguments)
        state = instance.slave.getFMUstate()
        middle_state = instance.slave.serializeFMUstate(state)
        instance.slave.freeFMUstate(state)
    second, _ = simulate(fmu, start_time=middle, stop_time=END, fmu_state=middle_state, **arguments)
    assert distance(np.vstack([rows(first), rows(second)[1:]]), exact(step)) < 1e-9
