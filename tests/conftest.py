"""The FMUs under test: exported once per run from the release build."""

import os
import subprocess
from pathlib import Path

import pytest
from host import Fmu

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def exporter() -> Path:
    """The exporter's executable."""
    path = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release" / "rocking-fmu"
    assert path.is_file(), f"{path} is not there: run `cargo build --release` first"
    return path


@pytest.fixture(scope="session")
def export(exporter, tmp_path_factory):
    """Exports the FMU of a preset to a new file and returns its path."""

    def run(preset: str) -> Path:
        path = tmp_path_factory.mktemp("export") / f"{preset}.fmu"
        subprocess.run([exporter, "export", "--preset", preset, "-o", path], check=True)
        return path

    return run


@pytest.fixture(scope="session")
def mcmanus(export, tmp_path_factory) -> Fmu:
    """The FMU of McManus's specimen."""
    return Fmu(export("mcmanus"), tmp_path_factory.mktemp("mcmanus"))


@pytest.fixture(scope="session")
def evison(export, tmp_path_factory) -> Fmu:
    """The FMU of Evison's specimen."""
    return Fmu(export("evison"), tmp_path_factory.mktemp("evison"))
