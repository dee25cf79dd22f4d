"""The packages in out/wheels: which machines each is for, what is in it, and what its module needs."""

import re
import sys
import tarfile
import tomllib
import zipfile

import binaries
import pytest
from conftest import ROOT
from host import output, write
from packages import package
from pacoima import A_G, TIME

TAGS = {
    "linux-x86": "cp310-abi3-manylinux2014_x86_64.manylinux_2_17_x86_64",
    "linux-arm": "cp310-abi3-manylinux2014_aarch64.manylinux_2_17_aarch64",
    "windows": "cp310-abi3-win_amd64",
    "macos": "cp310-abi3-macosx_11_0_arm64.macosx_11_0_universal2.macosx_11_0_x86_64",
}
MODULES = dict.fromkeys(TAGS, "_native.abi3.so") | {"windows": "_native.pyd"}
PROGRAMS = dict.fromkeys(TAGS, "rocking-fmu") | {"windows": "rocking-fmu.exe"}
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
NAME = f"flexible_rocking-{VERSION}"


@pytest.fixture(scope="module", params=TAGS)
def wheel(request):
    with zipfile.ZipFile(package(f"{NAME}-{TAGS[request.param]}.whl")) as content:
        yield request.param, content


def test_there_are_no_others():
    found = {path.name for path in (ROOT / "out" / "wheels").glob("*")}
    assert found <= {f"{NAME}-{tag}.whl" for tag in TAGS.values()} | {f"{NAME}.tar.gz"}


def test_files(wheel):
    machine, content = wheel
    texts = {path.name for path in (ROOT / "python" / "flexible_rocking").iterdir() if path.suffix in (".py", ".pyi", ".typed")}
    module = {f"flexible_rocking/{name}" for name in texts | {MODULES[machine]}}
    own = module | {f"{NAME}.data/data/share/flexible-rocking/FlexibleRocking.fmu", f"{NAME}.data/scripts/{PROGRAMS[machine]}"}
    about = {f"{NAME}.dist-info/{file}" for file in ("METADATA", "WHEEL", "RECORD", "licenses/LICENSE-MIT", "licenses/LICENSE-APACHE")}
    assert set(content.namelist()) == own | about
    assert content.read(next(name for name in own if name.endswith(".fmu"))) == (ROOT / "out" / "FlexibleRocking.fmu").read_bytes()
    assert all(binaries.tells_no_place(content.read(name)) for name in content.namelist())
    tags = [line.partition(": ")[2] for line in content.read(f"{NAME}.dist-info/WHEEL").decode().splitlines() if line.startswith("Tag: ")]
    python, abi, platforms = TAGS[machine].split("-")
    assert set(tags) == {f"{python}-{abi}-{platform}" for platform in platforms.split(".")}
    assert {entry.date_time[:3] for entry in content.infolist()} == {(1980, 1, 1)}, "it tells when it was built"


def test_module_and_program_need_no_newer_system(wheel, tmp_path):
    machine, content = wheel
    module = content.extract(f"flexible_rocking/{MODULES[machine]}", tmp_path)
    program = content.extract(f"{NAME}.data/scripts/{PROGRAMS[machine]}", tmp_path)
    assert content.getinfo(f"{NAME}.data/scripts/{PROGRAMS[machine]}").external_attr >> 16 & 0o111, "it cannot be run"
    for file in (program, module):
        match machine:
            case "windows":
                binary = binaries.for_windows(file, {"python3.dll"} if file is module else frozenset())
            case "macos":
                parts = binaries.for_macos(file, {"X86_64", "ARM64"})  # they own their binaries
                binary = parts.at(0)
            case _:
                binary = binaries.for_linux(file, {"linux-x86": "X86_64", "linux-arm": "AARCH64"}[machine])
    assert any(function.name.strip("_") == "PyInit__native" for function in binary.exported_functions)


def test_arm_gives_the_bits_of_this_machine(tmp_path):
    """The module for 64-bit ARM, in Debian's Python for it, under qemu."""
    pythons = sorted((ROOT / "out/arm_python/usr/bin").glob("python3.*"))
    if not pythons:
        pytest.skip("out/arm_python is missing: `make out/arm_python/usr` fetches it where apt-get can")
    output(sys.executable, "-m", "pip", "install", "--quiet", "--target", tmp_path / "arm", "--only-binary=:all:", "--python-version",
           pythons[0].name.removeprefix("python"), "--platform", "manylinux2014_aarch64", package(f"{NAME}-{TAGS['linux-arm']}.whl"))
    write(tmp_path / "pacoima.csv", "m/s2", TIME, A_G)
    script = ("import platform, flexible_rocking as fr; run = fr.simulate(fr.Structure(preset='mcmanus'), fr.Record.read('pacoima.csv'))\n"
              "print(platform.machine(), *((peak.value.hex(), peak.time.hex()) for peak in run.peaks.values()))")
    machines = [[sys.executable], ["qemu-aarch64", "-E", f"PYTHONPATH={tmp_path}/arm", "-L", ROOT / "out/arm_python", pythons[0]]]
    here, arm = (output(*of, "-c", script, cwd=tmp_path).split() for of in machines)
    assert arm[0] == "aarch64" and arm[1:] == here[1:]


def test_source():
    """The package of the source has every file that is compiled, and what these include."""
    path = package(f"{NAME}.tar.gz")
    compiled = [file for folder in ("src", "modelDescription/src", "fmu/src", "fmu/build", "fmu/export", "view/src", "records/src", "report/src", "cli/src", "sweep/src", "python/src")
                for file in (ROOT / folder).rglob("*") if file.is_file()]
    compiled += [(file.parent / included).resolve() for file in compiled if file.suffix == ".rs"
                 for included in re.findall(r'include_(?:str|bytes)!\("(.*?)"\)', file.read_text())]
    with tarfile.open(path) as content:
        for file in compiled:
            inside = content.extractfile(f"{NAME}/{file.relative_to(ROOT)}")
            assert inside.read() == file.read_bytes(), file
        assert {entry.mtime for entry in content.getmembers()} == {315532800}, "it tells when it was built"
