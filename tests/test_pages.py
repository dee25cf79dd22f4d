"""README and the pages print what the program prints today."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pages
import pytest
from conftest import ROOT


def is_long(page):
    return "<!-- heavy -->" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("page", [
    pytest.param(page, id=str(page.relative_to(ROOT)), marks=[pytest.mark.heavy] * is_long(page))
    for page in pages.PAGES if pages.BLOCK.search(page.read_text(encoding="utf-8"))])
def test_what_a_page_prints_is_what_its_commands_print(page, exporter, tmp_path):
    text = page.read_text(encoding="utf-8")
    assert pages.rerun(text, exporter, pages.prepare(tmp_path / "page", exporter)) == text, "run `make pages`"


def test_the_command_line_is_described_by_its_own_help(exporter):
    page = (ROOT / "docs/reference/command_line.md").read_text(encoding="utf-8")
    assert pages.command_line(exporter) == page, "run `make pages`"


def test_the_variables_are_those_of_the_model_description(mcmanus, exporter, tmp_path):
    page = (ROOT / "docs/reference/variables.md").read_text(encoding="utf-8")
    assert pages.variables(mcmanus.path, pages.building(exporter, tmp_path)) == page, "run `make pages`"


def test_readme_has_the_findings_of_their_script(exporter, tmp_path):
    folder = pages.prepare(tmp_path / "page", exporter)
    environment = os.environ | {"PATH": f"{exporter.parent}:{os.environ['PATH']}"}
    found = subprocess.run([sys.executable, ROOT / "examples/findings.py"], cwd=folder, env=environment, check=True,
                           stdout=subprocess.PIPE, text=True, encoding="utf-8").stdout
    assert found and found in (ROOT / "README.md").read_text(encoding="utf-8")


def test_both_readmes_have_the_first_run_of_the_page_of_python():
    page = (ROOT / "docs/howto/python.md").read_text(encoding="utf-8")
    first = re.search(r"```py\n.*?```\n\n```text\n.*?```", page, re.DOTALL)[0]
    package = (ROOT / "python/README.md").read_text(encoding="utf-8")
    assert first in (ROOT / "README.md").read_text(encoding="utf-8") and first in package
    assert "](" not in package, "the package's page has no files to link to"


NUMBER = r"\d[\d,]*\.?\d*(?:e[+−-]?\d+)?"


def split(page):
    """Words and numbers, without the line that says when they were made."""
    text = re.sub(r"^\*Made by .*", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    numbers = [float(number.replace(",", "").replace("−", "-")) for number in re.findall(NUMBER, text)]
    return re.sub(NUMBER, "#", text), numbers


def compare(written, page):
    """To a per cent, for other C libraries have other last digits. What solvers of hosts make of these holds on one machine."""
    (words, numbers), (as_told, told) = split(written), split(page)
    assert words == as_told and numbers == pytest.approx(told, rel=0.01, abs=0), f"make {page} anew"


@pytest.mark.heavy
@pytest.mark.parametrize("page, module", [
    ("paper", "validation"), ("literature", "literature"), ("overturning", "overturning"), ("restrained", "restrained"),
    ("modes", "modes"), ("coupling", "coupling"), ("model_exchange", "model_exchange")])
def test_a_page_of_evidence_is_what_its_command_writes(page, module, exporter, export, tmp_path):
    folder = pages.prepare(tmp_path / "page", exporter)
    for preset in ("mcmanus", "evison"):
        (folder / f"out/{preset}3.fmu").symlink_to(export(preset, fmi=3))
    path = f"{exporter.parent}:{os.environ['PATH']}"
    environment = os.environ | {"PYTHONPATH": f"{ROOT}/examples:{ROOT}/tests", "OMP_NUM_THREADS": "1", "PATH": path}
    subprocess.run([sys.executable, "-m", module, "--output", f"{page}.md"], cwd=folder, env=environment, check=True)
    compare(folder / f"{page}.md", ROOT / "docs/evidence" / f"{page}.md")


@pytest.mark.heavy
@pytest.mark.parametrize("page, command", [
    ("evidence/accuracy", ["precision", "--again"]), ("evidence/stability", ["stability"]), ("explain/failures", ["failures"]),
    ("explain/validity", ["validity"])])
def test_a_page_of_the_study_is_what_the_study_writes(page, command, tmp_path):
    """Accuracy is made from the times that were measured: its tables are here."""
    for folder in ("evidence", "explain"):
        (tmp_path / "docs" / folder).mkdir(parents=True)
    for file in (ROOT / "docs/evidence").glob("accuracy*"):
        shutil.copy(file, tmp_path / "docs/evidence")
    study = ["cargo", "run", "--release", "--manifest-path", ROOT / "study/Cargo.toml", "--", *command]
    subprocess.run([*study, "--records", pages.RECORD.parents[1]], cwd=tmp_path, check=True)
    compare(tmp_path / "docs" / f"{page}.md", ROOT / "docs" / f"{page}.md")


def test_every_page_is_in_readme_and_in_the_list_of_the_site():
    readme, site = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "docs/toc.yml"))
    for page in sorted((ROOT / "docs").glob("*/*.md")):
        name = str(page.relative_to(ROOT))
        assert f"]({name})" in readme and f"file: {name.removesuffix('.md')}\n" in site, name
