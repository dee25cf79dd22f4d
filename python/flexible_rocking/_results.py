"""What runs return, as Python has it: tables and pictures."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ._native import Run

LABELS = {"a_g": ("m/s2", "$a_g$"), "theta": ("rad", r"$\theta$"), "u": ("m", "$u$"), "a_t": ("m/s2", "$a_t$")}


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
