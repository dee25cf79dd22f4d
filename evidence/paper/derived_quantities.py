"""Section 2: what Tables 1 and 2 derive from the specimens' parameters."""

from pathlib import Path

from .rows import Row
from .specimens import EVISON, MCMANUS

SPECIMENS = {"Evison, Table 1": EVISON, "McManus, Table 2": MCMANUS}
PRINTED = {
    EVISON: {"J_P": "152.5", "p_l": "2.92", "alpha_cg": "0.35", "chi": "0.92", "f_u": "39"},
    MCMANUS: {"J_P": "467", "p_l": "2.24", "alpha_cg": "0.23", "chi": "0.94"},
}
SYMBOLS = {
    "J_P": ("J_P = J0 + m (H² + B²) + m0 B² (after Eq 8)", ".2f", "kg·m²"),
    "p_l": ("p_l = √(m g H/J_P) (before Eq 11)", ".4f", "rad/s"),
    "alpha_cg": ("α_cg = atan(γ B/H) (before Eq 11)", ".4f", "rad"),
    "chi": ("χ = H p_l²/g (after Eq 13)", ".4f", ""),
    "f_u": ("f_u = f_fc/√(1−χ) (before Eq 18)", ".2f", "Hz"),
}


def section(_figures: Path) -> tuple[list[Row], dict]:
    """The tables' derived quantities, and the frequency that the text derives."""
    table_chi = EVISON.H * float(PRINTED[EVISON]["p_l"]) ** 2 / EVISON.g
    remarks = {
        (EVISON, "chi"): f"the table's own p_l and H give {EVISON.H:g}·2.92²/9.81 = {table_chi:.3f}: 0.91 to two digits",
        (EVISON, "f_u"): "follows from the printed χ: 11/√(1−0.92) = 38.9; measured 35 (section 4)",
    }
    rows = []
    for name, structure in SPECIMENS.items():
        for symbol, paper in PRINTED[structure].items():
            formula, form, unit = SYMBOLS[symbol]
            rows.append(Row(f"{name}: {formula}", paper, structure.derived[symbol], form, unit, remarks.get((structure, symbol), "")))
    return rows, {"evison": EVISON, "without_chi": 1 - EVISON.chi}
