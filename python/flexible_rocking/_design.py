"""The value of a number of a structure at which limits hold."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _native
from ._results import extras
from ._sweep import _named

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

    from ._native import Structure
    from ._sweep import _Records


@dataclass(frozen=True, repr=False)
class Design:
    """The value of a number at which limits hold in a share of the runs: what `design` returns. print(it) says it in a sentence.

    value: the value from which on, or up to which, the limits hold at every value that was run; None if they hold at both ends of the
    range or at neither. holds: first and last value of each stretch in which they hold. crossings: neighbours of which one holds.
    structure: the structure with `value`, or None. curve: a DataFrame by rising value: the number, whether the limits hold, the part of
    the runs within them, how many runs are unknown (failed or still rocking; they count as beyond), and of each limit the demand that
    the share of the runs does not exceed, as a fraction of the limit, inf if it is that of a run that overturned or is unknown.
    """

    value: float | None
    holds: list[tuple[float, float]]
    crossings: list[tuple[float, float]]
    structure: "Structure | None"
    curve: "pd.DataFrame"
    share: float
    text: str

    def __repr__(self) -> str:
        return self.text

    def plot(self, axes: "Axes | None" = None) -> "Axes":
        """Draws the demands over the number, and marks the stretches in which the limits hold, in `axes` or new ones, which are returned."""
        with extras():
            from matplotlib import pyplot

        axes = axes if axes is not None else pyplot.subplots(layout="constrained")[1]
        name, _, _, _, *limits = self.curve
        for limit in limits:
            axes.plot(self.curve[name], self.curve[limit], ".-", linewidth=0.8, label=limit)
        axes.axhline(1, color="0.4", linestyle="--")
        for first, last in self.holds:
            axes.axvspan(first, last, color="tab:green", alpha=0.15, linewidth=0)
        axes.set(xlabel=name, ylabel=f"demand in {100 * self.share:g} % of the runs over its limit", ylim=(0, 3))
        axes.legend()
        return axes


def design(
    structure: "Structure",
    records: "_Records",
    vary: str,
    between: tuple[float, float],
    limit: str | Sequence[str],
    *,
    share: float = 0.84,
    count: int = 25,
    log: bool = False,
    refine: int = 3,
    scale: "float | ArrayLike" = 1.0,
    detail: Any = "auto",
    tolerance: float = 1e-9,
    duration: float | None = None,
    threads: int = 0,
    **initial: "ArrayLike",
) -> Design:
    """Finds the value of a number at which limits hold in a share of the runs: the least prestress, the largest height.

    vary: the name of a parameter, of a number of a storey ("k[1]") or of ground ("f_v"), or "slenderness" (H/B). between: its first and
    last value, in SI units. limit: one or several that must all hold, such as "theta <= 0.5 %", "pressure <= 4e5", "a_t <= 0.4 g" (the peaks
    and units of `fragility`), or "stands". share: the least part of the runs that is within all of them.

    count: number of values of the first pass (3 to 1000), evenly spaced, with log=True in their logarithms. refine: how often the step
    is divided by 8 between neighbours of which one holds (0 to 8). records, scale and the rest: as in `sweep`; every record at
    every scale is a run. Rocking is not monotone in most numbers: between two neighbours that agree nothing is known, so look at the curve
    or raise `count`.

    Raises ValueError for a number, a limit or a range that the structure does not have.
    """
    with extras():
        import pandas

    limits = [limit] if isinstance(limit, str) else list(limit)
    value, holds, crossings, text, unit, rows = _native.design(structure, _named(records), vary, between, limits, share, count, log, refine,
                                                               scale, detail, tolerance, duration, initial, threads)
    name = vary if unit == "1" else f"{vary}[{unit}]"
    curve = pandas.DataFrame([(*row, *demands) for *row, demands in rows], columns=[name, "holds", "within", "unknown", *limits])
    found = None if value is None else _native.varied(structure, {vary: value})
    return Design(value, [(a, b) for a, b in holds], [(a, b) for a, b in crossings], found, curve, share, text)
