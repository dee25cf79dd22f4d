"""What `make check` tests: of the changed files on standard input, prints for a shell the packages of cargo, without those of the
arguments, the files of pytest, and those of `make heavy` with their parts."""

import ast
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
MODULES = [ROOT / folder for folder in ("tests", "docs", "evidence")]
#: Of folders whose files no test imports, the tests.
FMU, PYTHON, BROWSER = ([f"tests/{file}.py" for file in files.split()] for files in (
    "test_archive test_derivatives test_floating_point test_fmi3 test_inputs test_integrator test_record_inside test_refusals test_states",
    "heavy/python/test_python heavy/python/test_many_masses", "heavy/browser/test_view heavy/browser/test_explore"))
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


def imported(file: Path):
    """The files that may be what `file` imports."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            module = [part for part in [getattr(node, "module", None)] if part]
            for name in [".".join([*module, of.name]) for of in node.names] + module:
                for root in [file.parents[node.level - 1]] if getattr(node, "level", 0) else [ROOT, *MODULES]:
                    yield from (root / f"{name.replace('.', '/')}{end}" for end in (".py", "/__init__.py"))


def tests(changed: list[Path]) -> set[Path]:
    """The tests that have changed or are of a changed folder, and those of `make test` that import what has changed."""
    imports = {file: set(imported(file)) for folder in MODULES for file in folder.rglob("*.py")}
    found = {ROOT / file for file in changed}
    while more := {file for file, of in imports.items() if of & found and "heavy" not in file.parts} - found:
        found |= more
    of_folders = {Path(test) for file in changed if file.suffix != ".md" for test in TESTS.get(file.parts[0], [])}
    return {file.relative_to(ROOT) for file in found & imports.keys() if file.name.startswith("test_")} | of_folders


changed = [Path(line) for line in sys.stdin.read().splitlines()]
found = tests(changed)
heavy = {file for file in found if file.parts[1] == "heavy"}
for name, values in {"packages": (f"--package {name}" for name in packages(changed) - set(sys.argv[1:])), "tests": found - heavy,
                     "heavy": heavy, "parts": {file.parts[2] for file in heavy}}.items():
    print(f"{name}='{' '.join(sorted(map(str, values)))}'")
