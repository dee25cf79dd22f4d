"""The build backend: maturin, after the command line has written the FMU that the wheel carries."""

import subprocess
from pathlib import Path

import maturin
from maturin import get_requires_for_build_editable, get_requires_for_build_sdist, get_requires_for_build_wheel  # noqa: F401

FMU = Path("out/wheel/data/share/flexible-rocking/FlexibleRocking.fmu")


def _after_export(hook):
    def build(*arguments):
        if not Path("PKG-INFO").exists():  # the package of the source has the FMU, for all platforms
            FMU.parent.mkdir(parents=True, exist_ok=True)
            export = ["export", "--record", "examples/pulse.csv", "--output", FMU]
            subprocess.run(["cargo", "run", "--release", "--locked", "--package", "rocking-cli", "--", *export], check=True)
        return hook(*arguments)

    return build


prepare_metadata_for_build_wheel = prepare_metadata_for_build_editable = _after_export(maturin.prepare_metadata_for_build_wheel)
build_wheel, build_editable, build_sdist = map(_after_export, (maturin.build_wheel, maturin.build_editable, maturin.build_sdist))
