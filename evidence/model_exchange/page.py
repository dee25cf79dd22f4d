"""Model exchange: solvers of hosts, good and bad, over the FMU."""

from pathlib import Path

from tqdm import tqdm

from ..figures import FIXED, QUIET, ROCKING, SMOOTH, save, subplots
from ..page import spread, table
from ..scenes import PACOIMA_DAM, RECORDS, exported
from .hosts import Scene, co_simulation, dop853, fmpy_cvode, fmpy_euler, sundae

TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)
STEPS = (10e-3, 1e-3, 0.2e-3)  # s
SOLVERS = {
    "CVode of fmpy (BDF)": (fmpy_cvode, ROCKING, "o-"),
    "CVODE of scikit-sundae (Adams)": (sundae, FIXED, "s--"),
    "DOP853 of scipy": (dop853, SMOOTH, "^-"),
}
_, CVODE, DOP853 = SOLVERS
THROUGH = "the same through the samples"


def record(pattern: str) -> str:
    return str(next(RECORDS.glob(f"*/{pattern}.AT2")))


def scenes(fmu: str) -> list[Scene]:
    """The pier under three earthquakes: Pacoima Dam as on the shake table, the others as they were recorded."""
    return [
        Scene("Pacoima Dam 1971", fmu, tuple(PACOIMA_DAM.items()), 3.99, 0.01),
        Scene("El Centro 1940", fmu, (("record", record("RSN6_*ELC180*")),), 15.0, 0.02),
        Scene("Corralitos 1989, half", fmu, (("record", record("RSN753_*CLS000*")), ("record_scale", 0.5)), 15.0, 0.02),
    ]


def cell(result, exact) -> str:
    ended = "" if len(result.rows) == len(exact.rows) else f", overturned at {result.rows['time'][-1]:.1f} s"
    return f"{result.error(exact):.1e}, {result.transitions} ({result.hidden}){ended}"


def errors(found) -> str:
    runs = next(iter(found.values()))[0]
    rows = [[name, f"{setting:g}", *(cell(results[name, setting], exact) for results, exact, _ in found.values())]
            for name, setting in runs]
    return table(["", "tolerance or step (s)", *(scene.name for scene in found)], rows)


def listed(values) -> str:
    *values, last = values
    return f"{', '.join(values)} and {last}"


def findings(found) -> dict:
    """First numbers of the page."""
    errors = {(scene, name, setting): result.error(exact) for scene, (results, exact, _) in found.items()
              for (name, setting), result in results.items()}
    at_1e8 = {is_one_step: spread([error for (_, name, setting), error in errors.items()
                                   if setting == 1e-8 and name in SOLVERS and (name == DOP853) == is_one_step], ".0e")
              for is_one_step in (True, False)}
    loose = [error for (_, name, setting), error in errors.items() if name in SOLVERS and setting > 1e-6]
    euler = [error for (_, name, _), error in errors.items() if "Euler" in name]
    gains = [errors[scene, THROUGH, TOLERANCES[-1]] / errors[scene, CVODE, TOLERANCES[-1]] for scene in found]
    return dict(cvode=at_1e8[False], dop853=at_1e8[True], loose=len(loose), wrong=sum(error > 0.01 for error in loose),
                euler=min(euler), gains=spread(gains, ".0f"))


def plot(path: Path, found) -> None:
    figure, axes = subplots(1, len(found), 3.4, sharey=True)
    for axis, (scene, (results, exact, floor)) in zip(axes, found.items()):
        for name, (_, color, style) in SOLVERS.items():
            axis.loglog(TOLERANCES, [results[name, tolerance].error(exact) for tolerance in TOLERANCES], style, color=color,
                        markersize=3.5, label=name)
        axis.loglog(TOLERANCES, [tolerance * floor / 1e-12 for tolerance in TOLERANCES], ":", color=QUIET,
                    label="change of the result if the input changes by the tolerance")
        axis.set(title=f"{scene.name}\n{exact.transitions} transitions", xlabel="relative tolerance")
        axis.invert_xaxis()
    axes[0].set(ylabel="largest error over the peak", ylim=(1e-12, 10))
    figure.suptitle("Every solver converges; the scene decides how many digits a tolerance is worth")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    save(figure, path)


def values(figures: Path) -> dict:
    runs = [(name, host, setting) for name, (host, *_) in SOLVERS.items() for setting in TOLERANCES]
    runs[10:10] = [(THROUGH, lambda scene, tolerance: sundae(scene, tolerance, 1e-6), tolerance) for tolerance in TOLERANCES[-2:]]
    runs += [("Euler of fmpy", fmpy_euler, step) for step in STEPS]
    found = {}
    for scene in scenes(exported("mcmanus")):
        exact = co_simulation(scene)
        results = {(name, setting): host(scene, setting) for name, host, setting in tqdm(runs, desc=scene.name)}
        found[scene] = results, exact, co_simulation(scene, 1e-12).error(exact)
    plot(figures / "tolerance.png", found)
    deepest = max(result.depth for results, *_ in found.values() for result in results.values())
    return dict(
        depth=f"up to {deepest:g} rad" if deepest else "never", runs=sum(len(results) for results, *_ in found.values()),
        **findings(found), table=errors(found),
        transitions=listed([str(exact.transitions) for _, exact, _ in found.values()]),
        conditioning=listed([f"{floor:.1e}" for *_, floor in found.values()]))
