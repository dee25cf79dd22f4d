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


@pytest.fixture
def wall(evison, tmp_path) -> Fmu:
    """The FMU of Evison's specimen, unpacked anew: a test may write into its resources."""
    return Fmu(evison.path, tmp_path / "wall")


@pytest.fixture(scope="session")
def evison3(export) -> Path:
    return export("evison", fmi=3)


@pytest.fixture
def wall3(evison3, tmp_path) -> Fmu:
    """The same of FMI 3.0."""
    return Fmu(evison3, tmp_path / "wall3")


# Two floors of which one mode is kept, and dissipators.
BUILDING = """zeta = 0.02
keep = 1
[base]
m0 = 2e4
J0 = 3e4
B = 1.5
r = 0.93
xi_d = 1.0
c_d = 2e4
k_d = 2e7
F_y = 4e4
[[storeys]]
m = 3.5e4
h = 3.5
k = 3e7
[[storeys]]
m = 3.5e4
h = 7.0
k = 3e7
"""


@pytest.fixture(scope="session")
def of_each(evison, evison3, exporter, tmp_path_factory) -> dict[tuple[str, int], Fmu]:
    """The FMUs of one mass and of a building by the name of a force and the version of FMI."""
    folder = tmp_path_factory.mktemp("building")
    (folder / "building.toml").write_text(BUILDING)
    fmus = {("F_t", 2): evison, ("F_t", 3): Fmu(evison3, folder / "wall3")}
    for fmi in (2, 3):
        path = folder / f"building{fmi}.fmu"
        subprocess.run([exporter, "export", "--fmi", str(fmi), "--parameters", folder / "building.toml", "-o", path], check=True)
        fmus["F_t[1]", fmi] = Fmu(path, folder / f"building{fmi}")
    return fmus


@pytest.fixture(params=[(force, fmi, kind) for force in ("F_t", "F_t[1]") for fmi in (2, 3) for kind in ("CoSimulation", "ModelExchange")],
                ids=lambda of: " ".join(map(str, of)))
def interface(request, of_each, tmp_path):
    """What makes instances of one of the interfaces, for the name of a force, and initial values with a record."""
    force, fmi, kind = request.param
    (tmp_path / "quake.csv").write_text("t (s),a (m/s2)\n0,0.5\n0.1,-3\n0.2,2\n")
    return lambda: of_each[force, fmi].instance(kind), force, dict(record=str(tmp_path / "quake.csv"))
