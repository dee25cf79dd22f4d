"""Writes the report: python -m validation [--output FILE]."""

import argparse
from pathlib import Path

from tqdm import tqdm

from . import demand_bound, derived_quantities, free_vibration, isolation, modal_components, rocking_frequency
from . import static_pushover
from .report import markdown, write_page

SECTIONS = [static_pushover, derived_quantities, free_vibration, modal_components, rocking_frequency, isolation,
            demand_bound]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("docs/evidence/paper.md"), help="page to write")
    arguments = parser.parse_args()
    figures = arguments.output.with_suffix("")

    sections = [module.section(figures) for module in tqdm(SECTIONS)]
    write_page(arguments.output, markdown(sections, figures.name), "make report")
    print(f"{arguments.output}, figures in {figures}")


if __name__ == "__main__":
    main()
