"""Parts of the report: rows "paper / computed / difference / remark", sections, and their Markdown."""

import re
import textwrap
import tomllib
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path


@dataclass(frozen=True)
class Row:
    """One number of the paper beside ours."""

    quantity: str
    paper: str | None  # as printed; None where the paper gives no number
    computed: float
    form: str = ".3f"  # how to print ours
    unit: str = ""
    remark: str = ""
    is_printed: bool = True  # false for what a formula gives here, or what was put in

    @property
    def difference(self) -> float | None:
        """Ours less the paper's."""
        return None if self.paper is None else self.computed - float(self.paper)

    @property
    def agrees(self) -> bool:
        """Whether our number, rounded to the digits of the paper, equals the number of the paper; true if the paper prints none."""
        if self.paper is None:
            return True
        decimals = len(self.paper.partition(".")[2])
        return round(self.computed, decimals) == float(self.paper)

    def cells(self) -> list[str]:
        """Its cells in the table."""
        unit = f" {self.unit}" if self.unit else ""
        if self.paper is None:
            paper, difference = "–", "–"
        elif self.agrees:
            paper, difference = f"{self.paper}{unit}", "agrees"
        elif self.unit == "%":
            paper, difference = f"{self.paper}{unit}", f"{self.difference:+.1f}{unit}"
        else:
            part = 100 * self.difference / float(self.paper)
            paper, difference = f"{self.paper}{unit}", f"{self.difference:+.2g}{unit} ({part:+.1f} %)"
        numbers = [paper, f"{self.computed:{self.form}}{unit}", difference]
        return [self.quantity, *(number.replace("-", "−") for number in numbers), self.remark]


@dataclass(frozen=True)
class Section:
    """One claim: what it is, the table, the figure, and what to make of them."""

    title: str
    introduction: str
    rows: list[Row]
    figure: str = ""  # file name
    caption: str = ""
    findings: list[str] = field(default_factory=list)  # paragraphs and tables after the figure
    source: str = "paper"  # what the second column holds


def table(headings: list, lines: list[list], texts: tuple[int, ...] = (0,)) -> str:
    """A Markdown table; the columns `texts` are words, the others numbers."""
    rule = ["---" if column in texts else "---:" for column in range(len(headings))]
    return "\n".join("| " + " | ".join(map(str, cells)) + " |" for cells in [headings, rule, *lines])


def comparison(section: Section) -> str:
    """The table of a section's rows."""
    headings = ["quantity", section.source, "computed", "difference", "remark"]
    return table(headings, [row.cells() for row in section.rows], texts=(0, 4))


def summary(sections: list[Section]) -> str:
    """How many numbers agree, and the table of those that do not."""
    compared = [(row, section.source == "paper" and row.is_printed) for section in sections for row in section.rows
                if row.paper is not None]
    printed, others = ([row for row, is_printed in compared if is_printed == which] for which in (True, False))
    lines = [[str(number), *row.cells()] for number, section in enumerate(sections, 1) for row in section.rows
             if not row.agrees]
    headings = ["section", "quantity", "paper or its formula", "computed", "difference", "why"]
    return (f"{sum(row.agrees for row in printed)} of the {len(printed)} numbers that the paper prints agree to every "
            f"digit. The tables have {len(others)} more numbers that the paper does not print for its own scenes. They "
            f"come from its formulas, belong to the substitute for a missing record, or are inputs. "
            f"{sum(row.agrees for row in others)} of these agree. The numbers that do not agree are:\n\n"
            f"{table(headings, lines, texts=(1, 5))}")


def markdown(sections: list[Section], figures: str) -> str:
    """The report; figures are found in the folder `figures` beside it."""
    parts = [INTRODUCTION, "## What agrees, and what does not", summary(sections)]
    for number, section in enumerate(sections, 1):
        figure = [f"![{section.title}]({figures}/{section.figure})", f"*{section.caption}*"] if section.figure else []
        parts += [f"## {number}. {section.title}", section.introduction, comparison(section), *figure, *section.findings]
    blocks = "\n\n".join(parts).split("\n\n")
    return "\n\n".join(map(filled, blocks)) + "\n"


def write_page(path: Path, text: str, command: str) -> None:
    """Writes a page with what it was made by, when, and on which processor."""
    manifest = (Path(__file__).parents[2] / "Cargo.toml").read_text(encoding="utf-8")
    version = tomllib.loads(manifest)["workspace"]["package"]["version"]
    processor = re.search("model name.*: (.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))[1]
    made = f"*Made by `{command}`, {date.today()}, version {version}, on one machine with {processor}.*"
    path.write_text(f"{text.rstrip()}\n\n{made}\n", encoding="utf-8")


def filled(block: str) -> str:
    """A paragraph or a list with lines of even length; a table, a heading, a figure or a formula as it is."""
    if block.startswith(("|", "#", "!", "    ")):
        return block
    items = [" ".join(item.split()) for item in re.split(r"\n(?=- )", block)]
    return "\n".join(textwrap.fill(item, 120, subsequent_indent="  " * item.startswith("- "), break_long_words=False)
                     for item in items)


INTRODUCTION = """# Validation against the paper

Which of the paper's numbers does the model reproduce? The tables compare every number for which the text gives the data with the
number that the [Python module](../howto/python.md) computes at a tolerance of 1e-10. The module has the engine of the FMU.
Equation, figure and table numbers are the paper's. The paper prints its measured histories only as pictures; we compare the values
that its text states. [Another page](literature.md) compares with closed forms and other publications.
[Architecture](../dev/architecture.md#where-the-equations-come-from) describes the paper, whose title and authors we do not know.

"computed" is our number. "agrees" means that our number, rounded to the digits of the paper, equals the printed number."""
