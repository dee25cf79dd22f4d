"""README and the pages print what the program prints today."""

import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import pages  # noqa: E402


def is_long(page):
    return "<!-- heavy -->" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("page", [pytest.param(page, id=str(page.relative_to(ROOT)), marks=[pytest.mark.heavy] * is_long(page))
                                  for page in pages.PAGES if pages.BLOCK.search(page.read_text(encoding="utf-8"))])
def test_what_a_page_prints_is_what_its_commands_print(page, exporter, tmp_path):
    text = page.read_text(encoding="utf-8")
    assert pages.rerun(text, exporter, pages.prepare(tmp_path / "page", exporter)) == text, "run `make pages`"


def test_the_command_line_is_described_by_its_own_help(exporter):
    assert pages.command_line(exporter) == (ROOT / "docs/reference/command_line.md").read_text(encoding="utf-8"), "run `make pages`"


def test_the_variables_are_those_of_the_model_description(mcmanus):
    assert pages.variables(mcmanus.path) == (ROOT / "docs/reference/variables.md").read_text(encoding="utf-8"), "run `make pages`"


def test_readme_finds_what_the_page_of_findings_prints():
    found = re.search(r"```text\n(.*?)```", (ROOT / "docs/evidence/findings.md").read_text(encoding="utf-8"), re.DOTALL)[1]
    assert found and found in (ROOT / "README.md").read_text(encoding="utf-8")


def counted(page):
    """Its text without measured times and without the line that says when they were measured."""
    return re.sub(r" [\d.]+ s \| \d+ \|$|^\*Made by .*", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE)


@pytest.mark.heavy
@pytest.mark.parametrize("page, module, takes_exporter", [
    ("paper", "validation", True), ("literature", "literature", True), ("overturning", "overturning", True),
    ("coupling", "coupling", False), ("model_exchange", "model_exchange", False)])
def test_a_page_of_evidence_is_what_its_command_writes(page, module, takes_exporter, exporter, tmp_path):
    command = [sys.executable, "-m", module, "--output", tmp_path / f"{page}.md"]
    environment = os.environ | {"PYTHONPATH": "examples:tests", "OMP_NUM_THREADS": "1"}
    subprocess.run(command + ["--exporter", exporter] * takes_exporter, cwd=ROOT, env=environment, check=True)
    assert counted(tmp_path / f"{page}.md") == counted(ROOT / "docs/evidence" / f"{page}.md")
