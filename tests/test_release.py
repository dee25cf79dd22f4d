"""What `make release` refuses before it builds anything."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT


@pytest.fixture
def tree(tmp_path):
    """A repository of what a release is judged by."""
    for file in ("Makefile", "Cargo.toml", "CHANGELOG.md"):
        shutil.copy(ROOT / file, tmp_path)
    git(tmp_path, "init", "--quiet")
    commit(tmp_path)
    return tmp_path


def git(tree: Path, *arguments):
    subprocess.run(["git", "-c", "user.name=T", "-c", "user.email=t@example.org", *arguments], cwd=tree, check=True)


def commit(tree: Path):
    git(tree, "add", "--all")
    git(tree, "commit", "--quiet", "--message", "State")


def make(tree: Path, target: str):
    """As if by hand: what says to make that it was called by itself, as in `make release`, is kept from it."""
    environment = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}
    return subprocess.run(["make", "--silent", target], cwd=tree, env=environment, capture_output=True, text=True)


def judged(tree: Path) -> tuple[bool, str]:
    done = make(tree, "releasable")
    return done.returncode == 0, done.stdout


def set_version(tree: Path, version: str):
    manifest = (tree / "Cargo.toml").read_text()
    here = next(line for line in manifest.splitlines() if line.startswith("version = "))
    (tree / "Cargo.toml").write_text(manifest.replace(here, f'version = "{version}"'))


def test_the_change_log_has_the_version_of_this_tree(tree):
    assert judged(tree) == (True, "")


def test_what_is_not_committed(tree):
    (tree / "new.txt").touch()
    may, reason = judged(tree)
    assert not may and "The tree is not clean" in reason and "new.txt" in reason


def test_a_version_that_is_released(tree):
    set_version(tree, "7.8.9")
    (tree / "CHANGELOG.md").write_text("# Changes\n\n## 7.8.9 (2030-01-01)\n\nNew.\n\n## 7.8.8\n\nOld.\n")
    commit(tree)
    assert judged(tree) == (True, "")
    git(tree, "tag", "v7.8.9")
    may, reason = judged(tree)
    assert not may and "Version 7.8.9 of Cargo.toml has a tag, v7.8.9" in reason


def test_a_version_without_changes(tree):
    set_version(tree, "7.8.90")
    (tree / "CHANGELOG.md").write_text("# Changes\n\n## 7.8.9\n\nOld.\n")
    commit(tree)
    may, reason = judged(tree)
    assert not may and 'no section "## 7.8.90"' in reason


def test_what_is_collected(tree):
    """Everything that was built, with its checksums, and the changes of this version alone."""
    set_version(tree, "7.8.9")
    (tree / "CHANGELOG.md").write_text("# Changes\n\n## 7.8.9\n\nNew.\n\n## 7.8.8\n\nOld.\n")
    (tree / "out" / "wheels").mkdir(parents=True)
    (tree / "out" / "FlexibleRocking.fmu").write_text("fmu")
    (tree / "out" / "wheels" / "one.whl").write_text("wheel")
    assert make(tree, "out/release").returncode == 0
    release = tree / "out" / "release"
    assert (release / "CHANGES.md").read_text() == "## 7.8.9\n\nNew.\n\n"
    assert {path.name for path in release.iterdir()} == {"FlexibleRocking.fmu", "one.whl", "CHANGES.md", "SHA256SUMS"}
    subprocess.run(["sha256sum", "--check", "--strict", "SHA256SUMS"], cwd=release, check=True, capture_output=True)
    assert len((release / "SHA256SUMS").read_text().splitlines()) == 3
