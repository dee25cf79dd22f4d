"""The wheel of `make wheels` for this machine, installed without Rust. The pattern PACKAGE may name another package. The package
of the source takes minutes and needs Rust."""

import json
import os
import re
import sys
from pathlib import Path

import numpy as np
import pages
import pytest
from conftest import ROOT
from fmpy import read_model_description, simulate_fmu
from host import output, write
from packages import package
from pacoima import A_G, TIME


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Runs a command of a fresh environment with the wheel, and the fmpy of `make demo`, beside the Pacoima Dam record."""
    folder = tmp_path_factory.mktemp("installed")
    output(sys.executable, "-m", "venv", folder / "venv")
    fmpy = re.search(r"fmpy==[\d.]+", (ROOT / "pyproject.toml").read_text())[0]
    environment = {"PATH": f"{folder}/venv/bin:/usr/bin:/bin", "HOME": str(folder)}
    assert not any(os.access(f"{place}/cargo", os.X_OK) for place in environment["PATH"].split(":"))
    run = lambda program, *arguments: output(folder / "venv/bin" / program, *arguments, cwd=folder, env=environment)
    output(folder / "venv/bin/python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
           package(os.environ.get("PACKAGE", "*-manylinux*_x86_64.whl")), fmpy)
    write(folder / "pacoima.csv", "m/s2", TIME, A_G)
    run.folder = folder
    return run


def test_the_script_of_the_page_prints_what_the_page_says(installed):
    page = (ROOT / "docs/howto/install.md").read_text(encoding="utf-8")
    [(script, printed)] = pages.scripts(page)
    assert installed("python", "-c", script) == printed


def test_the_fmu_is_the_one_of_dist(installed):
    path = installed("python", "-c", "import flexible_rocking; print(flexible_rocking.fmu())").strip()
    assert Path(path).read_bytes() == (ROOT / "out" / "FlexibleRocking.fmu").read_bytes()


def test_an_own_structure_with_its_record(installed, export):
    """The same bytes as the exporter writes that was built here, with the same libraries."""
    pier = dict(m=1000, m0=300, H=4, B=0.6, f_fc=3, zeta_fc=0.02, r=0.95)
    script = f"import flexible_rocking as fr; fr.export('pier.fmu', fr.Structure(**{pier}), record='pacoima.csv', name='Pier1')"
    installed("python", "-c", script)
    here = export(None, installed.folder / "pacoima.csv", *(f"--{key.replace('_', '-')}={value}" for key, value in pier.items()),
                  "--name", "Pier1", "--library", ROOT / "out" / "FlexibleRocking.fmu")
    assert (installed.folder / "pier.fmu").read_bytes() == Path(here.path).read_bytes()
    assert here.description.coSimulation.modelIdentifier == "Pier1"
    assert np.abs(simulate_fmu(here.path)["theta"]).max() > 0
    installed("python", "-c", script.replace("name='Pier1'", "fmi=3"))
    assert read_model_description(installed.folder / "pier.fmu").fmiVersion == "3.0"


def test_a_run_needs_numpy_alone_and_is_the_command_lines(installed):
    script = ("import flexible_rocking as fr; run = fr.simulate(fr.Structure(preset='evison'), fr.Record.read('pacoima.csv'))\n"
              "print(run.peaks['theta'].value, run.at(run.record.time)['a_t'].size)")
    peak, samples = installed("python", "-c", script).split()
    printed = json.loads(installed("rocking-fmu", "simulate", "--preset", "evison", "--record", "pacoima.csv", "--format", "json"))
    assert float(peak) == next(of["peak"] for of in printed["peaks"] if of["name"] == "theta") and int(samples) > 1000


def test_version(installed, exporter):
    """Version, build and platforms, the same as here."""
    printed = installed("rocking-fmu", "--version")
    assert printed == output(exporter, "--version") and re.search(r"\nbuild \{[0-9a-f-]{36}\}\nfor linux on x86_64; .* aarch64-darwin", printed)
