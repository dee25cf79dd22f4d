"""The commands of evidence write the pages that are in docs/."""

import subprocess
import sys

import evidence
import pytest
from conftest import ROOT
from host import need_opensees


@pytest.mark.parametrize("page", evidence.PAGES)
def test_a_page_of_evidence_is_what_its_command_writes(page):
    """Accuracy is made from the times that were measured: its tables are in docs/."""
    if page in ("ground", "slipping"):
        need_opensees()
    subprocess.run([sys.executable, "-m", "evidence", "--check", page], cwd=ROOT, check=True)


def test_readme_has_the_findings_of_their_script():
    found = subprocess.run([sys.executable, "-m", "evidence.findings"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    assert found and found in (ROOT / "README.md").read_text(encoding="utf-8")
