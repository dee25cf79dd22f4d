"""The libraries in out/FlexibleRocking.fmu, which `make dist` writes: what each offers and needs, and Linux's numbers on
64-bit ARM and on an old system. Wine runs Windows' in test_hosts_library.py; nothing here runs macOS'."""

import shutil
import zipfile
from pathlib import Path

import binaries
import pytest
from conftest import ROOT
from fmpy import read_model_description
from host import Fmu
from pacoima import distance
from test_hosts_library import HOST, cargo_build

pytest_plugins = ["test_hosts_library"]  # for its fixtures

X86 = "x86_64-unknown-linux-gnu"
ARM = "aarch64-unknown-linux-gnu"
ARM_SYSTEM = Path("/usr/aarch64-linux-gnu")
# The loader of glibc 2.31, which `make out/debian11/lib` takes out of Debian 11's package.
OLD_LOADER = ROOT / "out/debian11/lib/x86_64-linux-gnu/ld-2.31.so"

PLATFORMS = {"linux64": "so", "aarch64-linux": "so", "win64": "dll", "darwin64": "dylib", "aarch64-darwin": "dylib"}

MACOS_LEFT = {"___isPlatformVersionAtLeast", "___isOSVersionAtLeast", "_rust_eh_personality", "__mh_dylib_header",
              "___dso_handle"}


@pytest.fixture(scope="module")
def fmu(export):
    path, fresh = ROOT / "out" / "FlexibleRocking.fmu", export(None, ROOT / "examples/pulse.csv")
    if not path.exists() or read_model_description(path).guid != fresh.description.guid:
        pytest.skip("out/FlexibleRocking.fmu is not of this build: `make dist` writes it")
    return Fmu(path)


@pytest.fixture(scope="module")
def library(fmu):
    def library(folder):
        (path,) = (fmu.folder / "binaries" / folder).iterdir()
        return path

    return library


def test_platforms(fmu):
    with zipfile.ZipFile(fmu.path) as archive:
        found = {name.removeprefix("binaries/") for name in archive.namelist() if name.startswith("binaries/")}
    assert found == {f"{folder}/FlexibleRocking.{ending}" for folder, ending in PLATFORMS.items()}


@pytest.mark.parametrize("folder, machine", [("linux64", "X86_64"), ("aarch64-linux", "AARCH64")])
def test_linux(library, functions, folder, machine):
    binary = binaries.for_linux(library(folder), machine)
    assert {symbol.name for symbol in binary.exported_symbols} == functions


def test_windows(library, functions):
    binary = binaries.for_windows(library("win64"))
    assert {entry.name for entry in binary.get_export().entries} == functions


@pytest.mark.parametrize("folder, cpus", [("darwin64", {"X86_64", "ARM64"}), ("aarch64-darwin", {"ARM64"})])
def test_macos(library, functions, folder, cpus):
    parts = binaries.for_macos(library(folder), cpus)
    for binary in parts:
        assert binary.header.file_type.name == "DYLIB"
        assert binary.libraries[0].name == "@rpath/libFlexibleRocking.dylib"
        exported = {symbol.name for symbol in binary.exported_symbols}
        assert {name.removeprefix("_") for name in exported if name.startswith(("_fmi2", "_fmi3"))} == functions
        # Zig's linker knows no list of exports: Rust's own names are left beside them.
        others = {name for name in exported if not name.startswith(("_fmi2", "_fmi3", "__R", "__ZN"))}
        assert others <= MACOS_LEFT


@pytest.mark.parametrize("folder", sorted(PLATFORMS))
def test_no_library_tells_where_it_was_built(library, folder):
    assert binaries.tells_no_place(library(folder).read_bytes())


def test_an_old_system(run, shaken, library):
    """Linux's library and its host with the C library of Debian 11, glibc 2.31."""
    if not OLD_LOADER.exists():
        pytest.skip(f"{OLD_LOADER} is missing: `make out/debian11/lib` fetches it where apt-get can")
    old = cargo_build("--release", "--target", f"{X86}.2.17", "--manifest-path", HOST, tool="zigbuild") / X86 / "release" / "load-library"
    fmu = shaken["mcmanus"]
    found = run(OLD_LOADER, "--library-path", OLD_LOADER.parent, old, library=library("linux64"), fmu=fmu, step=2e-3)
    expected = run(old, library=library("linux64"), fmu=fmu, step=2e-3)
    assert distance(found, expected) < 1e-12


def test_arm_gives_the_numbers_of_x86(run, linux_host, shaken, mcmanus, library):
    if shutil.which("qemu-aarch64") is None or not (ARM_SYSTEM / "lib/ld-linux-aarch64.so.1").exists():
        pytest.skip("qemu-aarch64 or the C library for it is missing: packages qemu-user, libc6-arm64-cross")
    arm = cargo_build("--release", "--target", ARM, "--manifest-path", HOST, tool="zigbuild") / ARM / "release" / "load-library"
    for fmu, step in ((mcmanus, None), (shaken["mcmanus"], 2e-3)):
        expected = run(linux_host, library=library("linux64"), fmu=fmu, step=step)
        found = run("qemu-aarch64", "-L", ARM_SYSTEM, arm, library=library("aarch64-linux"), fmu=fmu, step=step)
        assert distance(found, expected) < 1e-12
