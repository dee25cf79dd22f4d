"""The pictures of README and of pages that are written by hand: python -m evidence.pictures [NAME ...]

    motion      a bridge pier under the record of Pacoima Dam
    levels      which level of detail is enough, over frequency and intensity
    tornado     what a wrong number changes, by the script of docs/howto/choose_numbers.md
    questions   rotation and probabilities over PGV, by the script of docs/howto/fragility_study.md
    profile     peaks over the height of a building, by the script of docs/howto/frames.md
    ensembles   many runs at once, of the numbers that `make measure WHAT=ensembles` has left in docs/evidence
    steps       what a step of the FMU costs, of the numbers that `make measure WHAT=steps` has left in docs/evidence
    explore     the page of `make explore` on the record of Pacoima Dam; only if it is named
"""

import re
import shutil
import sys
from pathlib import Path

import flexible_rocking as fr
import numpy as np
import pandas as pd
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.colors import ListedColormap
from matplotlib.patches import Circle
from tqdm import tqdm

from . import ROOT
from .figures import COLOURS, FIXED, QUIET, ROCKING, plt, save, subplots
from .paper.specimens import MCMANUS
from .scenes import RECORD, SCALE, TIME_SCALE, G

INK, LIGHT = "#263238", "0.82"
PIER = fr.Structure(m=1.2e6, m0=0.4e6, H=22, B=3.5, J0=0, f_fc=0.8, zeta_fc=0.03, r=0.95)
DRAWN = 12  # the motion is drawn this many times as large
BEGINS, ENDS, FRAMES_PER_SECOND, ROWS_PER_FRAME = 2.0, 12.5, 12.5, 8  # s; u is below 5 mm at both, so the film loops


def draw(axis, theta: float, u: float) -> None:
    """The pier, turned with its base about the edge that is down."""
    half, along = PIER.B, np.linspace(0.3 * PIER.B / PIER.H, 1, 40)
    base = half * np.array([[-1, 0], [1, 0], [1, 0.3], [-1, 0.3]])
    strut = np.column_stack([u * along**2 * (3 - along) / 2, PIER.H * along])  # a cantilever with a force at its end
    pivot = np.array([np.sign(theta) * half, 0.0])
    turn = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    base, strut = (pivot + (points - pivot) @ turn for points in (base, strut))
    axis.axhspan(-0.3 * half, 0, color=LIGHT, linewidth=0)
    axis.fill(*base.T, color=INK, linewidth=0)
    axis.plot(*strut.T, color=INK, linewidth=2.5)
    axis.add_patch(Circle(strut[-1], 0.45 * half, color=ROCKING, linewidth=0))
    axis.set(aspect="equal")
    axis.axis("off")


def motion(path: Path) -> None:
    """The pier's motion, enlarged, over the ground acceleration and the rotation."""
    time = np.arange(BEGINS, ENDS, 1 / (FRAMES_PER_SECOND * ROWS_PER_FRAME))
    response = fr.simulate(PIER, fr.Record.read(RECORD)).at(time)
    figure, (axis, ground, below) = plt.subplots(3, 1, figsize=(4.6, 5.6), height_ratios=[4, 1, 1], layout="constrained")
    limits = {"xlim": (-16, 16), "ylim": (-1.05, 25.5)}
    marks = []
    for trace, color, values, label in ((ground, QUIET, response["a_g"] / G, "ground (g)"),
                                        (below, ROCKING, np.degrees(response["theta"]), "rotation (°)")):
        trace.plot(time, values, color=color, linewidth=0.8)
        trace.axhline(0, color="0.5", linewidth=0.6)
        trace.set(xlim=(BEGINS, ENDS), ylabel=label)
        marks.append((trace.plot([], [], "o", color=color)[0], values))
    ground.tick_params(labelbottom=False)
    below.set(xlabel="time (s)")
    figure.align_ylabels()

    def frame(i: int) -> None:
        axis.clear()
        draw(axis, DRAWN * response["theta"][i], DRAWN * response["u"][i])
        axis.set(**limits)
        for mark, values in marks:
            mark.set_data([time[i]], [values[i]])

    path.parent.mkdir(parents=True, exist_ok=True)
    frames = range(0, len(time), ROWS_PER_FRAME)
    FuncAnimation(figure, frame, frames).save(path, PillowWriter(fps=FRAMES_PER_SECOND), dpi=80)
    plt.close(figure)


WAYS = {"this engine, one by one": ("0.4", "o"), "this engine, lanes": ("black", "s"), "heyoka, one by one": (COLOURS[5], "^"),
        "heyoka, batches of 4": (COLOURS[0], "D"), "heyoka, batches of 8": (COLOURS[1], "v"), "JAX": (COLOURS[4], "P")}


def ensembles(path: Path) -> None:
    """Many runs at once, of the numbers that `make measure WHAT=ensembles` has left."""
    rows = pd.read_csv(ROOT / "docs/evidence/ensembles.csv")
    figure, axis = subplots(1, 1, 4.4)
    for way, (color, mark) in WAYS.items():
        of = rows[(rows["way"] == way) & np.isfinite(rows["tolerance"])].sort_values("tolerance")
        axis.loglog(of["microseconds_per_run"], of["error_theta"], f"{mark}-", markersize=4, color=color, label=way)
    title = "64 runs of McManus's pier under El Centro at scales 0.5 to 1, one thread"
    axis.set(xlabel="computing time per run (µs)", ylabel="largest error of θ over its peak", ylim=(1e-10, 10), xlim=(300, 6e4), title=title)
    figure.legend(loc="outside lower center", ncols=3)
    save(figure, path, title, "Error of θ against time per run: this engine alone and in lanes, heyoka alone and in batches, JAX.")


def steps(path: Path) -> None:
    """What a communication step of 1 ms costs, of the numbers that `make measure WHAT=steps` has left."""
    rows = pd.read_csv(ROOT / "docs/evidence/steps.csv")
    figure, axes = subplots(1, 2, 3.6, sharey=True)
    for axis, (of, label) in zip(axes, {"microseconds": "time of a step (µs)", "engine steps": "steps of the engine in a step"}.items()):
        for color, (scene, costs) in zip(COLOURS, rows[rows["of"] == of].groupby("scene")):
            axis.step(costs["value"], costs["share"], where="pre", color=color, label=scene)
        axis.set(yscale="log", xlabel=label)
    axes[0].axvline(1000, color=FIXED, linestyle="--", label="1 ms, the duration of a step")
    axes[0].set(xscale="log", ylabel="share that takes as much or more")
    axes[1].set(xticks=range(1, 1 + int(rows[rows["of"] == "engine steps"]["value"].max())))
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=2, loc="outside lower center")
    save(figure, path, "What a step of the FMU costs", "Shares of 20,000 steps over their times in µs and over the steps of the engine in each.")


LEVELS = {"fixed_base": "#d9d9d9", "rigid": "#f0e442", "modal": "#56b4e9", "linear": "#009e73", "auto": "#d55e00"}
FREQUENCIES = np.geomspace(1, 50, 24)  # Hz
INTENSITIES = np.geomspace(0.3, 12, 24)  # PGA over g tan α_cg
ASKED = {"peaks of θ, u, a_t within 5 %": ["theta", "u", "a_t"],
         "histories within 5 %, too": None}


def levels(path: Path) -> None:
    """McManus's pier with other frequencies under Pacoima Dam, scaled: the level that `advise` names."""
    record = fr.Record.read(RECORD, time_scale=TIME_SCALE)
    uplifts = record.scaled(G * np.tan(MCMANUS.alpha_cg) / record.pga)

    def advised(frequency: float, intensity: float, asked: list[str] | None) -> int:
        advice = fr.advise(MCMANUS.replace(f_fc=frequency), uplifts.scaled(intensity), of=asked)
        return list(LEVELS).index(advice.detail)

    figure, axes = subplots(1, 2, 3.8, sharey=True)
    named = set()
    for axis, (title, asked) in zip(axes, ASKED.items()):
        found = [[advised(f, i, asked) for f in FREQUENCIES] for i in tqdm(INTENSITIES, desc=title)]
        axis.pcolormesh(FREQUENCIES, INTENSITIES, found, cmap=ListedColormap(list(LEVELS.values())), vmin=-0.5,
                        vmax=len(LEVELS) - 0.5, rasterized=True)
        named.update(np.ravel(found))
        full = np.mean(np.array(found) == list(LEVELS).index("auto"))
        axis.set(xscale="log", yscale="log", xlabel="$f_{fc}$ (Hz)",
                 title=f"{title}:\n{full:.0%} of the scenes need auto")
        axis.grid(False)
    axes[0].set_ylabel(r"PGA / (g tan $\alpha_{cg}$)")
    shown = [level for k, level in enumerate(LEVELS) if k in named]
    patches = [plt.Rectangle((0, 0), 1, 1, color=LEVELS[level]) for level in shown]
    figure.legend(patches, shown, ncols=len(shown), loc="outside lower center")
    save(figure, path, "Which level of detail is enough",
         "The cheapest level that is good enough, over f_fc and PGA over g tan α_cg.")


def drawn_by(page: str, title: str, description: str):
    """A function that writes the figure which the script of a page draws."""
    def draw(path: Path) -> None:
        blocks = re.findall(r"^```py\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
        drawn = {}
        exec(re.sub(r"^figure\.savefig.*", "", "".join(blocks), flags=re.MULTILINE), drawn)
        save(drawn["figure"], path, title, description)

    return draw


def explore(path: Path) -> None:
    """The page of `make explore`, where McManus's pier rocks beside a fixed base."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
        page = browser.new_page(viewport={"width": 1300, "height": 720}, reduced_motion="reduce")
        page.goto(f"{(ROOT / 'out/explore.html').as_uri()}#scale={SCALE}&time_scale={TIME_SCALE}&tab=compare")
        page.locator("body[data-ready]").wait_for()
        page.locator("#file").set_input_files(RECORD)
        page.locator("#levels .advised").wait_for()
        page.wait_for_timeout(1000)
        page.locator("#readings [data-name=theta] button").evaluate("button => button.click()")
        page.screenshot(path=path)


PICTURES = {
    "img/motion.gif": motion, "img/levels.svg": levels,
    "img/tornado.svg": drawn_by("docs/howto/choose_numbers.md", "Change of the peaks for each wrong number",
                                "Bars: medians of six components of ground motion. Strokes: single components."),
    "img/questions.svg": drawn_by("docs/howto/fragility_study.md", "Rotation and probabilities over the peak ground velocity",
                                  "Left: one line per record, without the runs that overturn. Right: fragility curves of two piers."),
    "img/profile.svg": drawn_by("docs/howto/frames.md", "Peaks over the height of a building of ten storeys",
                                "Solid: the building rocks. Dashed: its base is fixed."),
    "evidence/ensembles.svg": ensembles, "evidence/steps.svg": steps, "img/explore.png": explore}

if __name__ == "__main__":
    named = {Path(name).stem: name for name in PICTURES}
    if unknown := set(sys.argv[1:]) - set(named):
        sys.exit(f"no picture is called {', '.join(unknown)}; there are {', '.join(named)}")
    for name in sys.argv[1:] or set(named) - {"explore"}:
        PICTURES[named[name]](ROOT / "docs" / named[name])
