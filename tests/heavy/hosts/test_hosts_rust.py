"""The Rust import crate `fmi`, over Pacoima Dam, with the record inside and with a_g held over each step; FMU states
and their bytes."""

import os

import numpy as np
import pytest
from conftest import ROOT
from host import output, write
from pacoima import A_G, OUTPUTS, STEPS, TIME, distance, held, instants


@pytest.fixture(scope="module")
def run(mcmanus, tmp_path_factory):
    """Runs the host in tests/hosts/fmi_crate under a ground acceleration and returns time and OUTPUTS."""
    import clang.native

    folder = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "fmi_crate"
    # the package libclang brings the library, the C compiler its own headers
    headers = output("cc", "-print-file-name=include")
    libclang = {"LIBCLANG_PATH": clang.native.__path__[0], "BINDGEN_EXTRA_CLANG_ARGS": f"-isystem {headers.strip()}"}
    output("cargo", "build", "--locked", "--target-dir", folder, "--manifest-path", ROOT / "tests/hosts/fmi_crate/Cargo.toml",
           env=os.environ | libclang)
    record = tmp_path_factory.mktemp("fmi_crate") / "record.csv"

    def run(time, a_g, fmu=mcmanus, **start_values) -> np.ndarray:
        write(record, "m/s2", time, a_g)
        values = [f"{name}={value}" for name, value in start_values.items()]
        printed = output(folder / "debug" / "fmi-crate-host", fmu.path, record, ",".join(OUTPUTS), *values)
        return np.loadtxt(printed.splitlines(), delimiter=",")

    return run


@pytest.mark.parametrize("step", STEPS)
def test_the_record_inside_with_every_step_taken_back_twice(run, shaken, exact, step):
    time = instants(step)
    result = run(time, 0 * time, shaken["mcmanus"])
    assert distance(result[:, 1:], exact(step)) < 1e-9


def test_held_with_every_step_taken_back_twice(run, mcmanus):
    result = run(TIME, A_G)
    assert np.array_equal(result[:, 0], TIME)
    assert distance(result[:, 1:], held(mcmanus)) < 1e-10


def test_a_run_ends_where_the_structure_overturns(run):
    time = np.linspace(0, 5, 501)
    result = run(time, np.zeros_like(time), theta_0=0.3)
    assert time[len(result) - 2] < result[-1, 0] < time[len(result) - 1] < 2.0
    assert result[-1, 1] == pytest.approx(np.pi / 2, abs=1e-14)
