"""Numbers of the paper beside ours."""

from dataclasses import dataclass

from ..page import table


@dataclass(frozen=True)
class Row:
    quantity: str
    paper: str | None  # as printed; None where the paper gives no number
    computed: float
    form: str = ".3f"  # how to print ours
    unit: str = ""
    remark: str = ""
    is_printed: bool = True  # false for what a formula gives here, or what was put in

    @property
    def agrees(self) -> bool:
        """Whether our number, rounded to the digits of the paper, equals the number of the paper; true if the paper prints none."""
        return self.paper is None or round(self.computed, len(self.paper.partition(".")[2])) == float(self.paper)

    def cells(self) -> list[str]:
        unit = f" {self.unit}" if self.unit else ""
        paper, difference = f"{self.paper}{unit}", "agrees"
        if self.paper is None:
            paper, difference = "–", "–"
        elif not self.agrees:
            by = self.computed - float(self.paper)
            difference = f"{by:+.2g}{unit} ({100 * by / float(self.paper):+.1f} %)"
        numbers = [paper, f"{self.computed:{self.form}}{unit}", difference]
        return [self.quantity, *(number.replace("-", "−") for number in numbers), self.remark]


def comparison(rows: list[Row]) -> str:
    source = "paper" if any(row.is_printed for row in rows) else "formula"
    return table(["quantity", source, "computed", "difference", "remark"], [row.cells() for row in rows], texts=(0, 4))


def summary(sections: list[list[Row]]) -> dict:
    """How many numbers agree, and the table of those that do not."""
    compared = [row for rows in sections for row in rows if row.paper is not None]
    printed, others = ([row for row in compared if row.is_printed == which] for which in (True, False))
    lines = [[number, *row.cells()] for number, rows in enumerate(sections, 1) for row in rows if not row.agrees]
    return dict(printed=len(printed), printed_agree=sum(row.agrees for row in printed), others=len(others),
                others_agree=sum(row.agrees for row in others),
                disagree=table(["section", "quantity", "paper or its formula", "computed", "difference", "why"], lines,
                               texts=(1, 5)))
