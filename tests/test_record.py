"""A record inside: nothing is left of a run."""

import subprocess
import sys

from first_run import PACOIMA_DAM

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
