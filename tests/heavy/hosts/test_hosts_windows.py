"""The library for Windows under wine: the numbers of Linux."""

import functools
import os
import shutil

import pytest
from host import output
from pacoima import STEPS, distance
from test_hosts_library import HOST, cargo_build

pytest_plugins = ["test_hosts_library"]  # for its fixtures

WINDOWS, MINGW = "x86_64-pc-windows-gnu", "x86_64-w64-mingw32-gcc"


@pytest.fixture(scope="module")
def windows():
    """The folder of the library for Windows."""
    if shutil.which("rustup") is None or WINDOWS not in output("rustup", "target", "list", "--installed").split():
        pytest.skip(f"Rust's target {WINDOWS} is missing")
    for program in ("wine", MINGW):
        if shutil.which(program) is None:
            pytest.skip(f"{program} is missing")
    target = cargo_build("--profile", "dist", "--target", WINDOWS, "--package", "flexible-rocking-fmu")
    return target / WINDOWS / "dist"


@pytest.fixture(scope="module")
def wine(windows, run, tmp_path_factory):
    """Runs the host under wine. Wine 8 has no bcryptprimitives.dll, of which Rust needs one function, for the keys of hash maps:
    one that will do is put there."""
    folder = tmp_path_factory.mktemp("wine")
    source = folder / "bcryptprimitives.c"
    source.write_text("__declspec(dllexport) int ProcessPrng(unsigned char *data, unsigned long long size) {"
                      "for (unsigned long long i = 0; i < size; i++) data[i] = 37 * i; return 1; }")
    output(MINGW, "-shared", "-nostdlib", "-Wl,--entry=0", "-o", folder / "bcryptprimitives.dll", source)
    environment = os.environ | {"WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
    host = cargo_build("--release", "--target", WINDOWS, "--manifest-path", HOST) / WINDOWS / "release"
    for file in (windows / "FlexibleRocking.dll", host / "load-library.exe"):
        shutil.copy(file, folder)
    return functools.partial(run, "wine", "load-library.exe", library="FlexibleRocking.dll", cwd=folder, env=environment)


def test_windows_gives_the_numbers_of_linux(wine, run, linux_host, linux_library):
    assert distance(wine(), run(linux_host, library=linux_library)) < 1e-12


@pytest.mark.parametrize("step", STEPS)
def test_windows_with_the_record_inside(wine, shaken, exact, step):
    assert distance(wine(fmu=shaken["mcmanus"], step=step), exact(step)) < 1e-9
