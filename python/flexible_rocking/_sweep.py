"""Many runs, and the fragility curves through them."""

import io
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike
from typing import TYPE_CHECKING, Any, overload

from . import _native
from ._results import extras

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from ._native import Curve, Record, Structure

    _Motion = Record | str | PathLike[str]
    _Records = _Motion | Sequence[_Motion] | Mapping[str, _Motion]


def sweep(
    structures: "Structure | Sequence[Structure] | Mapping[str, Structure | Sequence[Structure]]",
    records: "_Records",
    *,
    scale: "float | ArrayLike" = 1.0,
    intensity: str = "PGA",
    contents: "Sequence[str]" = (),
    detail: str = "auto",
    tolerance: float = 1e-9,
    duration: float | None = None,
    condition: bool = False,
    validity: bool = False,
    threads: int = 0,
    path: str | PathLike[str] | None = None,
    progress: "bool | Callable[[int, int], object]" = False,
    **initial: "ArrayLike",
) -> "pd.DataFrame":
    """Runs every structure under every record at every scale on all cores: a DataFrame with a row per run.

    structures: one, several, or populations by name, each one or several. Each has one mass or many. records: one, several, or by
    name, each a Record or the path of a file. scale: factors on the accelerations. detail, tolerance, duration and initial values: as in `simulate`.
    condition: whether each run is computed again under 1 + 1e-12 times its input; the column "digits" then has how many digits of the peak of
    theta are sure, of a structure that overturns those of its end. validity: whether the rows have how far each run exceeds the model's limits. threads: 0 is one per core.

    intensity: the measure for `fragility`, "PGA" (g), "PGV" (m/s), "S_a" (g, at f_fc and zeta_fc, a building's lowest mode), "CAV"
    (m/s), "I_A" (m/s, Arias), "D_5_95" (s, significant duration) or "S_a_avg". S_a_avg (g) is the geometric mean of S_a at ten
    periods, evenly spaced from 0.2/f_fc to 3/f_fc. "S_a(1 s)" is S_a at this period with 5 % damping, whatever the structure has, and
    "S_a(1 s, 2 %)" with another. The table has S_a_avg and S_a at a period only if that is the measure, and always the others.

    contents: oscillators on floors, by the names of their columns: "S_a[3](0.5 s)" has this period and 5 % damping on the third floor,
    "S_a[3](0.5 s, 2 %)" another; one mass is floor 1. The table then has "peak_S_a[3](0.5 s)[m/s2]", which `fragility` takes as a limit.

    progress: True shows the runs, their rate and the time left by tqdm. A function is called with the numbers of runs done and
    to do, 20 times per second.

    The columns are those of `rocking-fmu sweep`: structures, parameters, record, scale, intensities, ending, peaks
    ("peak_theta[rad]", ..., of a building "peak_a_t[3][m/s2]", ...), transitions, ... A number that a structure does not have is
    NaN. A run that cannot go on is a row with the ending "failed" and a reason.

    path: the command line's file of rows. Runs whose rows are there are not repeated. Rows are added as runs end, and a
    stopped sweep continues after them. Ctrl-C raises KeyboardInterrupt, whose attribute `table` has the runs that are done.
    Raises ValueError where a structure or record is there twice, has no name of its own, or cannot be run.
    """
    with extras():
        import pandas

    groups = structures if isinstance(structures, Mapping) else {"structures": structures}
    populations = [(name, [of] if isinstance(of, _native.Structure) else list(of)) for name, of in groups.items()]
    with _told(progress) as tell:
        keys, columns, stopped = _native.sweep(populations, _named(records), scale, intensity, list(contents), path, detail, tolerance, duration,
                                               condition, initial, validity, threads, tell)
    table = pandas.DataFrame({"run": keys} | {name: _values(of) for name, of in columns}, copy=False)
    table.attrs["intensity"] = _native.heading_of(intensity)
    if stopped is not None:
        stopped.table = table  # type: ignore[attr-defined]
        raise stopped
    return table


def overturning_map(
    structure: "Structure",
    shape: str = "sine",
    *,
    frequency: "ArrayLike",
    amplitude: "ArrayLike",
    cycles: float | None = None,
    phase: float = 0.0,
    error: float = 1e-4,
    dimensionless: bool = True,
    refine: int = 0,
    condition: bool = False,
    detail: str = "auto",
    tolerance: float = 1e-9,
    threads: int = 0,
) -> "pd.DataFrame":
    """Runs a structure under pulses of every frequency and amplitude: a DataFrame with a row per pulse, an overturning spectrum.

    frequency, amplitude: two or more rising values, in units of p_l and g tan(alpha_cg); with dimensionless=False in Hz and g. shape,
    cycles, phase, error: as in `pulse`. refine: how often to halve the steps along the boundaries (0 to 8). condition: whether each
    pulse runs again at an amplitude larger by the factor 1 + 1e-12. detail, tolerance, threads: as in `sweep`.

    The columns are those of `rocking-fmu sweep` with pulses: refinement, frequency[Hz], amplitude[m/s2], omega/p_l,
    a_p/(g tan alpha_cg), fate ("no uplift", "stands", "overturns", "still rocking", "failed"), impacts, theta_max/alpha_cg,
    transitions, end[s], condition, reason. Raises ValueError for values that do not rise and for a level that cannot move the structure.
    """
    with extras():
        import pandas

    rows = _native.overturning_map(structure, shape, frequency, amplitude, cycles, phase, error, dimensionless, refine, condition, detail,
                                   tolerance, threads)
    return pandas.read_csv(io.StringIO(rows))


def _named(records: "_Records") -> "list[tuple[str, Record]]":
    """Records with their names; a path stands for the record of its file."""
    def read(of: Any) -> Any:
        return _native.Record.read(of) if isinstance(of, (str, PathLike)) else of

    if isinstance(records, Mapping):
        return [(name, read(of)) for name, of in records.items()]
    given: Any = [records] if isinstance(records, (_native.Record, str, PathLike)) else records
    # all but a Record is refused by name
    return [(of.title if isinstance(of, _native.Record) else "", of) for of in map(read, given)]


def _values(column: Any) -> Any:
    """A column of a table: numbers, counts, or texts and the positions of theirs, behind the last one where there is none."""
    import numpy as np
    import pandas

    if isinstance(column, tuple):
        texts, positions = column
        return pandas.Series([*texts, math.nan]).array.take(np.minimum(positions, len(texts)).astype(np.intp))
    return column if column.dtype == np.float64 else column.view(np.int64)


@contextmanager
def _told(progress: "bool | Callable[[int, int], object]") -> "Iterator[Callable[[int, int], object] | None]":
    """The function that `sweep` calls with the numbers of runs done and to do."""
    if not isinstance(progress, bool):
        yield progress
    elif not progress:
        yield None
    else:
        with extras():
            from tqdm.auto import tqdm  # type: ignore[import-untyped]

        with tqdm(unit=" runs") as bar:
            def move(done: int, of: int) -> None:
                bar.total = of
                bar.update(done - bar.n)

            yield move


_BINS = ["lowest", "mean", "highest", "runs", "known", "exceedances"]


class Fragility:
    """A lognormal fragility curve through the runs of a sweep: what `fragility` returns.

    limit: the condition that is exceeded. intensity: the measure on the horizontal axis. curve: median, dispersion, median_range,
    probability(x), band(x). bins: a DataFrame of runs of about the same intensity: lowest, mean, highest, runs, known, exceedances.
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

    def table(self, intensities: "ArrayLike") -> "pd.DataFrame":
        """The curve as numbers at `intensities` (n,): a DataFrame of intensity, probability, and low and high, between which the
        probability lies with a probability of 95 %, NaN where that is unknown."""
        import numpy as np
        import pandas

        at = np.atleast_1d(np.asarray(intensities, float))
        band = self.curve.band(at)
        low, high = band.T if band is not None else np.full((2, len(at)), np.nan)
        return pandas.DataFrame({self.intensity: at, "probability": self.probability(at), "low": low, "high": high})

    def __repr__(self) -> str:
        return f"<Fragility {self.limit!r} over {self.intensity}: median {self.median:.6g}, dispersion {self.dispersion:.6g}>"

    def plot(self, axes: "Axes | None" = None) -> "Axes":
        """Draws the curve with its 95 % band and the counted parts, over `axes` or new ones, which are returned."""
        import numpy as np

        with extras():
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


@overload
def fragility(table: "pd.DataFrame", limit: str = ..., *, by: None = ..., intensity: str | None = ...) -> Fragility: ...
@overload
def fragility(table: "pd.DataFrame", limit: str = ..., *, by: str, intensity: str | None = ...) -> dict[Any, Fragility]: ...
def fragility(table: "pd.DataFrame", limit: str = "overturned", *, by: str | None = None, intensity: str | None = None) -> Any:
    """Fits the lognormal curve of greatest likelihood to the runs of one population in a sweep's table, or to some of its rows.

    limit: "overturned", or a peak such as "theta/alpha_cg >= 0.5", "theta >= 3 deg", "uplift >= 1 cm", "a_t >= 0.3 g" (the
    structure's own g). Of a building, "a_t[3] >= 0.3 g" is of a floor, and "a_t >= 0.3 g" of all floors: the largest counts. A run
    that overturned has exceeded every limit. Another table needs a column of an intensity and a column of a demand: limit is then
    "COLUMN >= VALUE", and the demand of a collapsed structure is inf. Its records, if it has a column "record", or else its rows are
    independent of each other. intensity: a measure of `sweep` or a column of the table; by default the measure of the sweep.
    by: a column, such as "structures" or "f_fc[Hz]". With by, the result is a dict with the curve of each value of the column.
    Runs that failed are not counted. The uncertainty of the curve treats records as independent of each other, or, if there is one
    record, structures.
    Several structures that `sweep` ran under one name are one population. Raises ValueError with the reason if there is no
    curve (never exceeded, always exceeded, no overlap). A table with several populations or conditions, with a run twice, with
    peaks or demands that are NaN, with text in place of numbers, or without the measure of its sweep raises ValueError, too.
    """
    import pandas

    column = intensity or table.attrs.get("intensity")
    if column is None:  # merge, concat and read_csv lose it
        raise ValueError("intensity is needed: the table has lost the measure of its sweep; give one, such as PGA, or a column")
    if column not in table:
        column = _native.heading_of(column)
        if column not in table:
            raise ValueError(f"intensity = {intensity!r}: the table has no column {column}; give one of {', '.join(table.columns)}")
    if by is not None:
        if by not in table:
            raise ValueError(f"by = {by!r} is no column of the table: give one of {', '.join(table.columns)}")
        curves = {}
        for value, rows in table.groupby(by, sort=False, dropna=False):
            try:
                curves[value] = fragility(rows, limit, intensity=column)
            except ValueError as refused:
                raise ValueError(f"{by} = {value!r}: {refused}") from None
        return curves
    if "ending" not in table:
        return _of_own(table, limit, column)
    if lacking := [name for name in ("record", "ending", "g[m/s2]", "B[m]") if name not in table]:
        raise ValueError(f"the table has no {', '.join(lacking)}: a table with the columns of `sweep` is needed, such as "
                         f"pandas.read_csv of its file")
    conditions = ["structures", "detail", "tolerance", "duration[s]", *table.filter(regex=r"_0\[(rad|m)(/s)?]$")]
    for name in table.columns.intersection(conditions):
        if len(values := table[name].unique()) > 1:
            several = ", ".join(map(repr, values[:5].tolist())) + (", ..." if len(values) > 5 else "")
            raise ValueError(f"the table has {len(values)} values of {name}, {several}, and a curve is of one: choose the rows, "
                             f"table[table[{name!r}] == {values[0]!r}], or give by={name!r} for a curve of each")
    if twice := int(table.filter(items=["run"]).duplicated().sum()):
        raise ValueError(f"the table has {twice} rows of runs that it has already: leave them out by table.drop_duplicates('run')")
    ended = table[table["ending"] != "failed"]
    of_structure = table.columns[:table.columns.get_loc("record")].drop("run", errors="ignore")
    varying = ["record"] if ended["record"].nunique() > 1 else list(of_structure)
    groups = ended.groupby(varying, sort=False, dropna=False).ngroup()
    curve, bins = _native.fragility(groups.tolist(), _numbers(ended[column]), _exceeds(ended, limit))
    return Fragility(limit, column, curve, pandas.DataFrame(bins, columns=_BINS))


def _of_own(table: "pd.DataFrame", limit: str, column: str) -> Fragility:
    """The curve of a table that `sweep` did not make."""
    import pandas

    name, _, value = (part.strip() for part in limit.partition(">="))
    try:
        demands, least = table[name], float(value)
    except (KeyError, ValueError):
        raise ValueError(f"limit = {limit!r}: COLUMN >= VALUE is needed, with a column of {', '.join(map(str, table.columns))} and a number"
                         ) from None
    exceeds = [of >= least for of in _numbers(demands)]
    if missing := int(demands.isna().sum()):
        raise ValueError(f"{name} is NaN in {missing} rows: write inf where the structure collapsed, or leave the rows out by table.dropna()")
    groups = pandas.factorize(table["record"])[0] if "record" in table else range(len(table))
    curve, bins = _native.fragility(list(groups), _numbers(table[column]), exceeds)
    return Fragility(limit, column, curve, pandas.DataFrame(bins, columns=_BINS))


def _numbers(column: "pd.Series[Any]") -> list[float]:
    """The numbers of a column, which has no text."""
    if text := [of for of in column if isinstance(of, str)]:
        raise ValueError(f"{column.name} has text in {len(text)} rows, such as {text[0]!r}: give numbers")
    return column.astype(float).tolist()


def _exceeds(table: "pd.DataFrame", limit: str) -> list[bool | None]:
    """Whether each run of a sweep's table exceeds the limit; None where that is unknown."""
    columns = _native.columns_of(limit, list(table.columns.astype(str)))
    table[columns].apply(_numbers)
    peaks = table[columns].max(axis=1)
    if columns and (missing := int((peaks.isna() & (table["ending"] != "failed")).sum())):
        raise ValueError(f"{', '.join(columns)} is NaN in {missing} rows of runs that ended: choose a limit that their structures "
                         f"have, or leave them out by table.dropna(subset={columns!r}, how='all'); removed runs do not count")
    endings = [str(ending) for ending in table["ending"]]
    return _native.exceeds(endings, peaks.tolist(), table["g[m/s2]"].tolist(), limit, table["B[m]"].max(), columns)


def intensity_at(
    structure: "Structure",
    records: "_Records",
    limit: str = "overturned",
    *,
    scale: "ArrayLike | None" = None,
    accuracy: float = 1e-3,
    **options: Any,
) -> "pd.DataFrame":
    """The weakest ground motion that reaches a limit, record by record: incremental dynamic analysis to a target.

    limit: as in `fragility`. scale: increasing factors on the accelerations, the stripes; by default 60 that take the PGA from
    0.1 to 30 times g tan(alpha_cg). The structure runs at all of them under each record. Between the first stripe that reaches
    the limit and the one below, bisection finds the scale to `accuracy`, relative. options: as in `sweep`, but for path.

    Returns a DataFrame with a row per record: the row of `sweep` at the weakest scale found that reaches the limit, and `note`.
    The numbers are NaN if there is no such scale, and the note then says why. Otherwise the note names the stronger stripes at
    which the structure stays within the limit again. It also names weaker stripes whose runs failed or still rock.
    """
    import numpy as np

    motions = dict(_named(records))
    onset = structure.g * math.tan(structure.alpha_cg)
    unit = {name: onset / of.pga if scale is None else 1.0 for name, of in motions.items()}
    stripes = np.geomspace(0.1, 30, 60) if scale is None else np.asarray(scale, float)
    if (np.diff(stripes) <= 0).any() or stripes[0] <= 0:
        raise ValueError(f"scale = {stripes.tolist()}: increasing factors greater than 0 are needed")

    def runs(factors: dict[str, float], scale: "ArrayLike") -> "tuple[pd.DataFrame, list[bool | None]]":
        table = sweep(structure, {name: motions[name].scaled(factor) for name, factor in factors.items()}, scale=scale, **options)
        of_rows = table["record"].map(factors)
        table["scale"] *= of_rows
        table["record_scale"] /= of_rows
        return table, _exceeds(table, limit)

    reached = np.array(runs(unit, stripes)[1], object).reshape(len(motions), -1)
    notes, low, high = {}, {}, {}
    for (name, factor), at_stripes in zip(unit.items(), reached):
        over = np.flatnonzero(at_stripes == True)
        below = np.arange(len(stripes)) < (over[0] if len(over) else len(stripes))
        said = {"unknown at scale": factor * stripes[(at_stripes == None) & below],
                "within the limit again at scale": factor * stripes[(at_stripes == False) & ~below]}
        notes[name] = "; ".join(f"{what} {', '.join(f'{at:.4g}' for at in scales)}" for what, scales in said.items() if len(scales))
        if not len(over):
            notes[name] = "; ".join(filter(None, [f"not reached up to scale {factor * stripes[-1]:.4g}", notes[name]]))
        elif over[0] == 0:
            notes[name] = f"reached at the weakest stripe, scale {factor * stripes[0]:.4g}: begin lower"
        else:
            low[name], high[name] = factor * stripes[over[0] - 1], factor * stripes[over[0]]
    while open_ := [name for name in high if high[name] > low[name] * (1 + accuracy)]:
        middle = {name: math.sqrt(low[name] * high[name]) for name in open_}
        for name, exceeds in zip(open_, runs(middle, 1.0)[1]):
            (low if exceeds is False else high)[name] = middle[name]
    found = runs(high or unit, 1.0)[0].set_index("record")
    found = found[found.index.isin(list(high))].reindex(list(motions)).reset_index()
    return found.assign(note=[notes[name] for name in motions])
