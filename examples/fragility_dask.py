"""A sweep on Dask, a structure in each task: python examples/fragility_dask.py [tcp://10.0.0.1:8786]

Without the address of a scheduler it runs in two processes on this machine. Takes the records of `make demo`.
"""

import sys
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from dask.distributed import Client


def runs(pier: fr.Structure, records: dict[str, fr.Record]) -> pd.DataFrame:
    return fr.sweep({"piers": pier}, records, scale=np.linspace(0.2, 2, 10), threads=1)


if __name__ == "__main__":
    records = {path.name: fr.Record.read(path, time_scale=0.2) for path in sorted(Path("out").glob("*.AT2"))}
    piers = [fr.Structure(preset="mcmanus", f_fc=f_fc) for f_fc in np.geomspace(2, 8, 8)]
    with Client(*sys.argv[1:]) if sys.argv[1:] else Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        table = pd.concat(client.gather(client.map(runs, piers, records=records)), ignore_index=True)
    table.to_csv("fragility_dask.csv", index=False)
    print(f"{sum(table['ending'] == 'overturned')} of {len(table)} overturned; rows: fragility_dask.csv")
