"""The build backend: maturin, after cargo has built the program, and the program the FMU, which the wheel carries."""

import json
import shutil
import subprocess
from pathlib import Path

import maturin
from maturin import get_requires_for_build_editable, get_requires_for_build_sdist, get_requires_for_build_wheel  # noqa: F401

BUILD = ["cargo", "build", "--release", "--locked", "--package", "rocking-cli", "--package", "flexible-rocking-fmu"]
WORKSPACE = Path("Cargo.toml")
SCRIPTS = Path("out/wheel/scripts")
FMU = Path("out/wheel/data/share/flexible-rocking/FlexibleRocking.fmu")


def _after_program(hook):
    def build(*arguments):
        # maturin writes a package of the source whose workspace has the dependencies of the module alone
        if '"cli"' not in (manifest := WORKSPACE.read_text()):
            WORKSPACE.write_text(manifest.replace("members = [", 'members = ["cli", ', 1))
        messages = subprocess.run([*BUILD, "--message-format", "json-render-diagnostics"], check=True, stdout=subprocess.PIPE).stdout
        (program,) = filter(None, (json.loads(message).get("executable") for message in messages.splitlines()))
        SCRIPTS.mkdir(parents=True, exist_ok=True)
        shutil.copy(program, SCRIPTS)
        if not Path("PKG-INFO").exists():  # the package of the source has the FMU, for all platforms
            FMU.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run([program, "export", "--record", "examples/pulse.csv", "--output", FMU], check=True)
        return hook(*arguments)

    return build


prepare_metadata_for_build_wheel = prepare_metadata_for_build_editable = _after_program(maturin.prepare_metadata_for_build_wheel)
build_wheel, build_editable, build_sdist = map(_after_program, (maturin.build_wheel, maturin.build_editable, maturin.build_sdist))
