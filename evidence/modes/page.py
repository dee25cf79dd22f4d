"""How many modes: structures of many masses under real records."""

from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from frames import Frame, cantilever
from matplotlib.ticker import MaxNLocator
from scipy.linalg import expm
from tqdm import tqdm

from ..figures import COLOURS, FIXED, save, subplots
from ..page import table
from ..scenes import RECORDS as DATA
from ..scenes import G

RECORDS = sorted(map(str, DATA.glob("[!n]*/*hor*.AT2")))
SHOWN = "RSN77_SFERN_PUL164"  # whose floors are drawn
DURATION = 25.0  # of each run at most, s
LIMIT = 0.05
QUESTIONS = {"theta": "θ", "u": "u of each floor", "V": "V of each storey", "a_t": "a of each floor"}
OLD = "the old rule"
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


def columns(response: fr.Response, name: str, count: int) -> np.ndarray:
    """A column for each floor."""
    return np.column_stack([response[f"{name}[{i + 1}]"] for i in range(count)])


class Motion:
    """A run at instants: u and u_dot of the floors, theta, and the force of each mode on its unit mass."""

    def __init__(self, building: Frame, record: fr.Record, keep: int | None = None, detail: str = "auto"):
        self.run = fr.simulate(structure(building).replace(keep=keep), record, detail=detail, duration=min(record.duration, DURATION))
        response = self.run.at(np.arange(self.run.start, self.run.end, np.pi / 10 / building.omega[-1]))  # 20 in a period
        count = len(building.m)
        self.u, u_dot = (columns(response, name, count) for name in ("u", "u_dot"))
        omega, phi = building.omega, building.phi
        q, q_dot = (of @ (building.m[:, None] * phi) for of in (self.u, u_dot))
        self.theta, self.q, self.force = response["theta"], q, 2 * building.zeta * omega * q_dot + omega**2 * q


def peaks(run: fr.Run) -> dict[str, np.ndarray]:
    """Exact peaks, floor by floor."""
    count = sum(name.startswith("a_t[") for name in run.peaks)
    of_floors = {name: np.array([run.peaks[f"{name}[{i + 1}]"] for i in range(count)]) for name in ("u", "V", "a_t")}
    return {"theta": np.array([run.peaks["theta"]]), **of_floors}


def old_rule(building: Frame, rocking: Motion, fixed: Motion) -> dict[str, np.ndarray]:
    """Peaks if the first mode alone rocks and the others vibrate as on a fixed base."""
    phi = building.phi
    until = min(len(rocking.theta), len(fixed.theta))
    force = fixed.force[:until].copy()
    force[:, 0] = rocking.force[:until, 0]
    a = G * np.sin(rocking.theta[:until, None]) - force @ phi.T
    u = fixed.q[:until].copy()
    u[:, 0] = rocking.q[:until, 0]
    V = np.cumsum((a * building.m)[:, ::-1], axis=1)[:, ::-1]
    of_floors = {name: np.abs(of).max(axis=0) for name, of in (("u", u @ phi.T), ("V", V), ("a_t", a))}
    return {"theta": np.array([rocking.run.peaks["theta"]]), **of_floors}


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
    exact, fixed, one = Motion(building, record), Motion(building, record, detail="fixed_base"), Motion(building, record, 1)
    count, profiles = len(building.m), {"all modes": peaks(exact.run), "fixed base": peaks(fixed.run), OLD: old_rule(building, one, fixed)}
    for kept in range(1, count):
        profiles[f"{kept}"] = peaks(fr.simulate(structure(building).replace(keep=kept), record, duration=min(record.duration, DURATION)))
    place = {"building": name, "record": Path(path).stem}
    wrong = [{**place, "modes": kept, **errors(of, profiles["all modes"])} for kept, of in profiles.items()
             if kept not in ("all modes", "fixed base")]
    gamma = np.abs(building.m @ building.phi)
    rocks, stands = (np.abs(of.force).max(axis=0) / gamma for of in (exact, fixed))
    parts = pd.DataFrame({**place, "mode": np.arange(1, count + 1), "rocking": rocks, "fixed": stands, "reversal": reversal(building),
                          "landing": landing(building, exact.run), "theta": float(exact.run.peaks["theta"])})
    return wrong, parts.to_dict("records"), profiles


def values(figures: Path) -> dict:
    """Errors of fewer modes, and what rocking does to each mode."""
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
        old=table(["error in %, median and largest", *QUESTIONS.values()],
                  [row for name in BUILDINGS for row in old_errors(name, wrong)]),
        parts=table(["structure", "mode", "f, Hz", "share of the mass", "fixed base, g", "rocking, g", "rocking over fixed base",
                     "reversal, g", "landing, g"], [row for name in BUILDINGS for row in isolation(name, parts)]),
        **rule(parts))


def building(name: str, parts: pd.DataFrame) -> list[object]:
    of, theta = BUILDINGS[name], 1e3 * parts[parts["building"] == name].groupby("record")["theta"].first()
    frequencies = ", ".join(f"{f:.3g}" for f in of.omega[:4] / (2 * np.pi))
    return [name, frequencies + (", …" if len(of.m) > 4 else ""), f"{structure(of).derived['alpha_cg']:.3f}", f"{theta.min():.2g} to {theta.max():.2g}"]


def needed(name: str, wrong: pd.DataFrame) -> list[object]:
    """The fewest modes from which on the error stays within the limit, under the middle and under the worst of the records."""
    of = wrong[(wrong["building"] == name) & (wrong["modes"] != OLD)].astype({"modes": int})
    count = len(BUILDINGS[name].m)

    def fewest(errors: pd.Series) -> int:
        return int(max(errors[errors > LIMIT].index, default=0)) + 1

    groups = of.groupby("modes")[list(QUESTIONS)]
    both = [[fewest(errors[question]) for errors in (groups.median(), groups.max())] for question in QUESTIONS]
    return [f"{name}: of {count}", *(f"{middle}" if middle == worst else f"{middle}, {worst}" for middle, worst in both)]


def old_errors(name: str, wrong: pd.DataFrame) -> list[list[object]]:
    of = wrong[wrong["building"] == name].set_index("modes")[list(QUESTIONS)]
    return [[f"{name}, {title}", *(f"{100 * of.loc[[key], question].median():.3g}, {100 * of.loc[[key], question].max():.3g}" for question in QUESTIONS)]
            for key, title in ((OLD, "the old rule"), ("2", "2 modes"))]


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
        of = wrong[wrong["building"] == name]
        medians = of[of["modes"] != OLD].astype({"modes": int}).groupby("modes")[list(QUESTIONS)].median()
        old = of[of["modes"] == OLD][list(QUESTIONS)].median()
        for color, marker, (question, title) in zip(COLOURS, "os^D", QUESTIONS.items()):
            axis.plot(medians.index, 100 * medians[question], f"{marker}-", color=color, markersize=3.5, label=title)
            axis.axhline(100 * old[question], color=color, linestyle=":")
        axis.set(title=name, xlabel=f"modes kept of {len(BUILDINGS[name].m)}", yscale="log", ylim=(1e-3, 200))
        axis.axhline(100 * LIMIT, color="0.7", linewidth=2, zorder=0)
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes[0].set_ylabel("error of the peak, %")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    save(figure, path, "Errors of the peaks over the number of modes kept", "Median error of the worst floor, three structures.")


def draw_floors(profiles: dict[str, dict[str, dict[str, np.ndarray]]], path: Path) -> None:
    figure, axes = subplots(1, len(profiles), 4.2)
    styles = {"all modes": ("black", "-"), "fixed base": ("0.6", "-"), "1": (COLOURS[0], "o-"), "2": (COLOURS[1], "s-"),
              "3": (COLOURS[2], "^-"), OLD: (FIXED, ":")}
    for axis, (name, of) in zip(axes, profiles.items()):
        for kept, (color, style) in styles.items():
            axis.plot(of[kept]["a_t"] / G, BUILDINGS[name].h, style, color=color, markersize=3.5,
                      label=f"{kept} mode{'s' * (kept > '1')} kept" if kept.isdigit() else kept)
        axis.set(title=name, xlabel="largest acceleration, g", xlim=(0, None))
    axes[0].set_ylabel("height, m")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=6)
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
