"""The FMUs under test: exported once per run from the release build."""

import functools
import itertools
import os
from pathlib import Path

import pacoima
import pages
import pytest
from frames import Frame, Ties, toml
from host import Fmu, output, write

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def exporter() -> Path:
    path = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release" / "rocking-fmu"
    assert path.is_file(), f"{path} is not there: run `cargo build --release` first"
    return path


@pytest.fixture(scope="session")
def export(exporter, tmp_path_factory):
    """Exports the FMU of a preset, with a record inside if there is one, or of what other `options` say. The same is made once."""

    @functools.cache
    def run(preset: str | None, record: Path | None = None, *options, fmi: int = 2) -> Fmu:
        path = tmp_path_factory.mktemp("export") / "pier.fmu"
        chosen = {"--preset": preset, "--record": record}
        chosen = [text for option, value in chosen.items() if value for text in (option, value)]
        output(exporter, "--quiet", "export", "--fmi", fmi, *chosen, *options, "-o", path)
        return Fmu(path)

    return run


@pytest.fixture(scope="session")
def mcmanus(export) -> Fmu:
    return export("mcmanus")


@pytest.fixture(scope="session")
def evison(export) -> Fmu:
    return export("evison")


@pytest.fixture(scope="session")
def pacoima_record(tmp_path_factory) -> Path:
    """Pacoima Dam as scaled for McManus's shake table, as a CSV record."""
    return write(tmp_path_factory.mktemp("record") / "pacoima.csv", "m/s2", pacoima.TIME, pacoima.A_G)


@pytest.fixture(scope="session")
def shaken(export, pacoima_record) -> dict[str, Fmu]:
    """Both specimens' FMUs with that record inside."""
    return {preset: export(preset, pacoima_record) for preset in ("mcmanus", "evison")}


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
def wall(evison) -> Fmu:
    """The FMU of Evison's specimen, unpacked anew: a test may write into its resources."""
    return Fmu(evison.path)


@pytest.fixture
def wall3(export) -> Fmu:
    """The same of FMI 3.0."""
    return Fmu(export("evison", fmi=3).path)


# Two floors of which one mode is kept, and dissipators.
BUILDING = "keep = 1\n" + toml(Frame((3.5e4, 3.5e4), (3.5, 7.0), (3e7, 3e7), m0=2e4, J0=3e4, B=1.5, r=0.93, zeta=0.02),
                               Ties(xi_d=1.0, c_d=2e4, k_d=2e7, F_y=4e4))


@pytest.fixture(scope="session")
def of_each(export, tmp_path_factory):
    """The FMU of one mass, or of a building, by the name of a force and the version of FMI."""
    file = tmp_path_factory.mktemp("building") / "building.toml"
    file.write_text(BUILDING)
    return lambda force, fmi: export("evison", fmi=fmi) if force == "F_t" else export(None, None, "--parameters", file, fmi=fmi)


@pytest.fixture(params=itertools.product(("F_t", "F_t[1]"), (2, 3), ("CoSimulation", "ModelExchange")), ids=lambda of: " ".join(map(str, of)))
def interface(request, of_each, tmp_path):
    """What makes instances of one of the interfaces, for the name of a force, and initial values with a record."""
    force, fmi, kind = request.param
    (tmp_path / "quake.csv").write_text("t (s),a (m/s2)\n0,0.5\n0.1,-3\n0.2,2\n")
    return lambda: of_each(force, fmi).instance(kind), force, dict(record=str(tmp_path / "quake.csv"))
