"""The Python module beside the engine, fmpy and the command line. `make bench` runs it after `cargo bench`.

The fastest of many runs of each. El Centro on McManus's specimen, with peaks; a sweep of one record at many scales on all cores.
"""

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import flexible_rocking as fr
import fmpy
import numpy as np

DURATION = 15.0  # s, that of benches/record.rs
SCALES = 10_000


def fastest(runs: int, do) -> float:
    """Seconds of the fastest of `runs`."""
    def seconds() -> float:
        start = time.perf_counter()
        do()
        return time.perf_counter() - start

    return min(seconds() for _ in range(runs))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("fmu", help="of McManus's specimen")
    parser.add_argument("record", help="El Centro")
    parser.add_argument("exporter", help="the command line")
    parser.add_argument("measured", type=Path, help="criterion's sample.json of the engine with peaks at auto")
    arguments = parser.parse_args()

    pier, ground = fr.Structure(preset="mcmanus"), fr.Record.read(arguments.record)
    module = fastest(500, lambda: fr.simulate(pier, ground, duration=DURATION).peaks)
    measured = json.loads(arguments.measured.read_text())
    engine = 1e-9 * min(np.divide(measured["times"], measured["iters"]))
    print(f"simulate with peaks: {1e3 * module:.3f} ms, {module / engine:.3f} times the engine's {1e3 * engine:.3f} ms")

    folder = fmpy.extract(arguments.fmu)
    description = fmpy.read_model_description(folder)
    outputs = ["theta_max", "u_max", "a_t_max"]
    options = dict(model_description=description, stop_time=DURATION, output_interval=float(ground.time[1]), output=outputs,
                   start_values={"record": arguments.record, "peaks": True})
    by_fmpy = fastest(5, lambda: fmpy.simulate_fmu(folder, **options))
    last = fmpy.simulate_fmu(folder, **options)[-1]
    peaks = fr.simulate(pier, ground, duration=DURATION).peaks
    off = max(abs(last[name] / peaks[name.removesuffix("_max")].value - 1) for name in outputs)
    print(f"fmpy.simulate_fmu, a step a sample: {1e3 * by_fmpy:.1f} ms, {by_fmpy / module:.1f} times the module's; "
          f"peaks differ by {off:.0e}")

    with tempfile.TemporaryDirectory() as rows:
        plan = f"records = [{arguments.record!r}]\nscale = {{ from = 0.1, to = 2, count = {SCALES} }}\n" \
               "[[structures]]\nname = 'structures'\npreset = 'mcmanus'\n"
        Path(rows, "sweep.toml").write_text(plan)
        command = [arguments.exporter, "sweep", f"{rows}/sweep.toml", "-o", f"{rows}/rows.csv", "--quiet"]

        def by_command() -> None:
            Path(rows, "rows.csv").unlink(missing_ok=True)
            subprocess.run(command, check=True, capture_output=True)

        seconds = [fastest(3, by_command), fastest(3, lambda: fr.sweep(pier, ground, scale=np.linspace(0.1, 2, SCALES)))]
    rates = [SCALES / each for each in seconds]
    print(f"sweep: {rates[1]:.0f} runs/s, {rates[1] / rates[0]:.3f} times the command line's {rates[0]:.0f}")


if __name__ == "__main__":
    main()
