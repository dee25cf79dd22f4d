"""What `make check` tests: of the changed files on standard input, prints for a shell the packages of cargo, without those of the
arguments, the files of pytest, and those of `make heavy` with their parts."""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
FMU, PYTHON, BROWSER = ([f"tests/{file}.py" for file in files.split()] for files in (
    "test_archive test_derivatives test_floating_point test_fmi3 test_inputs test_integrator test_record_inside test_refusals test_states",
    "heavy/python/test_python heavy/python/test_many_masses heavy/python/test_calibrate heavy/python/test_design",
    "heavy/browser/test_view heavy/browser/test_explore"))
#: The tests in Python of a folder.
TESTS = {"fmu": FMU, "modelDescription": FMU, "python": PYTHON, "view": BROWSER, "web": BROWSER[1:]}


def packages(changed: list[Path]) -> set[str]:
    """The packages with a changed file, those that depend on them, and those whose tests do."""
    command = ["cargo", "metadata", "--no-deps", "--format-version=1"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)["packages"]
    names = {Path(package["manifest_path"]).parent: package["name"] for package in metadata}
    found, tested = set(), set()
    for file in (ROOT / file for file in changed):
        owner = next(folder for folder in file.parents if (folder / "Cargo.toml").exists())
        if owner in names and (owner != ROOT or file.suffix == ".rs" or file.name in ("Cargo.toml", "Cargo.lock")):
            (tested if file.relative_to(owner).parts[0] in ("tests", "examples") else found).add(names[owner])
    for kinds in [(None, "build")] * len(names) + [("dev",)]:
        found |= {package["name"] for package in metadata for of in package["dependencies"] if of["kind"] in kinds and of["name"] in found}
    return found | tested


def tests(changed: list[Path]) -> set[Path]:
    """The tests that have changed or are of a changed folder, or all of `make test` if what they share has changed."""
    python = {file for file in changed if file.suffix == ".py"}
    found = {file for file in python if file.name.startswith("test_") and (ROOT / file).exists()}
    if any(len(file.parts) == 2 and file.parts[0] in ("tests", "docs", "evidence") for file in python - found):
        found |= {file.relative_to(ROOT) for file in ROOT.glob("tests/test_*.py")}
    return found | {Path(test) for file in changed if file.suffix != ".md" for test in TESTS.get(file.parts[0], [])}


changed = [Path(line) for line in sys.stdin.read().splitlines()]
found = tests(changed)
heavy = {file for file in found if file.parts[1] == "heavy"}
for name, values in {"packages": (f"--package {name}" for name in packages(changed) - set(sys.argv[1:])), "tests": found - heavy,
                     "heavy": heavy, "parts": {file.parts[2] for file in heavy}}.items():
    print(f"{name}='{' '.join(sorted(map(str, values)))}'")
