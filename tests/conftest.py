"""The FMUs under test: exported once per run from the release build."""

import os
import subprocess
from pathlib import Path

import pacoima
import pages
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
    """Exports the FMU of a preset, with a record inside if there is one, to a new file and returns its path."""

    def run(preset: str, record: Path | None = None, name: str | None = None, fmi: int = 2) -> Path:
        path = tmp_path_factory.mktemp("export") / f"{name or preset}.fmu"
        inside = ["--record", record] if record else []
        named = ["--name", name] if name else []
        subprocess.run([exporter, "export", "--fmi", str(fmi), "--preset", preset, *inside, *named, "-o", path], check=True)
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


@pytest.fixture(scope="session")
def pacoima_record(tmp_path_factory) -> Path:
    """Pacoima Dam as scaled for McManus's shake table, as a CSV record."""
    path = tmp_path_factory.mktemp("record") / "pacoima.csv"
    pacoima.write_record(path)
    return path


@pytest.fixture(scope="session")
def shaken(export, pacoima_record, tmp_path_factory) -> dict[str, Fmu]:
    """Both specimens' FMUs with that record inside."""
    return {preset: Fmu(export(preset, pacoima_record), tmp_path_factory.mktemp("shaken"))
            for preset in ("mcmanus", "evison")}


@pytest.fixture(scope="session")
def exact(exporter, pacoima_record):
    """theta, u, a_t of a specimen under that record at the communication points of a host with a given step."""

    def outputs(step: float, preset: str = "mcmanus"):
        return pacoima.engine(exporter, preset, pacoima_record)[:: round(step / min(pacoima.STEPS))]

    return outputs


@pytest.fixture
def check_page(exporter, tmp_path):
    """Runs the blocks of a page, which must print what follows them."""

    def check(name: str, languages=pages.LANGUAGES):
        text = (ROOT / name).read_text(encoding="utf-8")
        folder = pages.prepare(tmp_path / "page", exporter)
        assert pages.rerun(text, exporter, folder, languages) == text, "run `make pages`"

    return check
