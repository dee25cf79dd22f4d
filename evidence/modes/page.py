"""How many modes: structures of many masses under real records."""

from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from frames import Frame, cantilever
from matplotlib.ticker import MaxNLocator
from scipy.linalg import expm
from tqdm import tqdm

from ..figures import COLOURS, save, subplots
from ..page import table
from ..scenes import RECORDS as DATA
from ..scenes import G

RECORDS = sorted(map(str, DATA.glob("[!n]*/*hor*.AT2")))
SHOWN = "RSN77_SFERN_PUL164"  # whose floors are drawn
DURATION = 25.0  # of each run at most, s
LIMIT = 0.05
QUESTIONS = {"theta": "θ", "u": "u of each floor", "V": "V of each storey", "a_t": "a of each floor"}
MODES = (("mode 1", 1, 1), ("mode 2", 2, 2), ("mode 3", 3, 3), ("mode 4", 4, 4), ("modes 5 to 12", 5, 12))

WALL, PIER = (3.0, 6.0, 9.0, 12.0), (4.0, 8.0, 12.0, 16.0, 20.0, 24.0)  # heights of the masses
BUILDINGS = {
    "stiff: a wall of 4 storeys": Frame((90e3,) * 4, WALL, cantilever(WALL, 2.5e10), m0=60e3, J0=2e5, B=2.0, zeta=0.03),
    "slender: a pier of 24 m": Frame((*(50e3,) * 5, 6e5), PIER, cantilever(PIER, 1.2e11), m0=3e5, J0=2e6, B=3.0, zeta=0.03),
    "tall: a frame of 12 storeys": Frame((60e3,) * 12, tuple(3.2 * i for i in range(1, 13)), tuple(1.2e8 * (1.05 - 0.05 * i) for i in range(1, 13)),
                                         m0=1.5e5, J0=2e6, B=3.5, zeta=0.03),
}


def structure(of: Frame) -> fr.Structure:
    return fr.Structure.from_matrices(of.m, of.h, of.K, zeta=of.zeta, m0=of.m0, J0=of.J0, B=of.B)


def motion(building: Frame, record: fr.Record, detail: str = "auto") -> tuple[fr.Run, np.ndarray]:
    """A run, and the largest acceleration of each mode, m/s2."""
    run = fr.simulate(structure(building), record, detail=detail, duration=min(record.duration, DURATION))
    response = run.at(np.arange(run.start, run.end, np.pi / 10 / building.omega[-1]))  # 20 in a period
    omega, M_phi = building.omega, building.m[:, None] * building.phi
    q, q_dot = (np.column_stack([response[f"{name}[{i + 1}]"] for i in range(len(omega))]) @ M_phi for name in ("u", "u_dot"))
    return run, np.abs(2 * building.zeta * omega * q_dot + omega**2 * q).max(axis=0) / np.abs(building.m @ building.phi)


def peaks(run: fr.Run) -> dict[str, np.ndarray]:
    """Exact peaks, floor by floor."""
    return {"theta": np.array([run.peaks["theta"]]), **{name: run.profile[name] for name in ("u", "V", "a_t")}}


def errors(found: dict[str, np.ndarray], exact: dict[str, np.ndarray]) -> dict[str, float]:
    """The largest error of the floors, as a fraction of the peak of the floor."""
    return {name: float(np.abs(found[name] / exact[name] - 1).max()) for name in exact}


def reversal(building: Frame) -> np.ndarray:
    """The acceleration of each mode, m/s2, over 2 s after the weight has changed sides."""
    m, h, omega, phi, J_P = building.m, building.h, building.omega, building.phi, building.J_P
    M_phi = m[:, None] * phi
    static = np.linalg.solve(building.K, m * h * G * building.m_t * building.B / J_P)
    M_r = np.diag(m) - np.outer(m * h, m * h) / J_P
    zero, one = np.zeros_like(M_r), np.eye(len(m))
    step = np.pi / 50 / omega[-1]
    onward = expm(step * np.block([[zero, one], [-np.linalg.solve(M_r, building.K), -np.linalg.solve(M_r, building.C)]]))
    state, largest = np.concatenate([-2 * static, 0 * static]), np.zeros(len(m))
    for _ in range(int(2 / step)):
        q, q_dot = (state[: len(m)] + static) @ M_phi, state[len(m) :] @ M_phi
        largest = np.maximum(largest, np.abs(2 * building.zeta * omega * q_dot + omega**2 * q))
        state = onward @ state
    return largest / np.abs(m @ phi)


def landing(building: Frame, run: fr.Run) -> np.ndarray:
    """The acceleration of each mode, m/s2, that the hardest landing of a run gives it."""
    omega, phi = building.omega, building.phi
    velocity = max((abs(of.before["theta_dot"]) for of in run.transitions if of.kind == "landing"), default=0.0)
    return omega * np.abs((building.m * building.h) @ phi / (building.m @ phi)) * velocity


def scene(name: str, path: str) -> tuple[list[dict[str, object]], list[dict[str, object]], dict[str, dict[str, np.ndarray]]]:
    """Errors of fewer modes, parts of the modes, and profiles of a building under a record."""
    building, record = BUILDINGS[name], fr.Record.read(path)
    (exact, rocks), (fixed, stands) = motion(building, record), motion(building, record, "fixed_base")
    count, profiles = len(building.m), {"all modes": peaks(exact), "fixed base": peaks(fixed)}
    for kept in range(1, count):
        profiles[kept] = peaks(fr.simulate(structure(building).replace(keep=kept), record, duration=min(record.duration, DURATION)))
    place = {"building": name, "record": Path(path).stem}
    wrong = [{**place, "modes": kept, **errors(of, profiles["all modes"])} for kept, of in profiles.items()
             if kept not in ("all modes", "fixed base")]
    parts = pd.DataFrame({**place, "mode": np.arange(1, count + 1), "rocking": rocks, "fixed": stands, "reversal": reversal(building),
                          "landing": landing(building, exact), "theta": float(exact.peaks["theta"])})
    return wrong, parts.to_dict("records"), profiles


def values(figures: Path) -> dict:
    figures.mkdir(exist_ok=True)
    scenes = {(name, path): scene(name, path) for name in tqdm(BUILDINGS) for path in RECORDS}
    wrong = pd.DataFrame([row for rows, _, _ in scenes.values() for row in rows])
    parts = pd.DataFrame([row for _, rows, _ in scenes.values() for row in rows])
    wrong.to_csv(figures / "errors.csv", index=False, float_format="%.6g")
    parts.to_csv(figures / "parts.csv", index=False, float_format="%.6g")
    draw_errors(wrong, figures / "errors.svg")
    draw_floors({name: of for (name, path), (_, _, of) in scenes.items() if SHOWN in path}, figures / "floors.svg")
    draw_parts(parts, figures / "parts.svg")
    return dict(
        buildings=table(["structure", "f, Hz", "α_cg, rad", "largest θ, mrad"], [building(name, parts) for name in BUILDINGS]),
        needed=table(["modes for errors within 5 %", *QUESTIONS.values()], [needed(name, wrong) for name in BUILDINGS]),
        parts=table(["structure", "mode", "f, Hz", "share of the mass", "fixed base, g", "rocking, g", "rocking over fixed base",
                     "reversal, g", "landing, g"], [row for name in BUILDINGS for row in isolation(name, parts)]),
        **rule(parts))


def building(name: str, parts: pd.DataFrame) -> list[object]:
    of, theta = BUILDINGS[name], 1e3 * parts[parts["building"] == name].groupby("record")["theta"].first()
    frequencies = ", ".join(f"{f:.3g}" for f in of.omega[:4] / (2 * np.pi))
    return [name, frequencies + (", …" if len(of.m) > 4 else ""), f"{structure(of).derived['alpha_cg']:.3f}", f"{theta.min():.2g} to {theta.max():.2g}"]


def needed(name: str, wrong: pd.DataFrame) -> list[object]:
    """The fewest modes from which on the error stays within the limit, under the middle and under the worst of the records."""
    of = wrong[wrong["building"] == name]
    count = len(BUILDINGS[name].m)

    def fewest(errors: pd.Series) -> int:
        return int(max(errors[errors > LIMIT].index, default=0)) + 1

    groups = of.groupby("modes")[list(QUESTIONS)]
    both = [[fewest(errors[question]) for errors in (groups.median(), groups.max())] for question in QUESTIONS]
    return [f"{name}: of {count}", *(f"{middle}" if middle == worst else f"{middle}, {worst}" for middle, worst in both)]


def isolation(name: str, parts: pd.DataFrame) -> list[list[object]]:
    of_name = BUILDINGS[name]
    omega, share = of_name.omega, (of_name.m @ of_name.phi) ** 2 / of_name.m.sum()
    rows = []
    for mode, of in parts[parts["building"] == name].groupby("mode"):
        if mode <= 4:
            ratio = of["rocking"] / of["fixed"]
            numbers = (f"{of[column].median() / G:.2g}" for column in ("fixed", "rocking"))
            rows.append([name if mode == 1 else "", mode, f"{omega[mode - 1] / (2 * np.pi):.3g}", f"{100 * share[mode - 1]:.2g} %", *numbers,
                         f"{ratio.median():.2g} ({ratio.min():.2g} to {ratio.max():.2g})", f"{of['reversal'].iloc[0] / G:.2g}", f"{of['landing'].median() / G:.2g}"])
    return rows


def rule(parts: pd.DataFrame) -> dict[str, float]:
    """The condition beside the higher modes and all records."""
    parts = parts[parts["mode"] > 1]
    estimate, ratio = parts[["reversal", "landing"]].max(axis=1), parts["rocking"] / parts["fixed"]
    small = estimate < parts["fixed"]
    given = (parts["rocking"] / estimate)[~small & (ratio > 1.05)]
    return dict(higher=len(parts), meet=small.sum(), raised_most=100 * (ratio[small].max() - 1), others=(~small).sum(), raised=len(given),
                low=given.quantile(0.1), high=given.quantile(0.9), lowered_most=100 * (1 - ratio.min()))


def draw_errors(wrong: pd.DataFrame, path: Path) -> None:
    figure, axes = subplots(1, len(BUILDINGS), 3.6, sharey=True)
    for axis, name in zip(axes, BUILDINGS):
        medians = wrong[wrong["building"] == name].groupby("modes")[list(QUESTIONS)].median()
        for color, marker, (question, title) in zip(COLOURS, "os^D", QUESTIONS.items()):
            axis.plot(medians.index, 100 * medians[question], f"{marker}-", color=color, markersize=3.5, label=title)
        axis.set(title=name, xlabel=f"modes kept of {len(BUILDINGS[name].m)}", yscale="log", ylim=(1e-3, 200))
        axis.axhline(100 * LIMIT, color="0.7", linewidth=2, zorder=0)
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes[0].set_ylabel("error of the peak, %")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    save(figure, path, "Errors of the peaks over the number of modes kept", "Median error of the worst floor, three structures.")


def draw_floors(profiles: dict[str, dict[str, dict[str, np.ndarray]]], path: Path) -> None:
    figure, axes = subplots(1, len(profiles), 4.2)
    styles = {"all modes": ("black", "-"), "fixed base": ("0.6", "-"), 1: (COLOURS[0], "o-"), 2: (COLOURS[1], "s-"), 3: (COLOURS[2], "^-")}
    for axis, (name, of) in zip(axes, profiles.items()):
        for kept, (color, style) in styles.items():
            axis.plot(of[kept]["a_t"] / G, BUILDINGS[name].h, style, color=color, markersize=3.5,
                      label=f"{kept} mode{'s' * (kept > 1)} kept" if isinstance(kept, int) else kept)
        axis.set(title=name, xlabel="largest acceleration, g", xlim=(0, None))
    axes[0].set_ylabel("height, m")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    save(figure, path, "The largest acceleration over the height", "With all modes, with fewer, and on a fixed base.")


def draw_parts(parts: pd.DataFrame, path: Path) -> None:
    figure, axis = subplots(1, 1, 4.6)
    x, y = parts[["reversal", "landing"]].max(axis=1) / parts["fixed"], parts["rocking"] / parts["fixed"]
    for marker, name in zip("os^", BUILDINGS):
        axis.plot([], [], marker, color="0.4", markersize=4, label=name)
        for color, (title, low, high) in zip(COLOURS, MODES):
            chosen = (parts["building"] == name) & parts["mode"].between(low, high)
            axis.plot(x[chosen], y[chosen], marker, color=color, markersize=4, fillstyle="none")
    for color, (title, *_) in zip(COLOURS, MODES):
        axis.plot([], [], "s", color=color, label=title)
    ends = np.array([1e-2, 1e2])
    axis.plot(ends, ends, color="0.6", zorder=0)
    axis.axhline(1, color="0.6", zorder=0)
    axis.set(xscale="log", yscale="log", xlabel="larger of reversal and landing, over the fixed base",
             ylabel="contribution of the mode, rocking over fixed base")
    figure.legend(loc="outside right upper")
    save(figure, path, "Contribution of each mode while rocking", "Against the larger estimate, both over the fixed base.")
