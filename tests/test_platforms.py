"""The libraries in out/FlexibleRocking.fmu, which `make dist` writes: what each offers and needs, and Linux's numbers on
64-bit ARM. Wine runs Windows' in test_hosts_library.py; macOS is read here, and run nowhere."""

import os
import shutil
import subprocess
import zipfile

import pytest
from conftest import ROOT
from fmpy import read_model_description
from host import Fmu
from pacoima import distance
from test_hosts_library import FUNCTIONS, HOST, WINDOWS_RUN_TIME, cargo_build, output, run  # noqa: F401

lief = pytest.importorskip("lief", reason="lief is missing: `make foreign` installs it")

ARM = "aarch64-unknown-linux-gnu"
ARM_SYSTEM = "/usr/aarch64-linux-gnu"
OLDEST_GLIBC = (2, 17)
OLDEST_MACOS = [11, 0, 0]

# The parts of glibc, as they were before 2.34 joined them.
LINUX_RUN_TIME = {f"lib{name}.so" for name in ("c", "m", "pthread", "dl")}
LINUX_LOADERS = {"linux64": "ld-linux-x86-64.so", "aarch64-linux": "ld-linux-aarch64.so"}
MACOS_RUN_TIME = {f"/usr/lib/lib{name}.dylib" for name in ("System.B", "charset.1", "iconv.2")}

MACOS_LEFT = {"___isPlatformVersionAtLeast", "___isOSVersionAtLeast", "_rust_eh_personality", "__mh_dylib_header",
              "___dso_handle"}


@pytest.fixture(scope="module")
def fmu(exporter, tmp_path_factory):
    """The archive of this build."""
    path = ROOT / "out" / "FlexibleRocking.fmu"
    fresh = tmp_path_factory.mktemp("fresh") / "FlexibleRocking.fmu"
    output(exporter, "export", "--record", ROOT / "examples/pulse.csv", "-o", fresh)
    if not path.exists() or read_model_description(path).guid != read_model_description(fresh).guid:
        pytest.skip("out/FlexibleRocking.fmu is not of this build: `make dist` writes it")
    return Fmu(path, tmp_path_factory.mktemp("unpacked"))


@pytest.fixture(scope="module")
def library(fmu):
    def library(folder):
        (path,) = (fmu.folder / "binaries" / folder).iterdir()
        return path

    return library


def test_platforms(fmu):
    with zipfile.ZipFile(fmu.path) as archive:
        found = {name.removeprefix("binaries/") for name in archive.namelist() if name.startswith("binaries/")}
    assert found == {"linux64/FlexibleRocking.so", "aarch64-linux/FlexibleRocking.so", "win64/FlexibleRocking.dll",
                     "darwin64/FlexibleRocking.dylib", "aarch64-darwin/FlexibleRocking.dylib"}


@pytest.mark.parametrize("folder, machine", [("linux64", "X86_64"), ("aarch64-linux", "AARCH64")])
def test_linux(library, folder, machine):
    binary = lief.ELF.parse(library(folder))
    assert binary.header.machine_type.name == machine
    assert {symbol.name for symbol in binary.exported_symbols} == FUNCTIONS
    needed = {name.rpartition(".")[0] for name in binary.libraries}
    assert "libc.so" in needed and needed <= LINUX_RUN_TIME | {LINUX_LOADERS[folder]}
    versions = {auxiliary.name for library in binary.symbols_version_requirement
                for auxiliary in library.get_auxiliary_symbols()}
    assert versions, "no symbol has a version"
    for version in versions:
        kind, _, number = version.partition("_")
        assert kind == "GLIBC" and tuple(map(int, number.split("."))) <= OLDEST_GLIBC, version
    assert not {"RPATH", "RUNPATH"} & {entry.tag.name for entry in binary.dynamic_entries}


def test_windows(library):
    binary = lief.PE.parse(library("win64"))
    assert binary.header.machine.name == "AMD64"
    assert {entry.name for entry in binary.get_export().entries} == FUNCTIONS
    assert {imported.name.lower() for imported in binary.imports} <= WINDOWS_RUN_TIME
    assert binary.header.time_date_stamps == 0, "the library tells when it was built"


@pytest.mark.parametrize("folder, cpus", [("darwin64", {"X86_64", "ARM64"}), ("aarch64-darwin", {"ARM64"})])
def test_macos(library, folder, cpus):
    file = lief.MachO.parse(library(folder))  # owns its parts
    binaries = list(file)
    assert {binary.header.cpu_type.name for binary in binaries} == cpus and len(binaries) == len(cpus)
    for binary in binaries:
        assert binary.header.file_type.name == "DYLIB"
        own, *needed = [library.name for library in binary.libraries]
        assert own == "@rpath/libFlexibleRocking.dylib" and set(needed) <= MACOS_RUN_TIME
        assert binary.build_version.minos <= OLDEST_MACOS
        exported = {symbol.name for symbol in binary.exported_symbols}
        functions = {name.removeprefix("_") for name in exported if name.startswith(("_fmi2", "_fmi3"))}
        assert functions == FUNCTIONS
        # Zig's linker knows no list of exports: Rust's own names are left beside them.
        others = {name for name in exported if not name.startswith(("_fmi2", "_fmi3", "__R", "__ZN"))}
        assert others <= MACOS_LEFT
    # Apple silicon runs nothing unsigned; a signature without a signer is enough.
    arm = next(binary for binary in binaries if binary.header.cpu_type.name == "ARM64")
    assert arm.has_code_signature


def test_arm_gives_the_numbers_of_x86(run, shaken, mcmanus, library):  # noqa: F811
    if shutil.which("qemu-aarch64") is None or not os.path.exists(f"{ARM_SYSTEM}/lib/ld-linux-aarch64.so.1"):
        pytest.skip("qemu-aarch64 or the C library for it is missing: packages qemu-user, libc6-arm64-cross")
    arm = cargo_build("--target", ARM, "--manifest-path", HOST, tool="zigbuild") / ARM / "release" / "load-library"
    native = cargo_build("--manifest-path", HOST) / "release" / "load-library"
    for fmu, step in ((mcmanus, None), (shaken["mcmanus"], 2e-3)):
        expected = run(native, library=library("linux64"), fmu=fmu, step=step)
        found = run("qemu-aarch64", "-L", ARM_SYSTEM, arm, library=library("aarch64-linux"), fmu=fmu, step=step)
        assert distance(found, expected) < 1e-12
