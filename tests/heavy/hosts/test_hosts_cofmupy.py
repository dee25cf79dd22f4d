"""cofmupy 1.0.0 and the fmpy 0.3.20 that it needs, over Pacoima Dam with the record inside; both are in a folder of their own."""

import json
import os
import sys

import numpy as np
import pytest
from conftest import ROOT
from host import output
from pacoima import END, OUTPUTS, STEP, distance, rows

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


@pytest.fixture(params=[2, 3])
def run(request, export, pacoima_record, tmp_path):
    """Runs Python with these packages, `{}` in whose arguments is the FMU."""
    path = export("mcmanus", pacoima_record, fmi=request.param).path
    environment = os.environ | {"PYTHONPATH": str(PACKAGES)}
    return lambda *arguments: output(sys.executable, *(path if of == "{}" else of for of in arguments), cwd=tmp_path, env=environment)


def test_cofmupy(run, exact, tmp_path):
    expected = exact(STEP)
    run("-c", COFMUPY, "{}", STEP, len(expected) - 1, *OUTPUTS)
    assert distance(np.transpose(json.loads((tmp_path / "rows.json").read_text())), expected[1:]) < 1e-9


def test_older_fmpy(run, exact, tmp_path):
    run("-m", "fmpy", "simulate", "{}", "--output-file", "out.csv", "--stop-time", END, "--output-interval", STEP)
    assert distance(rows(np.genfromtxt(tmp_path / "out.csv", delimiter=",", names=True)), exact(STEP)) < 1e-9
