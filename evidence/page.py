"""Pages: what they are made of, how they are written and compared."""

import difflib
import re
import tomllib
from datetime import date
from importlib import import_module
from pathlib import Path

import numpy as np

from . import PAGES, ROOT

NUMBER = r"\d[\d,]*\.?\d*(?:e[+−-]?\d+)?"


def write(name: str, docs: Path) -> Path:
    """Computes the page `name` and writes it and its pictures into the folder `docs`."""
    page = docs / PAGES[name] / f"{name}.md"
    figures = page.with_suffix("")
    figures.parent.mkdir(parents=True, exist_ok=True)
    values = import_module(f"evidence.{name}.page").values(figures)
    text = (ROOT / "evidence" / name / "page.md").read_text(encoding="utf-8").format(**values)
    manifest = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    version = manifest["workspace"]["package"]["version"]
    processor = re.search("model name.*: (.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))[1]
    made = f"*Made by `python -m evidence {name}`, {date.today()}, version {version}, on one machine with {processor}.*"
    page.write_text(f"{text.rstrip()}\n\n{made}\n", encoding="utf-8")
    return page


def differs(written: Path, page: Path) -> bool:
    """Whether words differ, or numbers by more than one per cent: other C libraries have other last digits."""
    (words, numbers), (as_told, told) = split(written), split(page)
    if words == as_told and np.allclose(numbers, told, rtol=0.01, atol=0):
        return False
    lines = [path.read_text(encoding="utf-8").splitlines() for path in (page, written)]
    print("\n".join(difflib.unified_diff(*lines, "docs", "made anew", lineterm="", n=0)))
    return True


def split(page: Path) -> tuple[str, list[float]]:
    """Words and numbers, without the line that says when they were made."""
    text = re.sub(r"^\*Made by .*", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    numbers = [float(number.replace(",", "").replace("−", "-")) for number in re.findall(NUMBER, text)]
    return re.sub(NUMBER, "#", text), numbers


def table(headings: list, lines: list[list], texts: tuple[int, ...] = (0,)) -> str:
    """A Markdown table; the columns `texts` are words, the others numbers."""
    rule = ["---" if column in texts else "---:" for column in range(len(headings))]
    return "\n".join("| " + " | ".join(map(str, cells)) + " |" for cells in [headings, rule, *lines])


def spread(values, form: str) -> str:
    """The least and the largest of the values that are finite."""
    finite = [value for value in values if np.isfinite(value)]
    return f"{min(finite):{form}} to {max(finite):{form}}"
