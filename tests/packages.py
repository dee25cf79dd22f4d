"""The packages in out/wheels, which `make wheels` builds."""

from pathlib import Path

import pytest
from conftest import ROOT

# All that the packages are made of.
SOURCES = ("Cargo.lock", "pyproject.toml", "src", "modelDescription", "fmu", "records/src", "report/src", "view/src", "sweep/src", "cli/src", "python")


def package(pattern: str) -> Path:
    """The one that is called so and younger than its source."""
    files = [file for source in SOURCES for file in (ROOT / source, *(ROOT / source).rglob("*"))
             if file.is_file() and file.suffix in ("", ".html", ".js", ".css", ".lock", ".py", ".pyi", ".rs", ".toml")]
    newest = max(file.stat().st_mtime for file in files)
    found = [path for path in (ROOT / "out" / "wheels").glob(pattern) if path.stat().st_mtime >= newest]
    if not found:
        pytest.skip(f"{pattern} is missing in out/wheels, or older than its source: `make wheels` builds it")
    (path,) = found
    return path
