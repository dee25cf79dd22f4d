"""The model against the literature and closed forms: `python -m literature` writes docs/evidence/literature.md.

    slender_block.py          the linearised rigid block under one pulse, solved piece by piece
    block.py                  the rigid limit as Housner's block, run by the Python module
    limit.py                  the limit of a vanishing slenderness: rate and extrapolation
    overturning.py            section 1: the amplitudes that overturn, with and without impact
    flexible.py               section 2: frequency while rocking, impact, overturning of flexible structures
    ensemble.py               section 3: many records on four structures at every level of detail
    page.md                   the page's words, with places for the tables and numbers
"""
