"""A run of one fmi2DoStep over El Centro through fmpy, its peaks read after it, beside the engine's own time for it.

The fastest of many runs of each. Needs what `cargo bench` has just measured; `make bench` does both.
"""

import argparse
import json
import time
from pathlib import Path

import fmpy
import numpy as np
from fmpy.simulation import instantiate_fmu

DURATION = 15.0  # s, that of benches/record.rs
RUNS = 200
PEAKS = [f"{name}_max" for name in ("theta", "u", "delta_t", "uplift", "a_t", "V_t", "M_t")]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("fmu", help="of McManus's specimen")
    parser.add_argument("record", help="El Centro")
    parser.add_argument("measured", type=Path, help="criterion's sample.json of the engine at auto, 1e-9")
    arguments = parser.parse_args()

    description = fmpy.read_model_description(arguments.fmu)
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    instance = instantiate_fmu(fmpy.extract(arguments.fmu), description, "CoSimulation")
    seconds = {True: [], False: []}
    for read in [True, False] * RUNS:
        start = time.perf_counter()
        instance.reset()
        instance.setupExperiment()
        instance.setString([reference["record"]], [arguments.record])
        instance.setBoolean([reference["peaks"]], [read])
        instance.enterInitializationMode()
        instance.exitInitializationMode()
        instance.doStep(0.0, DURATION)
        if read:
            instance.getReal([reference[name] for name in PEAKS])
        seconds[read].append(time.perf_counter() - start)
    measured = json.loads(arguments.measured.read_text())
    engine = 1e-9 * min(np.divide(measured["times"], measured["iters"]))
    print(f"engine: {1e3 * engine:.3f} ms")
    for read, text in ((True, "with peaks"), (False, "without peaks")):
        fastest = min(seconds[read])
        print(f"fmpy, one step, {text}: {1e3 * fastest:.3f} ms, {fastest / engine:.3f} times the engine's")


if __name__ == "__main__":
    main()
