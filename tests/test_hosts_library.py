"""The shared library itself: what it offers, what it needs, and its numbers on Linux."""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from fmpy.fmi3 import FMU3Model, FMU3ScheduledExecution, FMU3Slave
from host import output, write
from pacoima import A_G, OUTPUTS, STEPS, TIME, distance, instants, linear

HOST = "tests/hosts/load_library/Cargo.toml"

# The C library, its parts of before glibc 2.34, its mathematics and start-up, and the compiler's run time.
LINUX_RUN_TIME = {"libc.so.6", "libdl.so.2", "libpthread.so.0", "libm.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}


def cargo_build(*arguments, tool="build"):
    """Builds and returns the target folder; `tool` may be one of this environment's."""
    target = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    output("cargo", tool, "--locked", "--target-dir", target, *arguments, cwd=ROOT, env=os.environ | {"PATH": path})
    return target


@pytest.fixture(scope="module")
def functions(mcmanus) -> set[str]:
    """All that fmpy knows how to call."""
    of_2 = (mcmanus.instance(kind).slave for kind in ("CoSimulation", "ModelExchange"))
    return {name for of in (*of_2, FMU3Slave, FMU3Model, FMU3ScheduledExecution) for name in dir(of) if name.startswith(("fmi2", "fmi3"))}


@pytest.fixture(scope="module")
def run(mcmanus, tmp_path_factory):
    """Runs tests/hosts/load_library under a_g of Pacoima Dam, linear between samples, or, at a step, under what an FMU
    has inside, and returns OUTPUTS."""
    scene = tmp_path_factory.mktemp("scene") / "a_g.csv"
    a_g, *outputs = mcmanus.references(["a_g", *OUTPUTS])

    def run(*command, library, fmu=mcmanus, step=None, **arguments) -> np.ndarray:
        write(scene, "m/s2", *(TIME, A_G) if step is None else (instants(step), 0 * instants(step)))
        printed = output(*command, library, fmu.description.guid, f"{fmu.folder}/resources", scene,
                         a_g, ",".join(map(str, outputs)), **arguments)
        return np.loadtxt(printed.splitlines(), delimiter=",")[:, 1:]

    return run


@pytest.fixture(scope="module")
def linux_library(mcmanus):
    return f"{mcmanus.folder}/binaries/linux64/FlexibleRocking.so"


@pytest.fixture(scope="module")
def linux_host():
    return cargo_build("--release", "--manifest-path", HOST) / "release" / "load-library"


def test_linux_library(linux_library, functions):
    assert {line.split()[-1] for line in output("nm", "-D", "--defined-only", linux_library).splitlines()} == functions
    needed = re.findall(r"NEEDED\s+(\S+)", output("objdump", "-p", linux_library))
    assert set(needed) <= LINUX_RUN_TIME


def test_linux_host(run, linux_host, linux_library, mcmanus):
    assert distance(run(linux_host, library=linux_library), linear(mcmanus)) < 1e-12


@pytest.mark.parametrize("step", STEPS)
def test_linux_host_with_the_record_inside(run, linux_host, linux_library, shaken, exact, step):
    found = run(linux_host, library=linux_library, fmu=shaken["mcmanus"], step=step)
    assert distance(found, exact(step)) < 1e-9
