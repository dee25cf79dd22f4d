"""Writes the page: python -m literature [--output FILE]. It takes a few minutes."""

import argparse
from pathlib import Path

import flexible_rocking as fr
from first_run import G
from tqdm import tqdm
from validation.records import horizontal_records
from validation.report import filled, write_page

from . import block, ensemble, flexible, limit, overturning, point_reyes

PAGE = Path(__file__).parent / "page.md"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("docs/evidence/literature.md"), help="page to write")
    arguments = parser.parse_args()
    figures = arguments.output.with_suffix("")

    total = (len(overturning.CASES) + len(point_reyes.RESTITUTIONS) + len(flexible.FREQUENCIES)
             + len(ensemble.VARIANTS) * len(ensemble.TIME_SCALES))
    with tqdm(total=total, unit="") as progress:
        progress.set_description("overturning")
        cases = overturning.compute(progress.update)
        overturning.draw(cases, figures / "overturning.svg")
        overturning.save(cases, figures / "overturning.csv")
        trains, train_between = point_reyes.rows(progress.update)
        progress.set_description("flexible")
        flexibility = flexible.flexibility(progress.update)
        progress.set_description("ensemble")
        runs = ensemble.compute(progress.update)
        ensemble.draw(runs, figures / "ensemble.svg")
        found = ensemble.comparisons(runs)
        ensemble.save(runs, found, figures / "ensemble.csv")
        rates = [case.limit.rate for case in cases]
        peaks = [fr.Record.read(path).pga / G for path in horizontal_records().values()]
        page = PAGE.read_text(encoding="utf-8").format(
            restitution=overturning.R,
            impacts_agree=sum(case.impacts == case.boundary.impacts for case in cases),
            most=f"{overturning.MOST:g}",
            boundary_count=len(cases),
            boundary_error=f"{max(case.limit.error for case in cases):.0e}",
            boundary_rates=f"{min(rates):.3f} to {max(rates):.3f}",
            shape_difference=f"{overturning.any_shape(cases):.0e}",
            samples=block.SAMPLES,
            stocky=overturning.STOCKY,
            upper_changes=overturning.changes(cases, upper=True),
            lower_changes=overturning.changes(cases, upper=False),
            half_sines=overturning.half_sines(),
            trains=trains,
            train_between=train_between,
            tangents=", ".join(f"{tangent:g}" for tangent in limit.TANGENTS),
            shear_pgas=" and ".join(f"{pga:g}" for pga in flexible.PGAS),
            frequencies=flexible.frequencies(),
            impacts=flexible.impacts(),
            flexibility=flexibility,
            base_shear=flexible.base_shear(),
            record_peaks=f"{min(peaks):.2f} to {max(peaks):.2f} g",
            time_scales=", ".join(f"{scale:g}" for scale in ensemble.TIME_SCALES),
            pgas=f"{len(ensemble.PGAS)} peak accelerations from {ensemble.PGAS[0]:g} to {ensemble.PGAS[-1]:g} g",
            run_count=len(runs) // len(ensemble.STRUCTURES),
            draws=ensemble.DRAWS,
            parted=f"{100 * ensemble.PARTED:.0f} %",
            **ensemble.summary(runs, found),
        )
    write_page(arguments.output, "\n\n".join(map(filled, page.split("\n\n"))), "make report")
    print(f"{arguments.output}, figures in {figures}")


if __name__ == "__main__":
    main()
