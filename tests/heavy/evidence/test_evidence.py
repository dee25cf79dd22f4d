"""The pages of evidence are what their commands write."""

import os
import re
import shutil
import subprocess
import sys

import pages
import pytest
from conftest import ROOT

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
