"""The packages in out/wheels: which machines each is for, what is in it, and what its program needs."""

import re
import stat
import tarfile
import tomllib
import zipfile

import binaries
import pytest
from conftest import ROOT
from packages import package

pytestmark = pytest.mark.heavy

TAGS = {
    "linux-x86": "py3-none-manylinux2014_x86_64.manylinux_2_17_x86_64",
    "linux-arm": "py3-none-manylinux2014_aarch64.manylinux_2_17_aarch64",
    "windows": "py3-none-win_amd64",
    "macos": "py3-none-macosx_11_0_arm64.macosx_11_0_universal2.macosx_11_0_x86_64",
}
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
NAME = f"flexible_rocking-{VERSION}"


@pytest.fixture(scope="module", params=TAGS)
def wheel(request):
    """Machine and wheel."""
    with zipfile.ZipFile(package(f"{NAME}-{TAGS[request.param]}.whl")) as content:
        yield request.param, content


def test_there_are_no_others():
    found = {path.name for path in (ROOT / "out" / "wheels").glob("*")}
    assert found <= {f"{NAME}-{tag}.whl" for tag in TAGS.values()} | {f"{NAME}.tar.gz"}


def test_files(wheel):
    machine, content = wheel
    program = "rocking-fmu.exe" if machine == "windows" else "rocking-fmu"
    own = {"flexible_rocking/__init__.py", f"{NAME}.data/scripts/{program}", f"{NAME}.data/data/share/flexible-rocking/FlexibleRocking.fmu"}
    about = {f"{NAME}.dist-info/{file}" for file in ("METADATA", "WHEEL", "RECORD", "licenses/LICENSE-MIT", "licenses/LICENSE-APACHE")}
    assert set(content.namelist()) == own | about
    assert all(binaries.tells_no_place(content.read(name)) for name in content.namelist())
    tags = [line.partition(": ")[2] for line in content.read(f"{NAME}.dist-info/WHEEL").decode().splitlines() if line.startswith("Tag: ")]
    python, abi, platforms = TAGS[machine].split("-")
    assert set(tags) == {f"{python}-{abi}-{platform}" for platform in platforms.split(".")}
    assert {entry.date_time[:3] for entry in content.infolist()} == {(1980, 1, 1)}, "it tells when it was built"
    executable = content.getinfo(f"{NAME}.data/scripts/{program}").external_attr >> 16
    assert stat.S_IMODE(executable) & 0o111 == 0o111


def test_the_archive_is_the_one_of_dist(wheel):
    _, content = wheel
    (inside,) = (name for name in content.namelist() if name.endswith(".fmu"))
    assert content.read(inside) == (ROOT / "out" / "FlexibleRocking.fmu").read_bytes()


def test_program(wheel, tmp_path):
    machine, content = wheel
    (name,) = (name for name in content.namelist() if "/scripts/" in name)
    program = content.extract(name, tmp_path)
    match machine:
        case "linux-x86":
            binaries.for_linux(program, "X86_64")
        case "linux-arm":
            binaries.for_linux(program, "AARCH64")
        case "windows":
            binaries.for_windows(program)
        case "macos":
            binaries.for_macos(program, {"X86_64", "ARM64"})


def test_source():
    """The package of the source has every file that is compiled, and what these include."""
    path = package(f"{NAME}.tar.gz")
    compiled = [file for folder in ("src", "modelDescription/src", "fmu/src", "fmu/build", "fmu/export", "cli/src")
                for file in (ROOT / folder).rglob("*") if file.is_file()]
    compiled += [(file.parent / included).resolve() for file in compiled if file.suffix == ".rs"
                 for included in re.findall(r'include_(?:str|bytes)!\("(.*?)"\)', file.read_text())]
    with tarfile.open(path) as content:
        for file in compiled:
            inside = content.extractfile(f"{NAME}/{file.relative_to(ROOT)}")
            assert inside.read() == file.read_bytes(), file
        assert {entry.mtime for entry in content.getmembers()} == {315532800}, "it tells when it was built"
