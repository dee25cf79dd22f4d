"""A sweep on Ray, a structure in each task: python examples/fragility_ray.py [--workers 2]

Joins the cluster that RAY_ADDRESS names, or runs in processes on this machine. Takes the records of `make demo`.
"""

import argparse
import os
import time
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
import ray


@ray.remote
def runs(pier: fr.Structure, records: dict[str, fr.Record], scales: int) -> pd.DataFrame:
    return fr.sweep({"piers": pier}, records, scale=np.linspace(0.2, 2, scales), threads=1)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    parser.add_argument("--scales", type=int, default=10, help="scale factors")
    arguments = parser.parse_args()
    records = {path.name: fr.Record.read(path, time_scale=0.2) for path in sorted(Path("out").glob("*.AT2"))}
    piers = [fr.Structure(preset="mcmanus", f_fc=f_fc) for f_fc in np.geomspace(2, 8, 8)]
    ray.init(num_cpus=None if "RAY_ADDRESS" in os.environ else arguments.workers, include_dashboard=False)
    shared = ray.put(records)
    ray.get([runs.remote(pier, shared, 1) for pier in piers])  # starts the processes
    start = time.perf_counter()
    tables = ray.get([runs.remote(pier, shared, arguments.scales) for pier in piers])
    seconds = time.perf_counter() - start
    table = pd.concat(tables, ignore_index=True)
    table.to_csv("fragility_ray.csv", index=False)
    print(f"{sum(table['ending'] == 'overturned')} of {len(table)} overturned; rows: fragility_ray.csv")
    print(f"{len(table) / seconds:.0f} runs/s")
