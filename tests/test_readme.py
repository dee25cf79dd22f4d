"""README's first script and commands do what they say; the script of the wheel is in test_wheel.py."""

import re
import subprocess
import sys

import pytest
from conftest import ROOT
from first_run import RECORD


def test_first_script(mcmanus, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mcmanus.fmu").symlink_to(mcmanus.path)
    (tmp_path / "out" / RECORD.name).symlink_to(RECORD)
    script = re.search(r"## A first script\n\n```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
    assert len([line for line in script.splitlines() if line]) <= 5
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, capture_output=True, text=True)
    assert done.stdout.endswith(" 6.82 mm\n"), done.stdout


def test_commands_run_as_they_are_printed(exporter, tmp_path):
    """Where `make demo` leaves the records."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / RECORD.name).symlink_to(RECORD)
    (tmp_path / "target").mkdir()
    (tmp_path / "target" / "release").symlink_to(exporter.parent)
    commands = re.findall(r"^\$? ?(target/release/rocking-fmu .*)$", (ROOT / "README.md").read_text(), re.MULTILINE)
    assert len(commands) >= 2
    for command in commands:
        subprocess.run(command, shell=True, cwd=tmp_path, check=True, capture_output=True)


@pytest.mark.parametrize("preset, version", [("mcmanus", "2"), ("evison", "3")])
def test_the_demo_has_the_fmu_of_the_command_line(exporter, tmp_path, preset, version):
    library = exporter.with_name("deps") / "libFlexibleRocking.so"
    program, demo = tmp_path / "program.fmu", tmp_path / "demo.fmu"
    command = [exporter, "export", "--preset", preset, "--fmi", version, "--library", library, "-o", program]
    subprocess.run(command, check=True)
    subprocess.run([exporter.with_name("fmu-export"), library, preset, version, demo], check=True)
    assert demo.read_bytes() == program.read_bytes()
