"""The sweep of fragility.toml through the FMU, with fmpy on Dask: on this machine's cores, or on a cluster.

Each worker process holds one instance of the FMU, with the records in its resources, and resets it before every run: one
step over the record, and its exact peaks. Writes one row per run and prints how many structures overturned and how
fast it went.

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
from dask.distributed import Client, LocalCluster, WorkerPlugin, get_worker, progress
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Discard, fmi2LastSuccessfulTime
from fmpy.simulation import instantiate_fmu

PEAKS = ("theta_max", "u_max", "a_t_max")
DEFAULTS = {"J0": 0.0, "c_ratio": 1.0, "g": 9.81}  # of a table of parameters
KEYS = {"records", "unit", "time_scale", "scale", "structures", "limits", "intensity"}  # what is known of a sweep
FULL_CONTACT = 1  # phase
REST, MOST_RESTS = 10.0, 10  # a step with the ground at rest after the record, in units of 1/p_l; how many at most
BATCH = 100  # runs in one task, for which Dask needs a millisecond


class RockingStructure(WorkerPlugin):
    """A worker's instance of the FMU, with the records among the archive's resources."""

    name = "rocking structure"

    def __init__(self, fmu: bytes, records: dict[str, bytes]):
        self.fmu = fmu
        self.records = records

    def setup(self, worker):
        self.folder = tempfile.mkdtemp()
        archive = Path(self.folder, "structure.fmu")
        archive.write_bytes(self.fmu)
        fmpy.extract(str(archive), unzipdir=self.folder)
        for name, content in self.records.items():
            Path(self.folder, "resources", name).write_bytes(content)
        description = fmpy.read_model_description(self.folder)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.instance = instantiate_fmu(self.folder, description, "CoSimulation", logger=lambda *message: None)
        self.in_use = threading.Lock()  # one run at a time, however many threads the worker has

    def teardown(self, worker):
        self.instance.freeInstance()
        shutil.rmtree(self.folder)

    def run(self, start_values: dict[str, float], record: str) -> tuple[float | None, list[float]]:
        """Time of overturning (s) or None, and PEAKS: over the record, and on at rest until the structure stands."""
        instance, reference = self.instance, self.references
        state = lambda: instance.getInteger([reference["phase"], reference["transitions"]])
        overturned_at = None
        with self.in_use:
            instance.reset()
            instance.setupExperiment()
            instance.setString([reference["record"]], [record])
            instance.setBoolean([reference["peaks"]], [True])
            instance.setReal([reference[name] for name in start_values], list(start_values.values()))
            instance.enterInitializationMode()
            instance.exitInitializationMode()
            duration, p_l = instance.getReal([reference["record_duration"], reference["p_l"]])
            try:
                instance.doStep(0.0, duration)
                for rest in range(MOST_RESTS):
                    before = state()
                    instance.doStep(duration + rest * REST / p_l, REST / p_l)
                    if before == state() and before[0] == FULL_CONTACT:
                        break
            except FMICallException as exception:
                if exception.status != fmi2Discard:
                    raise
                overturned_at = instance.getRealStatus(fmi2LastSuccessfulTime)
            return overturned_at, instance.getReal([reference[name] for name in PEAKS])


def run(batch):
    """Runs, on the worker that is asked."""
    structure = get_worker().plugins[RockingStructure.name]
    return [structure.run(*inputs) for inputs in batch]


def values(given) -> list[float]:
    """A list of numbers, or evenly spaced ones."""
    if isinstance(given, list):
        return given
    if given.get("log"):
        raise SystemExit("log = true: not known here, to `rocking-fmu sweep` alone")
    start, stop, last = given["from"], given["to"], given["count"] - 1
    return [(start * (last - i) + stop * i) / last for i in range(last + 1)]


def records(sources: list, folder: Path):
    """Name, content, suffix and scale of every record: named by its path from the folder of the TOML file."""
    for source in sources:
        source = source if isinstance(source, dict) else {"file": source, "scale": 1.0}
        for path in sorted(glob.glob(str(folder / source["file"]))):
            name = str(Path(path).relative_to(folder)) if Path(path).is_relative_to(folder) else path
            yield name, Path(path).read_bytes(), Path(path).suffix, source["scale"]


def structures(entry: dict, preset: dict[str, float]):
    """The parameters of every structure in an entry of structures."""
    if unknown := entry.get("parameters", {}).keys() - preset.keys():
        raise SystemExit(f"{entry['name']}: {', '.join(sorted(unknown))}: parameters of the FMU alone are known here")
    base = DEFAULTS | entry["parameters"] if "parameters" in entry else preset
    vary = entry.get("vary", {})
    for combination in itertools.product(*map(values, vary.values())):
        parameters = base | dict(zip(vary, combination))
        if "slenderness" in parameters:
            parameters["H"] = parameters.pop("slenderness") * parameters["B"]
        yield parameters


def start_values(sweep: dict, parameters: dict[str, float], record: str, scale: float) -> dict[str, float]:
    """The FMU's, for one run. An .AT2 record is in g, others in the sweep's unit."""
    unit = parameters["g"] if sweep.get("unit") == "g" and not record.lower().endswith(".at2") else 1.0
    return parameters | {"record_scale": scale * unit, "record_time_scale": sweep.get("time_scale", 1.0)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("sweep", nargs="?", type=Path, default=Path("examples/fragility.toml"), help="TOML file")
    parser.add_argument("--fmu", type=Path, default=Path("out/mcmanus.fmu"), help="FMU of the TOML file's preset")
    parser.add_argument("--scheduler", help="address of a Dask scheduler [default: a cluster on this machine]")
    parser.add_argument("--workers", type=int, help="worker processes on this machine [default: one per core]")
    parser.add_argument("-o", "--output", type=Path, default=Path("fragility_dask.csv"), help="rows as CSV")
    arguments = parser.parse_args()

    sweep = tomllib.loads(arguments.sweep.read_text())
    if unknown := sweep.keys() - KEYS:
        raise SystemExit(f"{arguments.sweep}: {', '.join(sorted(unknown))}: not known here, to `rocking-fmu sweep` alone")
    motions, packed = {}, {}
    for number, (name, content, suffix, scale) in enumerate(records(sweep["records"], arguments.sweep.parent)):
        motions[name] = (f"{number}{suffix}", scale)
        packed[f"{number}{suffix}"] = content
    variables = fmpy.read_model_description(str(arguments.fmu)).modelVariables
    preset = {v.name: float(v.start) for v in variables if v.causality == "parameter" and v.type == "Real"}
    runs = [
        (entry["name"], parameters, record, scale)
        for entry in sweep["structures"]
        for parameters in structures(entry, preset)
        for record in motions
        for scale in values(sweep["scale"])
    ]
    placed = []
    for _, parameters, record, scale in runs:
        file, own_scale = motions[record]
        placed.append((start_values(sweep, parameters, file, own_scale * scale), file))
    batches = [placed[at:at + BATCH] for at in range(0, len(placed), BATCH)]

    if arguments.scheduler:
        client = Client(arguments.scheduler)
    else:
        client = Client(LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None))
    with client:
        client.register_plugin(RockingStructure(arguments.fmu.read_bytes(), packed))
        workers = len(client.scheduler_info(n_workers=-1)["workers"])
        start = time.perf_counter()
        futures = client.map(run, batches, pure=False)
        progress(futures)
        responses = list(itertools.chain(*client.gather(futures)))
        seconds = time.perf_counter() - start

    with arguments.output.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["run", "structures", "H[m]", "record", "scale", "overturned_at[s]", *PEAKS])
        for index, ((name, parameters, record, scale), (overturned_at, peaks)) in enumerate(zip(runs, responses)):
            rows.writerow([index, name, parameters["H"], record, scale, overturned_at, *peaks])
    overturned = sum(overturned_at is not None for overturned_at, _ in responses)
    print(f"\n{overturned} of {len(runs)} overturned; rows: {arguments.output}")
    rate = len(runs) / seconds
    print(f"{seconds:.1f} s: {rate:.4g} runs/s, {rate / workers:.4g} runs/s on each of {workers} workers")


if __name__ == "__main__":
    main()
