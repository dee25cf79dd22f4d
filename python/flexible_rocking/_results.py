"""Results of runs as tables and pictures."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsIndex, overload

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ._native import Record, Run

# A quantity in a picture: its name in the results, its label with its unit, and the size of the unit in SI units.
Axis = tuple[str, str, float]


@contextmanager
def extras() -> Iterator[None]:
    """Imports modules that the package's extra `all` installs. Raises ImportError with the remedy if one is missing."""
    try:
        yield
    except ImportError as missing:
        raise ImportError(f"{missing.name} is missing: run pip install \"flexible-rocking[all]\", or in a clone of the source "
                          "pip install \".[all]\"", name=missing.name) from missing


class Peak(float):
    """The largest magnitude of a quantity in a run, exact between all instants: a float in `unit`.

    time: the first instant that has it, s. digits: how many of its digits are sure (0 to 14), of a run with condition=True, or None.
    """

    time: float
    unit: str
    digits: int | None

    def __new__(cls, value: float, time: float, unit: str, digits: int | None = None) -> "Peak":
        peak = super().__new__(cls, value)
        peak.time, peak.unit, peak.digits = time, unit, digits
        return peak

    @property
    def value(self) -> float:
        """The magnitude as a plain float."""
        return float(self)

    def __getnewargs__(self) -> tuple[float, float, str, int | None]:  # type: ignore[override]
        return self.value, self.time, self.unit, self.digits

    def __repr__(self) -> str:
        return f"{self.value} {self.unit} at {self.time} s"


class Condition(NamedTuple):
    """How sure the results of a run are.

    digits: sure digits of the peak of theta or, if the structure overturns, of the time until then, as in the rows of `sweep`; 0 if the
    run under 1 + 1e-12 times the input ends otherwise. overturning_digits: sure digits of whether it overturns, 13 for more than 12.
    overturning_change: the least relative change of the input that decides otherwise, of +-1e-14, +-1e-13, ..., +-1e-2, or None.
    """

    digits: int
    overturning_digits: int
    overturning_change: float | None


class Transition(NamedTuple):
    """A transition of a run. kind: "uplift left", "impact right", "landing", "settling", "overturning left", ...

    before, after: u (m), u_dot (m/s), theta (rad), theta_dot (rad/s) just before and just after its time (s). Many masses have
    u[1], u_dot[1], ... of each floor.
    """

    time: float
    kind: str
    before: dict[str, float]
    after: dict[str, float]

    def __repr__(self) -> str:
        return f"{self.kind} at {self.time} s"


class Transitions(list[Transition]):
    """The transitions of a run in the order of time. components: names of the numbers of a state, with their units."""

    def __init__(self, transitions: Iterable[Transition] = (), components: "dict[str, str] | None" = None):
        super().__init__(transitions)
        self.components = components or {"u": "m", "u_dot": "m/s", "theta": "rad", "theta_dot": "rad/s"}

    @overload
    def __getitem__(self, at: SupportsIndex) -> Transition: ...
    @overload
    def __getitem__(self, at: slice) -> "Transitions": ...
    def __getitem__(self, at: Any) -> Any:
        found: Any = super().__getitem__(at)
        return Transitions(found, self.components) if isinstance(at, slice) else found

    def to_pandas(self) -> "pd.DataFrame":
        """A DataFrame with the time as its index, the kind, and the state before and after: a row per transition. attrs has units."""
        with extras():
            import pandas

        states = {f"{name}_{when}": unit for when in ("before", "after") for name, unit in self.components.items()}
        rows = [(of.time, of.kind, *of.before.values(), *of.after.values()) for of in self]
        table = pandas.DataFrame(rows, columns=["time", "kind", *states]).set_index("time")
        table.attrs["units"] = {"time": "s", **states}
        return table


class Worst(NamedTuple):
    """The worst value of a run for one limit of the model.

    value: the largest value; for R_v_min and weight_min the smallest. time: the first instant of the value, s.
    limit: a value beyond the limit gives a warning. first_beyond: the first instant beyond the limit, s, or None.
    beyond: time beyond the limit, s, or number of impacts.
    """

    value: float
    time: float
    limit: float
    first_beyond: float | None
    beyond: float

    def __repr__(self) -> str:
        passed = "never passed" if self.first_beyond is None else f"passed first at {self.first_beyond} s"
        return f"{self.value} at {self.time} s; limit {self.limit}, {passed}"


@dataclass(frozen=True, repr=False)
class Advice:
    """Every level of detail on one scene, and which is the cheapest that will do: what `advise` returns.

    detail: the recommended level, or None if no level is good enough. keep: how many modes to keep, or None for one mass.
    text: the printed form. levels: a dict each, with level, keep (only of many masses), relative errors by criterion, overturned (None if it still rocks), steps, evaluations,
    cost_of_auto (steps and evaluations as a multiple of those of auto).
    """

    detail: str | None
    keep: int | None
    levels: list[dict[str, Any]]
    text: str

    def __repr__(self) -> str:
        return self.text


class Response(dict[str, "NDArray[Any]"]):
    """The motion of a run at instants, or a curve: arrays by name, all of one length; `units` has theirs."""

    def __init__(self, columns: dict[str, Any], units: dict[str, str]):
        import numpy as np

        super().__init__({name: np.asarray(column) for name, column in columns.items()})
        self.units = units

    def to_pandas(self) -> "pd.DataFrame":
        """A DataFrame with the first array, such as the time, as its index and a column a quantity. attrs["units"] has the units."""
        with extras():
            import pandas

        table = pandas.DataFrame(dict(self)).set_index(next(iter(self)))
        table.attrs["units"] = dict(self.units)
        return table


class Profile(Response):
    """The largest magnitudes of a run floor by floor: arrays by name, floors from below; `units` has theirs.

    floor (from 1 on) is the index of to_pandas(). Of a storey, which is below its floor: drift, V, M (at its foot).
    """


class Estimate(dict[str, float]):
    """Demands without a time history by name, SI units; printed, with units and equation numbers."""

    def __init__(self, values: dict[str, float], text: str):
        super().__init__(values)
        self.text = text

    def __repr__(self) -> str:
        return self.text


def plot_run(run: "Run", kind: str, histories: list[Axis], heights: list[tuple[str, str, str, float]]) -> "Figure":
    """The picture of a run that `kind` names, with these axes: over time, or over the height at "Floors", along "Storeys" or at their "Feet"."""
    kinds = {"history": partial(plot_history, run, histories), "profile": partial(plot_profile, run, heights)}
    if kind not in kinds:
        raise ValueError(f"kind = {kind!r} is unknown; these are known: {', '.join(kinds)}")
    return kinds[kind]()


def plot_profile(run: "Run", shown: list[tuple[str, str, str, float]]) -> "Figure":
    """Peaks of floors and storeys over the height, and those of the structure on a fixed base, as far as the run goes."""
    import numpy as np

    from ._native import simulate

    with extras():
        from matplotlib import pyplot

    if not len(run.profile["h"]):
        raise ValueError("the structure has no floors, and therefore no profile: give masses, heights and shapes")
    fixed = simulate(run.structure, run.record, detail="fixed_base", tolerance=run.tolerance, duration=run.end - run.start)
    figure, axes = pyplot.subplots(1, len(shown), sharey=True, figsize=(10, 5), layout="constrained")
    for of, label, style in ((run, "rocking", "-o"), (fixed, "fixed base", "--o")):
        h = np.concatenate([[0], of.profile["h"]])
        for axis, (place, name, title, size) in zip(axes, shown):
            values = of.profile[name] / size
            if place == "Floors":
                axis.plot(np.concatenate([[of.peaks["a_g"] / size], values]), h, style, markersize=3, label=label)
            elif place == "Feet":  # linear over a storey
                axis.plot(np.concatenate([values, [0]]), h, style, markersize=3, label=label)
            else:
                axis.stairs(values, h, orientation="horizontal", baseline=None, linestyle=style.rstrip("o"), label=label)
            axis.set(xlabel=title)
    for axis in axes:
        axis.set(xlim=(0, None), ylim=(0, None))
        axis.locator_params(axis="x", nbins=3)
    axes[0].set(ylabel="height (m)")
    axes[0].legend()
    figure.suptitle(run.record.title)
    return figure


def plot_record(record: "Record") -> "Figure":
    """The accelerations of a record over time."""
    with extras():
        from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(8, 3), layout="constrained")
    for label, of in (("$a_g$", record.a_g), ("$a_v$", record.a_v)):
        if of is not None:
            axis.plot(record.time, of / 9.81, linewidth=0.8, label=label)
    axis.set(xlabel="time (s)", ylabel="acceleration (g)", title=record.title)
    axis.legend()
    return figure


def plot_history(run: "Run", shown: list[Axis]) -> "Figure":
    """The histories of a run, with marks at its transitions, and a dashed line from which the structure falls."""
    import numpy as np

    with extras():
        from matplotlib import pyplot

    response = run.at(np.linspace(run.start, run.end, 4001))
    figure, axes = pyplot.subplots(len(shown), sharex=True, figsize=(8, 7), layout="constrained")
    instants = [transition.time for transition in run.transitions]
    for axis, (name, label, size) in zip(axes, shown):
        axis.plot(response["time"], response[name] / size, linewidth=0.8)
        axis.plot(instants, run.at(instants)[name] / size, ".", markersize=3, label="transitions")
        axis.set(ylabel=label, xlim=(run.start, run.end))
        if run.fall is not None:
            axis.axvline(run.fall, color="tab:purple", linestyle="--", linewidth=0.8, label="falls")
    axes[0].legend(loc="upper right", fontsize="small")
    axes[-1].set(xlabel="time (s)")
    figure.suptitle(run.record.title if run.fall is None else f"{run.record.title}, falls from {run.fall:.6g} s on")
    return figure
