"""The project's two faces as the report uses them: the exported FMU under fmpy, and the command line."""

import io
import subprocess
from functools import cache
from pathlib import Path

import fmpy
import numpy as np
import pandas as pd

from .records import write_csv

TOLERANCE = 1e-10
FIXED_BASE = {"B": 100.0}  # too wide to lift off
OUTPUTS = ["theta", "u", "a_t", "theta_dot", "u_dot", "uplift", "delta_t", "phase", "transitions"]
PHASES = {1: "full contact", 2: "rocking left", 3: "rocking right", 4: "overturned"}


class Project:
    """The executable `rocking-fmu`, and what it exports into `folder`."""

    def __init__(self, exporter: Path, folder: Path):
        self.exporter = exporter
        self.folder = folder

    def run(self, *arguments) -> pd.DataFrame:
        """The CSV that a command prints."""
        command = [self.exporter, *map(str, arguments)]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return pd.read_csv(io.StringIO(printed))

    def values(self, *arguments) -> dict[str, float]:
        """The named values of a command that prints one on each line."""
        return self.run(*arguments, "--format", "csv").set_index("name")["value"].astype(float).to_dict()

    def columns(self, *arguments) -> dict[str, np.ndarray]:
        """The columns of a command that prints a table, without the units in their headings."""
        table = self.run(*arguments)
        return {heading.partition("[")[0]: table[heading].to_numpy() for heading in table}

    def sweep(self, plan: str) -> pd.DataFrame:
        """The rows of a sweep that is given as the text of its TOML file."""
        file, rows = self.folder / "sweep.toml", self.folder / "sweep.csv"
        file.write_text(plan, encoding="utf-8")
        rows.unlink(missing_ok=True)
        subprocess.run([self.exporter, "sweep", file, "--output", rows, "--quiet"], check=True, capture_output=True)
        return pd.read_csv(rows)

    @cache
    def fmu(self, preset: str) -> Path:
        """The FMU of one of the paper's specimens, exported and unpacked."""
        archive = self.folder / f"{preset}.fmu"
        subprocess.run([self.exporter, "export", "--preset", preset, "-o", archive], check=True, capture_output=True)
        return Path(fmpy.extract(str(archive), unzipdir=str(self.folder / preset)))

    @cache
    def calculated(self, preset: str) -> dict[str, float]:
        """The calculated parameters of a specimen, from its FMU."""
        names = ["alpha_cg", "p_l", "chi", "u_cr", "f_u"]
        result = fmpy.simulate_fmu(str(self.fmu(preset)), stop_time=1e-3, output=names)
        return {name: float(result[name][0]) for name in names}

    def free_vibration(self, preset: str, duration: float, interval: float, **start_values) -> np.ndarray:
        """The response to a release, every `interval` (s); SI units, as the FMU's outputs."""
        return self._simulate(preset, stop_time=duration, output_interval=interval, start_values=start_values)

    def earthquake(self, preset: str, time: np.ndarray, a_g: np.ndarray, per_sample: int, **start_values) -> np.ndarray:
        """The response to the ground acceleration `a_g` (m/s2) at the instants `time` (s), linear between them."""
        record = self.folder / "record.csv"
        write_csv(record, time, a_g)
        return self._simulate(preset, stop_time=time[-1], output_interval=time[1] / per_sample,
                              start_values=start_values | {"record": str(record)})

    def _simulate(self, preset: str, **options) -> np.ndarray:
        return np.asarray(fmpy.simulate_fmu(str(self.fmu(preset)), relative_tolerance=TOLERANCE, output=OUTPUTS,
                                            logger=_log, **options))

    def modes(self, preset: str, response: np.ndarray) -> dict[str, np.ndarray]:
        """The rocking and the vibration mode of a free vibration, at the instants at which it rocks."""
        path = self.folder / "response.csv"
        units = {"time": "s", "theta": "rad", "u": "m", "theta_dot": "rad/s", "u_dot": "m/s"}
        table = pd.DataFrame({f"{name}[{unit}]": response[name] for name, unit in units.items()})
        table["a_g[m/s2]"], table["phase"] = 0.0, [PHASES[int(item)] for item in response["phase"]]
        table.to_csv(path, index=False)
        return self.columns("modes", "--preset", preset, "--response", path, "-o", "-")

    @cache
    def parameters(self, preset: str) -> dict[str, float]:
        """The parameters of a specimen, as its FMU starts with them."""
        variables = fmpy.read_model_description(str(self.fmu(preset))).modelVariables
        return {variable.name: float(variable.start) for variable in variables
                if variable.causality == "parameter" and variable.type == "Real"}


def _log(_environment, _instance, status, _category, message) -> None:
    """Prints what the FMU says with an error; that a structure overturned (status 2) is a result."""
    if status > 2:
        print(message.decode())
