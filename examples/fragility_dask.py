"""A sweep on Dask, a structure in each task: python examples/fragility_dask.py [tcp://10.0.0.1:8786]

Without the address of a scheduler it runs on this machine's cores. Takes the records of `make demo`.
"""

import sys
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from dask.distributed import Client

SCALES = np.linspace(0.2, 2, 10)


def runs(pier: fr.Structure, records: dict[str, fr.Record]) -> pd.DataFrame:
    return fr.sweep({"piers": pier}, records, scale=SCALES, threads=1)


if __name__ == "__main__":
    records = {path.name: fr.Record.read(path, time_scale=0.2) for path in sorted(Path("out").glob("*.AT2"))}
    piers = [fr.Structure(preset="mcmanus", f_fc=f_fc) for f_fc in (2, 4, 8)]
    with Client(*sys.argv[1:]) as client:
        table = pd.concat(client.gather(client.map(runs, piers, records=records)), ignore_index=True)
    table.to_csv("fragility_dask.csv", index=False)
    print(f"{sum(table['ending'] == 'overturned')} of {len(table)} overturned; rows: fragility_dask.csv")
