"""Results of runs as tables and pictures."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ._native import Run

LABELS = {"a_g": ("m/s2", "$a_g$"), "theta": ("rad", r"$\theta$"), "u": ("m", "$u$"), "a_t": ("m/s2", "$a_t$")}


class Peak(float):
    """The largest magnitude of a quantity in a run, exact between all instants: a float in `unit`.

    time: the first instant that has it, s.
    """

    time: float
    unit: str

    def __new__(cls, value: float, time: float, unit: str) -> "Peak":
        peak = super().__new__(cls, value)
        peak.time, peak.unit = time, unit
        return peak

    @property
    def value(self) -> float:
        """The magnitude as a plain float."""
        return float(self)

    def __getnewargs__(self) -> tuple[float, float, str]:  # type: ignore[override]
        return self.value, self.time, self.unit

    def __repr__(self) -> str:
        return f"{self.value} {self.unit} at {self.time} s"


class Transition(NamedTuple):
    """A transition of a run. kind: "uplift left", "impact right", "landing", "settling", "overturning left", ...

    before, after: u (m), u_dot (m/s), theta (rad), theta_dot (rad/s) just before and just after its time (s).
    """

    time: float
    kind: str
    before: dict[str, float]
    after: dict[str, float]

    def __repr__(self) -> str:
        return f"{self.kind} at {self.time} s"


class Transitions(list[Transition]):
    """The transitions of a run in the order of time."""

    def to_pandas(self) -> "pd.DataFrame":
        """A DataFrame with the time as its index, the kind, and the state before and after: a row per transition."""
        import pandas

        states = [f"{name}_{when}" for when in ("before", "after") for name in ("u", "u_dot", "theta", "theta_dot")]
        rows = [(of.time, of.kind, *of.before.values(), *of.after.values()) for of in self]
        return pandas.DataFrame(rows, columns=["time", "kind", *states]).set_index("time")


class Worst(NamedTuple):
    """How far a run goes beyond one of the things that the model takes for granted.

    value: the largest value, of R_v_min the least. time: the first instant of the value, s.
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

    detail: the recommended level, or None if no level is good enough. text: the printed form.
    levels: a dict each, with level, relative errors by criterion, overturned (None if it still rocks), steps, evaluations,
    cost_of_auto (steps and evaluations as a multiple of those of auto).
    """

    detail: str | None
    levels: list[dict[str, Any]]
    text: str

    def __repr__(self) -> str:
        return self.text


class Response(dict[str, "NDArray[Any]"]):
    """The motion of a run at instants: arrays by name, all of one length; `units` has theirs."""

    def __init__(self, columns: dict[str, Any], units: dict[str, str]):
        import numpy as np

        super().__init__({name: np.asarray(column) for name, column in columns.items()})
        self.units = units

    def __reduce__(self) -> tuple[type["Response"], tuple[dict[str, Any], dict[str, str]]]:
        return Response, (dict(self), self.units)

    def to_pandas(self) -> "pd.DataFrame":
        """A DataFrame with the time as its index and a column a quantity."""
        import pandas

        return pandas.DataFrame(dict(self)).set_index("time")


class Estimate(dict[str, float]):
    """Demands without a time history by name, SI units; printed, with units and equation numbers."""

    def __init__(self, values: dict[str, float], text: str):
        super().__init__(values)
        self.text = text

    def __reduce__(self) -> tuple[type["Estimate"], tuple[dict[str, float], str]]:
        return Estimate, (dict(self), self.text)

    def __repr__(self) -> str:
        return self.text


def plot_run(run: "Run") -> "Figure":
    """The histories of a run, with marks at its transitions, and a dashed line from which the structure falls."""
    import numpy as np
    from matplotlib import pyplot

    response = run.at(np.linspace(run.start, run.end, 4001))
    figure, axes = pyplot.subplots(len(LABELS), sharex=True, figsize=(8, 7), layout="constrained")
    instants = [transition.time for transition in run.transitions]
    for axis, (name, (unit, symbol)) in zip(axes, LABELS.items()):
        axis.plot(response["time"], response[name], linewidth=0.8)
        axis.plot(instants, run.at(instants)[name], ".", markersize=3)
        axis.set(ylabel=f"{symbol} ({unit})", xlim=(run.start, run.end))
        if run.fall is not None:
            axis.axvline(run.fall, color="tab:purple", linestyle="--", linewidth=0.8)
    axes[-1].set(xlabel="time (s)")
    figure.suptitle(run.record.title if run.fall is None else f"{run.record.title}, falls from {run.fall:.6g} s on")
    return figure
