"""cofmupy 1.0.0 and the fmpy 0.3.20 that it needs, over Pacoima Dam with the record inside; both are in a folder of their own."""

import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT
from pacoima import END, OUTPUTS, STEP, distance

PACKAGES = ROOT / "out" / "cofmupy"
pytestmark = pytest.mark.skipif(not PACKAGES.exists(), reason="cofmupy is missing: `make heavy PARTS=hosts` installs it")
COFMUPY = """
import json, sys
from cofmupy import Coordinator
path, step, steps, *outputs = sys.argv[1:]
with open("scene.json", "w") as scene:
    json.dump({"root": ".", "fmus": [{"id": "pier", "path": path}], "connections": [], "cosim_method": "jacobi", "edge_sep": " -> "}, scene)
pier = Coordinator()
pier.start("scene.json")
for _ in range(int(steps)):
    pier.do_step(float(step))
with open("rows.json", "w") as rows:
    json.dump([pier.get_results()["pier", name] for name in outputs], rows)
"""


@pytest.fixture
def python(tmp_path):
    """Runs Python with these packages."""

    def run(*arguments):
        environment = os.environ | {"PYTHONPATH": str(PACKAGES)}
        subprocess.run([sys.executable, *map(str, arguments)], cwd=tmp_path, env=environment, check=True, capture_output=True)

    return run


@pytest.mark.parametrize("version", [2, 3])
def test_cofmupy(export, pacoima_record, exact, python, tmp_path, version):
    expected = exact(STEP)
    python("-c", COFMUPY, export("mcmanus", pacoima_record, fmi=version), STEP, len(expected) - 1, *OUTPUTS)
    found = np.transpose(np.loadtxt((tmp_path / "rows.json").read_text().strip("[]").split("], ["), delimiter=","))
    assert distance(found, expected[1:]) < 1e-9


@pytest.mark.parametrize("version", [2, 3])
def test_older_fmpy(export, pacoima_record, exact, python, tmp_path, version):
    path = export("mcmanus", pacoima_record, fmi=version)
    python("-m", "fmpy", "simulate", path, "--output-file", "out.csv", "--stop-time", END, "--output-interval", STEP)
    table = np.genfromtxt(tmp_path / "out.csv", delimiter=",", names=True)
    assert distance(np.column_stack([table[name] for name in OUTPUTS]), exact(STEP)) < 1e-9
