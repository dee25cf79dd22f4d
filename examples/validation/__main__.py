"""Writes the report: python -m validation [--exporter PATH] [--output FILE]."""

import argparse
import tempfile
from pathlib import Path

from tqdm import tqdm

from . import demand_bound, derived_quantities, free_vibration, isolation, modal_components, rocking_frequency
from . import static_pushover
from .project import Project
from .report import markdown, write_page

SECTIONS = [static_pushover, derived_quantities, free_vibration, modal_components, rocking_frequency, isolation]
WEIGHT = 4  # of one of these in the progress bar; one structure of the last section counts 1


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--exporter", type=Path, default=Path("target/release/rocking-fmu"), help="executable")
    parser.add_argument("--output", type=Path, default=Path("docs/evidence/paper.md"), help="page to write")
    arguments = parser.parse_args()
    figures = arguments.output.with_suffix("")

    sections = []
    total = WEIGHT * len(SECTIONS) + demand_bound.STRUCTURES
    with tempfile.TemporaryDirectory() as folder, tqdm(total=total, unit="") as progress:
        project = Project(arguments.exporter.resolve(), Path(folder))
        for module in SECTIONS:
            progress.set_description(module.__name__.rpartition(".")[2])
            sections.append(module.section(project, figures))
            progress.update(WEIGHT)
        progress.set_description("demand_bound")
        sections.append(demand_bound.section(project, figures, progress.update))
    write_page(arguments.output, markdown(sections, figures.name), "make report")
    print(f"{arguments.output}, figures in {figures}")


if __name__ == "__main__":
    main()
