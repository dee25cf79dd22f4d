"""Numbers of a structure from measured histories."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

from . import _native
from ._results import extras

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ._native import Record, Structure

    _Array = NDArray[Any]

INITIAL = {"theta_0": "rad", "theta_dot_0": "rad/s", "u_0": "m", "u_dot_0": "m/s"}
PARTS = 10  # parts of the traces, each of which is fitted with those before: late impacts agree only once the early ones do
ALIKE = 0.95  # least correlation of two numbers that is noted
FOLLOWING = 0.5  # least correlation of neighbouring residuals that is noted


@dataclass(frozen=True, repr=False)
class Calibration:
    """Numbers that fit measured histories: what `calibrate` returns. print(it) shows values, intervals and notes.

    structure, initial: the structure and the initial values that were found. values: by name. table: a DataFrame with a row per number:
    value, low and high of its 95 % interval (infinite if the traces do not depend on it), start, unit. correlations: a DataFrame. samples: a
    DataFrame of trace, time (of the run, s), measured, model and residual in SI units. noise: the standard deviation of each trace's
    residuals. notes: sentences about numbers that the traces do not determine, and about residuals that are no noise.
    """

    structure: "Structure"
    initial: dict[str, Any]
    values: dict[str, float]
    table: "pd.DataFrame"
    correlations: "pd.DataFrame"
    samples: "pd.DataFrame"
    noise: dict[str, float]
    notes: list[str]

    def to_pandas(self) -> "pd.DataFrame":
        """The table."""
        return self.table

    def __repr__(self) -> str:
        noise = [f"noise of {name}: {of:.3g} {self.samples.attrs['units'][name]}" for name, of in self.noise.items()]
        return "\n".join([self.table.to_string(float_format="{:.6g}".format), *noise, *self.notes])

    def plot(self) -> "Figure":
        """Draws each trace with the model's, and its residuals beside them."""
        with extras():
            from matplotlib import pyplot

        figure, axes = pyplot.subplots(len(self.noise), 2, sharex=True, squeeze=False, figsize=(9, 2.4 * len(self.noise)), layout="constrained")
        for name, (history, residual) in zip(self.noise, axes):
            of = self.samples[self.samples["trace"] == name]
            history.plot(of["time"], of["measured"], ".", color="0.6", markersize=2, label="measured")
            history.plot(of["time"], of["model"], linewidth=0.8, label="model")
            residual.plot(of["time"], of["residual"], linewidth=0.6)
            history.set(ylabel=f"{name} ({self.samples.attrs['units'][name]})")
            residual.set(ylabel="measured - model")
        axes[0, 0].legend(loc="upper right", fontsize="small")
        for axis in axes[-1]:
            axis.set(xlabel="time (s)")
        return figure


def calibrate(
    structure: "Structure",
    traces: "Mapping[str, Any] | pd.DataFrame",
    record: "Record | str | PathLike[str] | None" = None,
    *,
    fit: Sequence[str] = ("r", "zeta_fc", "f_fc"),
    start: bool = False,
    offset: bool = False,
    detail: Any = "auto",
    tolerance: float = 1e-9,
    **initial: Any,
) -> Calibration:
    """Finds the numbers of a structure that fit measured histories best: least squares over all samples.

    traces: by name, as in `run.at` ("theta" in rad, "u", "uplift", "delta_t" in m, "a_t" in m/s2, "a_t[3]" of floor 3): each a Series with
    the times (s) as its index, or a pair of arrays (n,) of times and values; or a DataFrame. record: the ground motion; without it, free
    vibration from the initial values. detail, tolerance and initial values: as in `simulate`.

    fit: names of parameters, of storeys' numbers such as "k[2]", of ground such as "f_v" and "zeta_v", and of initial values. The
    structure has their start values, except in free vibration on rigid ground: the ratio of successive amplitudes gives r, and the
    last vibration in full contact gives f_fc and zeta_fc (below). An initial value that is not given starts at the first sample
    (theta_0) or at u_cr (u_0). start: whether each trace has an unknown "start[theta]", the time of the run (s) at the time 0 of
    the trace; before the run the structure rests in its initial state. offset: whether each trace has an unknown constant, "offset[theta]".

    Minimises sum_i sum_k ((x_i(t_k) - m_i(t_k))/s_i)^2 with s_i the standard deviation of the residuals of trace i, by scipy's least_squares
    within the ranges of the numbers, over a tenth, two tenths, ... and all of each trace. With J the derivatives of the weighted
    model, the covariance is (J^T J)^-1 times the mean square; half a 95 % interval is Student's quantile times the standard deviation.
    The intervals hold for independent noise: a note says if residuals follow each other.

    Start values: with T = tan(alpha_cg), the rocking mode (Eqs 11, 16) comes to its pivot at q_0 = chi p_l^2 T/omega_fc^2, where r multiplies
    its velocity. Amplitudes q = theta + q_0 and q' before and after an impact have r^2 = [(T + q_0)^2 - (T - q')^2]/[(T - q_0)^2 - (T - q)^2].
    In full contact (Eq 1) amplitudes fall by exp(-zeta_fc omega_fc t).

    Raises ValueError for a trace or a number that the structure does not have, for samples that are not finite or fewer than the numbers,
    and for a start value of 0, which has no scale.
    """
    with extras():
        import numpy as np
        import pandas
        from scipy import optimize, stats  # type: ignore[import-untyped]

    units = _native.simulate(structure, duration=1e-3, detail=detail).at(0.0).units
    known: dict[str, Any] = {name: of for name, *of in _native.numbers_of(structure)}
    order = [str(name) for name in traces]
    for what, asked, names in (("traces", order, [*units][1:]), ("fit", [*fit], [*known, *INITIAL])):
        if unknown := [name for name in asked if name not in names] or ([] if asked else ["nothing"]):
            raise ValueError(f"{what}: {unknown[0]!r} is unknown, or the structure does not have it: choose from {', '.join(names)}")
    measured = [_trace(name, traces[name]) for name in order]
    t, x = (np.concatenate(of) for of in zip(*measured))
    who = np.repeat(np.arange(len(measured)), [len(of) for of, _ in measured])  # the trace of each sample
    late = np.concatenate([(of - of[0]) / (of[-1] - of[0]) for of, _ in measured])
    begins = 0.0 if record is None else _native.simulate(structure, record, duration=1e-3, detail=detail).start

    def run(values: Mapping[str, float], t: "_Array", who: "_Array") -> "_Array":
        """The model at the times `t` (n,) of the traces `who` (n,)."""
        at = np.maximum(t + np.array([values.get(f"start[{name}]", 0.0) for name in order])[who], begins)
        varied = _native.varied(structure, {name: of for name, of in values.items() if name in known})
        states = initial | {name: of for name, of in values.items() if name in INITIAL}
        end = float(at.max()) - begins + 1e-3
        found = _native.simulate(varied, record, duration=end, detail=detail, tolerance=tolerance, **states).at(at)
        model = np.stack([found[name] + values.get(f"offset[{name}]", 0.0) for name in order])
        return np.asarray(model[who, np.arange(len(t))])

    raised = [float(np.median(of[-max(len(of) // 10, 1):])) if offset else 0.0 for _, of in measured]
    starts: dict[str, float] = {name: known[name][1] if name in known else initial.get(name, 0.0) for name in fit}
    if record is None and "ground" not in structure.parameters and "f_fc" in known:
        closed = _closed_forms(structure, {name: (t, x - of) for name, (t, x), of in zip(order, measured, raised)})
        starts |= {name: of for name, of in closed.items() if name in starts and name not in initial}
    if zero := [name for name, of in starts.items() if of == 0]:
        raise ValueError(f"{zero[0]} = 0 is no start value, because it has no scale: give another")
    scales = {name: abs(of) for name, of in starts.items()}
    noise = np.array([np.std(of) + 1e-9 * np.abs(of).max() for _, of in measured])  # until there are residuals
    size = noise.copy()
    placed = _placed(run, starts, begins, measured, start, offset) if start or offset else []
    for name, (shift, level), of in zip(order, placed, size):
        starts |= ({f"start[{name}]": shift} if start else {}) | ({f"offset[{name}]": level} if offset else {})
        scales |= ({f"start[{name}]": 1e-2 * (t.max() - t.min())} if start else {}) | ({f"offset[{name}]": of} if offset else {})
    names, scale = [*scales], np.array([*scales.values()])
    low, high = np.array([known[name][2:] if name in known else (-np.inf, np.inf) for name in names]).T / scale
    if len(t) <= len(names):
        raise ValueError(f"{len(t)} samples are too few for {len(names)} numbers: {', '.join(names)}")

    def residuals(z: "_Array", part: float) -> "_Array":
        kept = late <= part
        found = run(dict(zip(names, (z * scale).tolist())), t[kept], who[kept])
        # a structure that has overturned has no motion
        return np.asarray(np.where(np.isnan(found), 10 * size[who[kept]], found - x[kept]) / noise[who[kept]])

    def derivatives(z: "_Array", part: float) -> "_Array":
        base, steps = residuals(z, part), np.diag(np.where(z + 1e-6 > high, -1e-6, 1e-6))
        return np.stack([(residuals(z + step, part) - base) / step.sum() for step in steps], 1)

    def fitted(z: "_Array", part: float) -> "_Array":
        held = np.eye(len(z)) * (part < 1)  # a part leaves the numbers that it does not determine
        found = optimize.least_squares(lambda of: np.append(residuals(of, part), held @ (of - z)), z, bounds=(low, high),
                                       jac=lambda of: np.vstack([derivatives(of, part), held]), xtol=1e-3 if part < 1 else 1e-8)
        return np.asarray(found.x)

    z = np.clip([starts[name] for name in names] / scale, low, high)
    for part in range(PARTS):
        z = fitted(z, (part + 1) / PARTS)
    for again in range(3 if len(measured) > 1 else 1):  # several traces have the weights that follow from their residuals
        z = fitted(z, 1) if again else z
        left = residuals(z, 1) * noise[who]
        noise = np.maximum([np.std(left[who == of]) for of in range(len(measured))], 1e-12 * size)
    J, values = derivatives(z, 1), z * scale
    gram = J.T @ J
    covariance = np.linalg.inv(gram + 1e-12 * max(gram.trace(), 1.0) * np.eye(len(z))) * np.sum((left / noise[who]) ** 2) / (len(t) - len(z))
    deviations = np.sqrt(np.diag(covariance))
    correlations = covariance / np.outer(deviations, deviations)
    half = stats.t.ppf(0.975, len(t) - len(z)) * np.where(np.diag(gram) > 0, deviations, np.inf) * scale
    notes = [f"the traces do not determine {name}: half its interval is {of:.2g}" for name, of, value in zip(fit, half, values) if of >= abs(value)]
    notes += [f"{a} and {b} move the traces alike: correlation {correlations[i, j]:.3f}; fix one of them, or add a trace"
              for i, a in enumerate(names) for j, b in enumerate(names[:i]) if abs(correlations[i, j]) > ALIKE]
    follows = [np.corrcoef(left[who == of][1:], left[who == of][:-1])[0, 1] for of in range(len(measured))]
    notes += [f"the residuals of {name} follow each other (correlation {of:.2f}): the model misses something, and the intervals are too narrow"
              for name, of in zip(order, follows) if of > FOLLOWING]
    found = dict(zip(names, values.tolist()))
    unit = {name: of[0] for name, of in known.items()} | INITIAL
    unit |= {f"{what}[{name}]": of for name in order for what, of in (("start", "s"), ("offset", units[name]))}
    table = pandas.DataFrame({"value": values, "low": values - half, "high": values + half, "start": [starts[of] for of in names],
                              "unit": [unit[of] for of in names]}, names)
    of_run = t + np.array([found.get(f"start[{name}]", 0.0) for name in order])[who]
    samples = pandas.DataFrame({"trace": np.array(order)[who], "time": of_run, "measured": x, "model": x + left, "residual": -left})
    samples.attrs["units"] = {name: units[name] for name in order}
    return Calibration(_native.varied(structure, {name: found[name] for name in fit if name in known}),
                       initial | {name: found[name] for name in fit if name in INITIAL}, found, table, pandas.DataFrame(correlations, names, names),
                       samples, dict(zip(order, noise.tolist())), notes)


def _trace(name: str, of: Any) -> "tuple[_Array, _Array]":
    """Times and values of a trace."""
    import numpy as np

    time, values = (np.asarray(column, float) for column in ((of.index, of) if hasattr(of, "to_frame") else of))
    if time.shape != values.shape or time.ndim != 1 or len(time) < 2:
        raise ValueError(f"traces: {name} has times of the shape {time.shape} and values of {values.shape}: two or more of each are needed")
    if not (np.isfinite([time, values]).all() and (np.diff(time) > 0).all() and values.any()):
        raise ValueError(f"traces: {name} needs finite values, not all of them 0, at times that rise: leave out NaN by dropna()")
    return time, values


def _closed_forms(structure: "Structure", traces: "dict[str, tuple[_Array, _Array]]") -> dict[str, float]:
    """Start values from a free vibration, as `calibrate` describes them."""
    import numpy as np
    from scipy.signal import find_peaks  # type: ignore[import-untyped]

    found: dict[str, float] = {}
    T, B, H, u_cr = np.tan(structure.alpha_cg), structure.B, structure.H, structure.u_cr
    for name, least in {"a_t": structure.g * T / 2, "u": u_cr / 2, "delta_t": u_cr / 2}.items():
        time, x = traces.get(name, (np.zeros(0), np.zeros(0)))
        after = int(np.max(np.flatnonzero(np.abs(x) >= least), initial=-1)) + 1  # beyond, the base is down
        if not found and after < len(x) - 16:
            found = _vibration(time[after:], x[after:])
    q_0 = structure.chi * structure.p_l**2 * T / (2 * np.pi * found.get("f_fc", structure.f_fc)) ** 2
    for name, per_theta in {"theta": 1.0, "uplift": 2 * B, "delta_t": H}.items():
        if name in traces and "r" not in found:
            theta = np.abs(traces[name][1]) / per_theta
            q = theta[find_peaks(np.append(0.0, theta), prominence=0.2 * theta.max())[0] - 1] + q_0  # the first sample may be one
            if len(q) > 1 and (q < T).all():
                squares = ((T + q_0) ** 2 - (T - q[1:]) ** 2) / ((T - q_0) ** 2 - (T - q[:-1]) ** 2)
                found |= {"r": float(np.clip(np.sqrt(np.median(squares)), 0.3, 1)), "theta_0": float(traces[name][1][0] / per_theta)}
    return found | {"u_0": float(np.copysign(u_cr, found.get("theta_0", 1.0)))}


def _vibration(time: "_Array", x: "_Array") -> dict[str, float]:
    """f_fc (Hz) and zeta_fc of a free vibration, if it is one: the peak of its spectrum, and the ratio of its two halves there."""
    import numpy as np

    energy = np.cumsum(x**2)
    t = np.linspace(time[0], time[np.searchsorted(energy, 0.9 * energy[-1])], 2 * (len(x) // 2))
    x, span = np.interp(t, time, x), t[-1] - t[0]
    spectrum = np.abs(np.fft.rfft(x, 16 * len(x)))
    f = np.argmax(spectrum) * (len(x) - 1) / (16 * len(x) * span)
    first, second = np.abs((x * np.exp(-2j * np.pi * f * t)).reshape(2, -1).sum(1))
    if f * span < 4 or spectrum.max() < 8 * np.median(spectrum) or first <= second:
        return {}
    rate = 2 * np.log(first / second) / span
    omega = np.hypot(2 * np.pi * f, rate)
    return {"f_fc": float(omega / (2 * np.pi)), "zeta_fc": float(rate / omega)}


def _placed(run: Any, starts: dict[str, float], begins: float, measured: "list[tuple[_Array, _Array]]", start: bool,
            offset: bool) -> list[tuple[float, float]]:
    """Start and offset of each trace that are best for the start values: of 801 starts up to half of the span away, if all begin together."""
    import numpy as np

    span = max(t[-1] - t[0] for t, _ in measured)
    dense = begins + np.linspace(0, 1.5 * span, 4000)
    model = np.nan_to_num(run(starts, np.tile(dense, len(measured)), np.repeat(np.arange(len(measured)), 4000))).reshape(-1, 4000)
    early = [(t[near], x[near]) for t, x in measured for near in [t <= t[0] + span / 2]]  # late impacts do not agree yet

    def placed(late: float) -> "list[tuple[float, float, _Array]]":
        shifts = [begins - t[0] + late if start else 0.0 for t, _ in early]
        left = [x - np.interp(t + shift, dense, of) for shift, (t, x), of in zip(shifts, early, model)]
        return [(shift, float(of.mean()) if offset else 0.0, of) for shift, of in zip(shifts, left)]

    def misfit(late: float) -> float:
        return sum(float(np.mean((left - level) ** 2) / np.mean(x**2)) for (_, level, left), (_, x) in zip(placed(late), early))

    best = min(span * np.linspace(-0.5, 0.5, 801) if start else [0.0], key=misfit)
    return [(shift, level) for shift, level, _ in placed(best)]
