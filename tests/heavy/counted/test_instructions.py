"""Instructions of runs, sweeps and steps of a host, counted by valgrind, beside `instructions.toml`. WRITE_COUNTS=1 writes that anew.

Counts depend on the compiler and its profile, and not on the processor if it has AVX2, because valgrind offers no more."""

import os
import re
import shutil
import tomllib
from pathlib import Path

import pytest
from frames import FRAMES, toml
from host import output

pytest_plugins = ["test_hosts_library"]  # for its fixtures
COUNTS = Path(__file__).with_name("instructions.toml")
CALLS = ("fmi2DoStep", "fmi2GetReal", "fmi2SetReal", "fmi2SetRealInputDerivatives")
COMMANDS = {"run_of_a_pier": ["simulate", "--preset", "mcmanus", "--record", "record.csv"],
            "run_of_a_frame": ["simulate", "--parameters", "frame.toml", "--record", "record.csv"],
            "sweep_of_a_pier": ["sweep", "--threads", 1, "piers.toml"],
            "sweep_of_a_frame": ["sweep", "--threads", 1, "frames.toml"]}
PLAN = f"records = ['record.csv']\nscale = {[i / 8 for i in range(1, 17)]}\n[[structures]]\nname = 'counted'\n"


def test_ground_that_holds_takes_5_percent_more_instructions_at_most_if_it_might_slide_or_yield(exporter, pacoima_record, tmp_path):
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is missing and cannot be installed")
    counts = []
    for more in ("", "mu_c = 2\nfs = 100\n"):
        (tmp_path / "frame.toml").write_text(toml(FRAMES["frame"], ground=f"f_v = 5\nzeta_v = 0.3\n{more}"))
        valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", f"--log-file={tmp_path / 'log'}"]
        output(*valgrind, exporter, "--quiet", "simulate", "--parameters", tmp_path / "frame.toml", "--record", pacoima_record)
        counts.append(int(re.search(r"Collected : (\d+)", (tmp_path / "log").read_text())[1]))
    assert counts[1] <= 1.05 * counts[0], f"{counts[1] / counts[0] - 1:+.1%}"


def test_nothing_takes_5_percent_more_instructions(exporter, pacoima_record, run, linux_host, tmp_path):
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is missing and cannot be installed")
    shutil.copy(pacoima_record, tmp_path / "record.csv")
    (tmp_path / "frame.toml").write_text(toml(FRAMES["frame"]))
    (tmp_path / "piers.toml").write_text(PLAN + "preset = 'mcmanus'\nvary.r = [0.9, 0.95]\n")
    (tmp_path / "frames.toml").write_text(PLAN + "file = 'frame.toml'\n")
    log = tmp_path / "valgrind.log"
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", f"--log-file={log}"]
    count = lambda: int(re.search(r"Collected : (\d+)", log.read_text())[1])
    found = {}
    for name, command in COMMANDS.items():
        output(*valgrind, exporter, "--quiet", *command, cwd=tmp_path)
        found[name] = count()
    library = exporter.with_name("libFlexibleRocking.so")  # the exporter packs one of another profile if there is one
    run(*valgrind, *(f"--toggle-collect={call}" for call in CALLS), linux_host, library=library)
    found["steps_of_a_host"] = count()
    compiler = output("rustc", "--version").strip()
    if "WRITE_COUNTS" in os.environ:
        COUNTS.write_text(f'compiler = "{compiler}"\n' + "".join(f"{name} = {of}\n" for name, of in found.items()))
    stated = tomllib.loads(COUNTS.read_text())
    assert compiler == stated.pop("compiler"), "another compiler has other counts: write them anew with WRITE_COUNTS=1"
    assert all(of <= 1.05 * stated[name] for name, of in found.items()), {name: f"{of / stated[name] - 1:+.1%}" for name, of in found.items()}
