"""The pages of evidence and the pictures of the documentation, made by one command.

    python -m evidence                   makes all of them anew
    python -m evidence paper modes       makes these
    python -m evidence --check paper     makes the page in another folder and compares it with the page in docs/

Each page has a folder: `page.md` holds the words, and `values` in `page.py` draws the pictures and returns the numbers that
`page.md` names.
"""

import os
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / "tests"))  # the independent integrations
os.environ.setdefault("OMP_NUM_THREADS", "1")  # hosts' solvers have the same last digits on any number of cores

PAGES = {  # the folder in docs/ of each
    "accuracy": "evidence", "failures": "explain", "validity": "explain", "paper": "evidence",
    "literature": "evidence", "overturning": "evidence", "restrained": "evidence", "modes": "evidence", "coupling": "evidence",
    "model_exchange": "evidence", "ground": "evidence", "slipping": "evidence",
}
