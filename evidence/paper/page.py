"""The paper's claims, reproduced: a module for each section of the page."""

from pathlib import Path

from tqdm import tqdm

from . import derived_quantities, free_vibration, isolation, modal_components, rocking_frequency, static_pushover
from .rows import comparison, summary

SECTIONS = (static_pushover, derived_quantities, free_vibration, modal_components, rocking_frequency, isolation)


def values(figures: Path) -> dict:
    """Of each section the rows, and the numbers of its words."""
    found = [module.section(figures) for module in tqdm(SECTIONS)]
    numbers = {name: value for _, of in found for name, value in of.items()}
    tables = {module.__name__.rpartition(".")[2]: comparison(rows) for module, (rows, _) in zip(SECTIONS, found)}
    return numbers | tables | summary([rows for rows, _ in found])
