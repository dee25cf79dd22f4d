"""Writes docs/evidence/overturning.md and its pictures: PYTHONPATH=examples python -m overturning."""

import argparse
import csv
import json
import random
import resource
import subprocess
from operator import itemgetter
from pathlib import Path
from sysconfig import get_path
from tempfile import TemporaryDirectory

import flexible_rocking as fr
from tqdm import tqdm
from validation.report import table, write_page
from validation.specimens import MCMANUS

FOLDER = Path(__file__).parent
SCENES = ["rigid", "specimens", "stiffness", "islands"]
CLASSES = ["no uplift", "rocks and stands", "overturns without impact", "overturns after one impact",
           "overturns after more", "still rocking"]
RATIOS = [2, 4, 6, 8]  # ω/p_l at which the least amplitude that overturns is shown
AMPLIFIED = ["10", "1e3", "1e6", "1e10"]
CHECKED = 200  # points whose runs are asked what the model leaves out


class Scene:
    """The maps of one TOML file: what is counted, every point, and what they cost."""

    def __init__(self, name: str, picture: Path, folder: Path) -> None:
        rows = folder / f"{name}.csv"
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        command = [Path(get_path("scripts"), "rocking-fmu"), "sweep", FOLDER / f"{name}.toml", "-o", rows]
        done = subprocess.run([*command, "--picture", picture, "--quiet", "--format", "json"], check=True,
                              capture_output=True, text=True)
        self.seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        self.counts = json.loads(done.stdout)
        with open(rows, newline="", encoding="utf-8") as file:
            of = itemgetter("structures", "omega/p_l", "a_p/(g tan alpha_cg)")
            self.points = sorted(csv.DictReader(file), key=of)  # rows stand in the order in which runs ended

    def structures(self) -> list[str]:
        """Their names."""
        return list(dict.fromkeys(row["structure"] for row in self.counts))

    def part(self, structure: str, of_class: str) -> str:
        """The part of a structure's grid that is of a class, in %."""
        found = [row for row in self.counts if (row["structure"], row["class"]) == (structure, of_class)]
        return f"{100 * found[0]['part']:.1f}" if found else "–"

    def least(self, structure: str, ratio: float) -> str:
        """The least a_p/(g tan α_cg) that overturns a structure at the ω/p_l of the grid next to `ratio`."""
        points = [point for point in self.points if point["structures"] == structure]
        ratios = {float(point["omega/p_l"]) for point in points if point["refinement"] == "0"}
        column = min(ratios, key=lambda known: abs(known - ratio))
        overturned = [float(point["a_p/(g tan alpha_cg)"]) for point in points
                      if float(point["omega/p_l"]) == column and point["fate"] == "overturns"]
        return f"{min(overturned):.2f}" if overturned else "–"


def beyond(point: dict[str, str]) -> dict[str, fr.Worst]:
    """What the model leaves out at a point of McManus's map: by the names of assumptions."""
    pulse = fr.pulse(point["shape"], amplitude=float(point["a_p/(g tan alpha_cg)"]), frequency=float(point["omega/p_l"]),
                     structure=MCMANUS)
    return fr.simulate(MCMANUS, pulse).validity


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("docs/evidence/overturning.md"), help="page to write")
    arguments = parser.parse_args()
    figures = arguments.output.with_suffix("")
    figures.mkdir(exist_ok=True)

    with TemporaryDirectory() as folder:
        scenes = {name: Scene(name, figures.resolve() / f"{name}.png", Path(folder)) for name in tqdm(SCENES)}
    rocks = [point for point in scenes["specimens"].points
             if point["structures"] == "McManus" and point["fate"] in ("stands", "overturns")]
    found = [(point, beyond(point)) for point in random.Random(1).sample(rocks, CHECKED)]
    one_sine = [(scene, structure) for name in SCENES[:3] for scene in [scenes[name]] for structure in scene.structures()]
    islands = scenes["islands"]
    conditions = [float(point["condition"]) for point in islands.points]
    kinds = {"stands": lambda point: point["fate"] == "stands",
             "overturns without impact": lambda point: point["fate"] == "overturns" and point["impacts"] == "0",
             "overturns after impacts": lambda point: point["fate"] == "overturns" and point["impacts"] != "0"}
    of_kinds = {name: [rows for point, rows in found if is_one(point)] for name, is_one in kinds.items()}
    page = (FOLDER / "page.md").read_text(encoding="utf-8").format(
        classes=table(["% of the points", *(structure for _, structure in one_sine)],
                         [[of_class, *(scene.part(structure, of_class) for scene, structure in one_sine)]
                          for of_class in CLASSES]),
        least=table(["ω/p_l", *(structure for _, structure in one_sine)],
                       [[str(ratio), *(scene.least(structure, ratio) for scene, structure in one_sine)]
                        for ratio in RATIOS]),
        amplified=table(["amplified more than", "points"],
                           [[f"{limit} times", f"{100 * sum(c > float(limit) for c in conditions) / len(conditions):.2f} %"]
                            for limit in AMPLIFIED]),
        checked=CHECKED,
        beyond=table(["the structure", "points", "R_v below 0 at some instant", "friction above 0.5 needed"],
                        [[name, str(len(of)), *(str(sum(rows[which].first_beyond is not None for rows in of))
                                               for which in ("R_v_min", "mu_required"))] for name, of in of_kinds.items()]),
        largest=f"{max(c for c in conditions if c < float('inf')):.1e}",
        changes=sum(c == float("inf") for c in conditions),
        islands=len(conditions),
        costs=table(["maps", "points", "processor time", "points per processor second"],
                       [[f"[{name}.toml](../../examples/overturning/{name}.toml)", f"{len(scene.points):,}",
                         f"{scene.seconds:.1f} s", f"{len(scene.points) / scene.seconds:.0f}"]
                        for name, scene in scenes.items()]),
    )
    write_page(arguments.output, page, "make overturning")
    print(f"{arguments.output}, pictures in {figures}")


if __name__ == "__main__":
    main()
