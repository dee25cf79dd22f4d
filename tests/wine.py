"""Programs for Windows under wine."""

import os
import shutil
import subprocess

import pytest

MINGW = "x86_64-w64-mingw32"


def environment(folder) -> dict[str, str]:
    """What a program in `folder` is to be run with. Wine 8 has no bcryptprimitives.dll, of which Rust needs one function,
    for the keys of hash maps: one that will do is put there."""
    for program in ("wine", f"{MINGW}-gcc"):
        if shutil.which(program) is None:
            pytest.skip(f"{program} is missing")
    source = folder / "bcryptprimitives.c"
    source.write_text("__declspec(dllexport) int ProcessPrng(unsigned char *data, unsigned long long size) {"
                      "for (unsigned long long i = 0; i < size; i++) data[i] = 37 * i; return 1; }")
    command = [f"{MINGW}-gcc", "-shared", "-nostdlib", "-Wl,--entry=0", "-o", folder / "bcryptprimitives.dll", source]
    subprocess.run(command, check=True)
    return os.environ | {"WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
