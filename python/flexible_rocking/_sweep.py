"""Many runs, and the fragility curves through them."""

import io
import sys
import tempfile
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from ._native import Curve, Record, Structure


def sweep(
    structures: "Structure | Sequence[Structure] | Mapping[str, Structure | Sequence[Structure]]",
    records: "Record | Sequence[Record] | Mapping[str, Record]",
    *,
    scale: "float | ArrayLike" = 1.0,
    intensity: str = "PGA",
    detail: str = "auto",
    tolerance: float = 1e-9,
    duration: float | None = None,
    validity: bool = False,
    threads: int = 0,
    path: str | PathLike[str] | None = None,
    progress: bool = False,
    **initial: float,
) -> "pd.DataFrame":
    """Runs every structure under every record at every scale on all cores: a DataFrame with a row per run.

    structures: one, several, or populations by name, each one or several. records: one, several, or by name.
    scale: factors on the accelerations. intensity: the measure for `fragility`, "PGA" (g), "PGV" (m/s) or "S_a" (g, at the
    structure's own f_fc and zeta_fc). detail, tolerance, duration and initial values: as in `simulate`.
    validity: whether the rows have how far each run exceeds the model's limits. threads: 0 is one per core.

    The columns are those of `rocking-fmu sweep`: structures, parameters, record, scale, intensities, ending, peaks
    ("peak_theta[rad]", ...), transitions, ... A run that cannot go on is a row with the ending "failed" and a reason.

    path: the command line's file of rows. Runs whose rows are there are not repeated. Rows are added as runs end, and a
    stopped sweep continues after them. Ctrl-C raises KeyboardInterrupt, whose attribute `table` has the rows that are there.
    Raises ValueError where a structure or record is there twice, has no name of its own, or cannot be run.
    """
    groups = structures if isinstance(structures, Mapping) else {"structures": structures}
    populations = [(name, [of] if isinstance(of, _native.Structure) else list(of)) for name, of in groups.items()]
    given: Any = [records] if isinstance(records, (_native.Record, str, PathLike)) else records
    # all but a Record is refused by name
    titled = ((of.title if isinstance(of, _native.Record) else "", of) for of in given)
    motions = list(records.items() if isinstance(records, Mapping) else titled)
    units = _native.intensity_measures()
    if intensity not in units:
        raise ValueError(f"intensity = {intensity!r} is unknown; these are known: {', '.join(units)}")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "sweep.csv") if path is None else Path(path)
        try:
            keys = _native.sweep(populations, motions, scale, file, detail, tolerance, duration, initial, validity, threads,
                                 _say if progress else None)
        except KeyboardInterrupt as stopped:
            stopped.table = _rows(file)  # type: ignore[attr-defined]
            raise
        finally:
            if progress:
                print(file=sys.stderr)
        table = _rows(file).drop_duplicates("run").set_index("run").loc[keys].reset_index()
    table.attrs["intensity"] = f"{intensity}[{units[intensity]}]"
    return table


def _rows(file: Path) -> "pd.DataFrame":
    """The complete rows of a file, number for number."""
    import pandas

    complete = io.BytesIO(file.read_bytes().rpartition(b"\n")[0])
    if int(pandas.__version__.partition(".")[0]) < 3:  # later ones do not round
        return pandas.read_csv(complete, float_precision="round_trip")
    return pandas.read_csv(complete)


def _say(done: int, of: int) -> None:
    print(f"\r{done} of {of} runs", end="", file=sys.stderr, flush=True)


class Fragility:
    """A lognormal fragility curve through the runs of a sweep: what `fragility` returns.

    limit, intensity: of what, over what. curve: median, dispersion, median_range, probability(x), band(x). bins: a DataFrame
    of runs of about the same intensity: lowest, mean, highest, runs, known, exceedances.
    """

    def __init__(self, limit: str, intensity: str, curve: "Curve", bins: "pd.DataFrame"):
        self.limit, self.intensity, self.curve, self.bins = limit, intensity, curve, bins

    @property
    def median(self) -> float:
        """Intensity at which the limit is exceeded with the probability 1/2."""
        return self.curve.median

    @property
    def dispersion(self) -> float:
        """Standard deviation of the intensity's logarithm."""
        return self.curve.dispersion

    def probability(self, intensities: "ArrayLike") -> "NDArray[Any]":
        """The probability that the limit is exceeded at each of `intensities` (n,): an array (n,)."""
        return self.curve.probability(intensities)

    def __repr__(self) -> str:
        return f"<Fragility {self.limit!r} over {self.intensity}: median {self.median:.6g}, dispersion {self.dispersion:.6g}>"

    def plot(self, axes: "Axes | None" = None) -> "Axes":
        """Draws the curve with its 95 % band and the counted parts, over `axes` or new ones, which are returned."""
        import numpy as np
        from matplotlib import pyplot

        axes = axes if axes is not None else pyplot.subplots(layout="constrained")[1]
        known = self.bins[self.bins["known"] > 0]
        intensities = np.geomspace(0.8 * known["lowest"].min(), 1.2 * known["highest"].max(), 200)
        (line,) = axes.plot(intensities, self.probability(intensities), label=self.limit)
        if (band := self.curve.band(intensities)) is not None:
            axes.fill_between(intensities, *band.T, color=line.get_color(), alpha=0.2, linewidth=0)
        axes.plot(known["mean"], known["exceedances"] / known["known"], "o", color=line.get_color(), markersize=4)
        axes.set(xlabel=self.intensity, ylabel="probability", xscale="log", ylim=(0, 1))
        axes.legend()
        return axes


def fragility(table: "pd.DataFrame", limit: str = "overturned", *, intensity: str | None = None) -> Fragility:
    """Fits the lognormal curve of greatest likelihood to the runs of one population in a sweep's table, or to some of its rows.

    limit: "overturned", or a peak such as "theta/alpha_cg >= 0.5", "theta >= 3 deg", "uplift >= 1 cm", "a_t >= 0.3 g" (the
    structure's own g). A run that overturned has exceeded every limit. intensity: "PGA", "PGV", "S_a" or a column of the
    table; by default the measure of the sweep. Runs that failed are not counted. How sure the curve
    is follows from the records, whose runs do not depend on each other; where there is one record, from the structures.
    Several structures that `sweep` ran under one name are one population. Raises ValueError with the reason if there is no
    curve (never exceeded, always exceeded, no overlap). A table with several populations or conditions, with a run twice, with
    peaks that are NaN, or without the measure of its sweep raises ValueError, too.
    """
    import pandas

    units = _native.intensity_measures()
    known = {name: f"{name}[{unit}]" for name, unit in units.items()}
    if intensity is None and "intensity" not in table.attrs:  # merge, concat and read_csv lose it
        raise ValueError(f"intensity is needed: the table has lost the measure of its sweep; give one of {', '.join(units)}")
    column = known.get(intensity, intensity) if intensity else table.attrs["intensity"]
    if column not in table:
        raise ValueError(f"intensity = {intensity!r} is unknown; these are known: {', '.join(units)}, and the table's columns")
    conditions = ["structures", "detail", "tolerance", "duration[s]", *table.filter(regex=r"_0\[(rad|m)(/s)?]$")]
    for name in table.columns.intersection(conditions):
        if len(values := table[name].unique()) > 1:
            several = ", ".join(map(repr, values[:5].tolist())) + (", ..." if len(values) > 5 else "")
            raise ValueError(f"the table has {len(values)} values of {name}, {several}, and a curve is of one: choose the rows, "
                             f"table[table[{name!r}] == {values[0]!r}], or call fragility for each of table.groupby({name!r})")
    if twice := int(table["run"].duplicated().sum()):
        raise ValueError(f"the table has {twice} rows of runs that it has already: leave them out by table.drop_duplicates('run')")
    peak = _native.measure_of(limit)
    ended = table[table["ending"] != "failed"]
    varying = ["record"] if ended["record"].nunique() > 1 else list(table.columns[1:table.columns.get_loc("record")])
    groups = ended.groupby(varying, sort=False, dropna=False).ngroup()
    peaks = ended[peak or "peak_theta[rad]"]
    if missing := int((peaks.isna() & (ended["ending"] != "overturned")).sum()):
        raise ValueError(f"{peaks.name} is NaN in {missing} rows of runs that ended: run them again, or leave them out by "
                         f"table.dropna(subset={[peaks.name]!r}), and with them what they would have counted")
    curve, bins = _native.fragility(groups.tolist(), ended[column].tolist(), [str(ending) for ending in ended["ending"]],
                                    peaks.tolist(), ended["g[m/s2]"].tolist(), limit, ended["B[m]"].max())
    names = ["lowest", "mean", "highest", "runs", "known", "exceedances"]
    return Fragility(limit, column, curve, pandas.DataFrame(bins, columns=names))
