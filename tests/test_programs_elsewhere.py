"""The programs in the wheels for Windows and for Linux on ARM64, as pip lays them out, under wine and qemu: they write what this
machine's writes."""

import json
import shutil
import subprocess
import zipfile
from pathlib import Path

import pandas as pd
import pytest
import qemu
from conftest import ROOT
from packages import package
from pacoima import write_record
from wine import environment

pytestmark = pytest.mark.heavy

SWEEP = """records = ["records/*.csv"]
scale = { from = 0.5, to = 1.5, count = 3 }
structures = [{ name = "specimen", preset = "mcmanus" }, { name = "wall", preset = "evison" }]
"""


def installed(pattern: str, folder) -> Path:
    """The program of the wheel that is called so, beside its archive."""
    with zipfile.ZipFile(package(pattern)) as content:
        content.extractall(folder / "wheel")
    (data,) = (folder / "wheel").glob("*.data")
    shutil.move(data / "scripts", folder / "bin")
    shutil.move(data / "data" / "share", folder / "share")
    (program,) = (folder / "bin").iterdir()
    return program


@pytest.fixture(scope="module")
def windows(tmp_path_factory):
    """Runs the program for Windows in a folder."""
    program = installed("*-win_amd64.whl", tmp_path_factory.mktemp("windows"))
    variables = environment(program.parent)
    return lambda *arguments, cwd: subprocess.run(["wine", program, *arguments], cwd=cwd, env=variables, capture_output=True,
                                                  text=True)


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    """Runs the program for ARM64 in a folder."""
    command = qemu.command()
    program = installed("*_aarch64.whl", tmp_path_factory.mktemp("arm"))
    program.chmod(0o755)
    return lambda *arguments, cwd: subprocess.run([*command, program, *arguments], cwd=cwd, capture_output=True, text=True)


@pytest.fixture(params=["windows", "arm"])
def there(request):
    """Runs one of them in a folder."""
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="module")
def linux(exporter):
    """Runs the program for this machine in a folder."""
    return lambda *arguments, cwd: subprocess.run([exporter, *arguments], cwd=cwd, capture_output=True, text=True)


@pytest.fixture
def both(there, linux, tmp_path):
    """Runs a command on both, each in a folder of its own with the record pacoima.csv, and returns folder and output."""
    folders = [tmp_path / "there", tmp_path / "here"]
    for folder in folders:
        folder.mkdir()
        write_record(folder / "pacoima.csv")

    def run(*arguments):
        done = [program(*arguments, cwd=folder) for program, folder in zip((there, linux), folders)]
        for one in done:
            assert one.returncode == 0, one.stderr
        return list(zip(folders, (one.stdout for one in done)))

    return run


def same_bytes(both, *names):
    (there, _), (here, _) = both
    for name in names:
        assert (there / name).read_bytes() == (here / name).read_bytes() != b"", name
    assert not list(there.glob(".rocking-fmu-*"))


def test_simulate(both):
    """The histories, transitions and peaks of Pacoima Dam."""
    runs = both("simulate", "--record", "pacoima.csv", "--format", "json", "-o", "response.csv", "--events", "events.csv")
    there, here = (json.loads(printed) for _, printed in runs)
    assert there.keys() == here.keys() and there["transitions"] == here["transitions"] > 20
    for peak, expected in zip(there["peaks"], here["peaks"], strict=True):
        assert peak["name"] == expected["name"]
        assert [peak["peak"], peak["time"]] == pytest.approx([expected["peak"], expected["time"]], rel=1e-12, abs=0)
    for name in ("response.csv", "events.csv"):
        there, here = (pd.read_csv(folder / name) for folder, _ in runs)
        assert len(here) > 20 and list(there) == list(here)
        numbers, words = here.select_dtypes("number"), here.select_dtypes(exclude="number")
        assert there[words.columns].equals(words)
        assert ((there[numbers.columns] - numbers).abs().max() <= 1e-12 * numbers.abs().max()).all()


def test_pictures_and_page(both):
    runs = both("simulate", "--record", "pacoima.csv", "--picture", "response.svg", "-o", "response.csv")
    both("pushover", "--picture", "pushover.png")
    both("view", "--record", "pacoima.csv", "-o", "view.html")
    same_bytes(runs, "response.svg", "pushover.png", "view.html")


def test_export(there, linux, tmp_path):
    """With the libraries of the wheel, as pip has installed them."""
    write_record(tmp_path / "pacoima.csv")
    arguments = ("export", "--preset", "evison", "--record", "pacoima.csv", "--name", "Wall", "-o")
    for run, *end in ((there, "there.fmu"), (linux, "here.fmu", "--library", ROOT / "out" / "FlexibleRocking.fmu")):
        done = run(*arguments, *end, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "there.fmu").read_bytes() == (tmp_path / "here.fmu").read_bytes()


def test_sweep(both, linux):
    """A sweep of one system goes on on the other: its runs are known."""
    for folder, _ in both("describe"):
        (folder / "records").mkdir()
        shutil.move(folder / "pacoima.csv", folder / "records")
        (folder / "sweep.toml").write_text(SWEEP)
    runs = both("sweep", "sweep.toml", "-o", "runs.csv")
    (there, printed), (here, expected) = runs
    assert printed == expected
    assert sorted((there / "runs.csv").read_text().splitlines()) == sorted((here / "runs.csv").read_text().splitlines())
    before = (there / "runs.csv").read_bytes()
    assert linux("sweep", "sweep.toml", "-o", "runs.csv", cwd=there).returncode == 0
    assert (there / "runs.csv").read_bytes() == before
