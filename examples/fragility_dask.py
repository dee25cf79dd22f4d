"""A sweep on Dask, a structure in each task: python examples/fragility_dask.py [tcp://10.0.0.1:8786] [--workers 2]

Without the address of a scheduler it runs in processes on this machine. Takes the records of `make demo`.
"""

import argparse
import time
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from dask.distributed import Client


def runs(pier: fr.Structure, records: dict[str, fr.Record], scales: int) -> pd.DataFrame:
    return fr.sweep({"piers": pier}, records, scale=np.linspace(0.2, 2, scales), threads=1)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("scheduler", nargs="?", help="its address")
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    parser.add_argument("--scales", type=int, default=10, help="scale factors")
    arguments = parser.parse_args()
    records = {path.name: fr.Record.read(path, time_scale=0.2) for path in sorted(Path("out").glob("*.AT2"))}
    piers = [fr.Structure(preset="mcmanus", f_fc=f_fc) for f_fc in np.geomspace(2, 8, 8)]
    local = {"n_workers": arguments.workers, "threads_per_worker": 1, "dashboard_address": None}
    with Client(arguments.scheduler) if arguments.scheduler else Client(**local) as client:
        start = time.perf_counter()
        tables = client.gather(client.map(runs, piers, records=records, scales=arguments.scales))
        seconds = time.perf_counter() - start
    table = pd.concat(tables, ignore_index=True)
    table.to_csv("fragility_dask.csv", index=False)
    print(f"{sum(table['ending'] == 'overturned')} of {len(table)} overturned; rows: fragility_dask.csv")
    print(f"{len(table) / seconds:.0f} runs/s")
