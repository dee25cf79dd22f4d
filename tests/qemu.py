"""Programs for Linux on ARM64 under qemu."""

import shutil
from pathlib import Path

import pytest

SYSTEM = Path("/usr/aarch64-linux-gnu")


def command() -> list:
    """The command that runs such a program."""
    if shutil.which("qemu-aarch64") is None or not (SYSTEM / "lib/ld-linux-aarch64.so.1").exists():
        pytest.skip("qemu-aarch64 or the C library for it is missing: packages qemu-user, libc6-arm64-cross")
    return ["qemu-aarch64", "-L", SYSTEM]
