"""The model against closed forms of the literature."""

from pathlib import Path

from ..page import spread
from . import block, overturning


def values(figures: Path) -> dict:
    """Pulses that overturn a rigid block."""
    cases = overturning.compute()
    overturning.draw(cases, figures / "overturning.svg")
    return dict(
        restitution=overturning.R, impacts_agree=sum(case.impacts == case.boundary.impacts for case in cases),
        most=overturning.MOST, boundary_count=len(cases), boundary_error=max(case.error for case in cases),
        boundary_rates=spread([case.rate for case in cases], ".3f"), samples=block.SAMPLES,
        tangents=", ".join(f"{tangent:g}" for tangent in overturning.TANGENTS))
