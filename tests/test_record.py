"""A record inside: one step over it has the peaks of the command line, and nothing is left of a run."""

import json
import subprocess
import sys

import pytest
from first_run import PACOIMA_DAM
from host import ground_motion
from pacoima import write_record

RECORDS = {  # with a scale factor under which McManus's specimen rocks
    "Pacoima Dam": ("sanFernando_pacoidaDam_1971", "pul164", dict(time_scale=5, scale=5 * 0.29)),
    "El Centro": ("imperialValley_elCentro_1940", "elc180", {}),
    "Corralitos": ("lomaPrieta_corralitos_1989", "cls000", dict(scale=0.7)),
    "Sylmar": ("northridge_sylmar_1994", "syl360", dict(scale=4.0)),
}


@pytest.fixture(scope="module", params=RECORDS)
def record(request, tmp_path_factory):
    """Its file, and how long it is."""
    event, component, scales = RECORDS[request.param]
    time, a_g = ground_motion(event, component, **scales)
    path = tmp_path_factory.mktemp("records") / f"{request.param}.csv"
    write_record(path, time, a_g)
    return path, time[-1]


def test_one_step_has_the_peaks_of_the_command_line(mcmanus, record, exporter):
    """Those of a structure that overturns are until it begins to fall."""
    path, duration = record
    printed = subprocess.run([exporter, "simulate", "--preset", "mcmanus", "--record", path, "--duration", str(duration),
                              "--format", "json"], check=True, capture_output=True, text=True)
    told = json.loads(printed.stdout)
    _, *peaks = told["peaks"]  # without the ground's
    assert len(peaks) == 7
    with mcmanus.instance() as instance:
        instance.slave.setString([mcmanus.variables["record"].valueReference], [str(path)])
        instance.slave.setBoolean([mcmanus.variables["peaks"].valueReference], [True])
        instance.initialize()
        instance.step(told["fall"] or duration)
        for peak in peaks:
            found = instance.get(f"{peak['name']}_max", f"t_{peak['name']}_max")
            assert found == pytest.approx([peak["peak"], peak["time"]], rel=1e-9), peak["name"]


RUNS = """
import sys
from fmpy import extract, read_model_description, simulate_fmu

folder, record, runs = sys.argv[1], sys.argv[2], int(sys.argv[3])
description = read_model_description(folder)


def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4096


def logger(*message):
    pass


for run in range(runs):
    if run == runs // 3:
        before = resident()
    simulate_fmu(folder, model_description=description, stop_time=0.02, output_interval=0.01, output=["theta"],
                 start_values={"record": record}, logger=logger)
print(resident() - before)
"""


def test_nothing_is_left_of_a_run(mcmanus):
    """fmpy unloads the library after each: a record of 4172 samples, left behind, would be 67 kB."""
    command = [sys.executable, "-c", RUNS, mcmanus.folder, PACOIMA_DAM["record"], "300"]
    grown = int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert grown < 200 * 5_000
