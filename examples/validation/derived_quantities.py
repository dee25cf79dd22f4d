"""Section 2: what Tables 1 and 2 derive from the specimens' parameters."""

from pathlib import Path

from .project import Project
from .report import Row, Section

PRESETS = {"evison": "Evison, Table 1", "mcmanus": "McManus, Table 2"}
PRINTED = {
    "evison": {"J_P": "152.5", "p_l": "2.92", "alpha_cg": "0.35", "chi": "0.92", "f_u": "39", "u_cr": None},
    "mcmanus": {"J_P": "467", "p_l": "2.24", "alpha_cg": "0.23", "chi": "0.94", "f_u": None, "u_cr": None},
}
SYMBOLS = {
    "J_P": ("J_P = J0 + m (H² + B²) + m0 B² (after Eq 8)", 1, ".2f", "kg·m²"),
    "p_l": ("p_l = √(m g H/J_P) (before Eq 11)", 1, ".4f", "rad/s"),
    "alpha_cg": ("α_cg = atan(γ B/H) (before Eq 11)", 1, ".4f", "rad"),
    "chi": ("χ = H p_l²/g (after Eq 13)", 1, ".4f", ""),
    "f_u": ("f_u = f_fc/√(1−χ) (before Eq 18)", 1, ".2f", "Hz"),
    "u_cr": ("u_cr = g tan α_cg/ω_fc² (after Eq 4)", 1e3, ".4f", "mm"),
}


def compute(project: Project) -> dict[str, dict[str, float]]:
    """The derived quantities of both specimens: the FMU's calculated parameters, J_P of the library."""
    return {preset: {"J_P": project.values("describe", "--preset", preset)["J_P"]} | project.calculated(preset)
            for preset in PRESETS}


def rows(derived: dict[str, dict[str, float]], H: float, g: float) -> list[Row]:
    """The tables' derived quantities, and the frequency that the text derives; `H` and `g` as in Table 1."""
    table_chi = H * float(PRINTED["evison"]["p_l"]) ** 2 / g
    remarks = {
        ("evison", "chi"): f"the table's own p_l and H give {H:g}·2.92²/9.81 = {table_chi:.3f}: 0.91 to two digits",
        ("evison", "f_u"): "follows from the printed χ: 11/√(1−0.92) = 38.9; measured 35 (section 4)",
    }
    result = []
    for preset, name in PRESETS.items():
        for symbol, (formula, factor, form, unit) in SYMBOLS.items():
            result.append(Row(f"{name}: {formula}", PRINTED[preset][symbol], factor * derived[preset][symbol], form,
                              unit, remarks.get((preset, symbol), "")))
    return result


def section(project: Project, _folder: Path) -> Section:
    """The section, which has no figure."""
    derived = compute(project)
    parameters = {preset: project.parameters(preset) for preset in PRESETS}
    evison = parameters["evison"]
    exact = derived["evison"]["chi"]
    return Section(
        title="Derived quantities (Tables 1 and 2)",
        introduction="""The tables' parameters go in as they are printed (B, H, m, m0, J0, f_fc, ζ_fc, r); what the
tables derive from them is compared. J_P is `rocking-fmu describe`'s, all others are calculated parameters of the
FMU.""",
        rows=rows(derived, evison["H"], evison["g"]),
        findings=[f"""Everything follows from the parameters but Evison's χ, printed 0.92 where the same table's
p_l, H and g give {exact:.2f}. It matters more than it looks: 1−χ is {1 - exact:.3f} instead of 0.08, so that the
vibration frequency while rocking is {derived['evison']['f_u']:.1f} Hz instead of the 39 Hz of the text, and nearer
to the measured 35 Hz."""],
    )
