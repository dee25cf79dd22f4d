"""Headers of programs and libraries for other machines: their system, and the libraries that they need."""

import hashlib
import os
import re
import struct
from pathlib import Path

import lief
from conftest import ROOT

OLDEST_GLIBC = (2, 17)
OLDEST_MACOS = [11, 0, 0]

# Where it was built: this folder, and that of cargo's packages.
PLACES = [ROOT, Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))]

# The parts of glibc, as they were before 2.34 joined them.
LINUX_RUN_TIME = {f"lib{name}.so" for name in ("c", "m", "pthread", "dl")}
LINUX_LOADERS = {"X86_64": "ld-linux-x86-64.so", "AARCH64": "ld-linux-aarch64.so"}
# The C library, and what every Windows has had since version 10.
WINDOWS_RUN_TIME = {"msvcrt.dll", "kernel32.dll", "ntdll.dll", "ws2_32.dll", "userenv.dll", "bcryptprimitives.dll",
                    "api-ms-win-core-synch-l1-2-0.dll"}
MACOS_RUN_TIME = {f"/usr/lib/lib{name}.dylib" for name in ("System.B", "charset.1", "iconv.2")}


def for_linux(file, machine: str):
    """The binary in `file`, for this machine and any glibc since the oldest."""
    binary = lief.ELF.parse(file)
    assert binary.header.machine_type.name == machine
    needed = {name.rpartition(".")[0] for name in binary.libraries}
    assert "libc.so" in needed and needed <= LINUX_RUN_TIME | {LINUX_LOADERS[machine]}
    versions = {auxiliary.name for library in binary.symbols_version_requirement
                for auxiliary in library.get_auxiliary_symbols()}
    assert versions, "no symbol has a version"
    for version in versions:
        kind, _, number = version.partition("_")
        assert kind == "GLIBC" and tuple(map(int, number.split("."))) <= OLDEST_GLIBC, version
    assert not {"RPATH", "RUNPATH"} & {entry.tag.name for entry in binary.dynamic_entries}
    return binary


def for_windows(file, beside=frozenset()):
    """The binary in `file`, for any Windows since version 10 on x86-64 with these libraries beside it."""
    binary = lief.PE.parse(file)
    assert binary.header.machine.name == "AMD64"
    assert {imported.name.lower() for imported in binary.imports} <= WINDOWS_RUN_TIME | beside
    assert binary.header.time_date_stamps == 0, "it tells when it was built"
    return binary


def for_macos(file, cpus: set[str]):
    """The binaries in `file`, one for each of these processors, for any macOS since the oldest."""
    parts = lief.MachO.parse(file)  # owns its binaries: it is to be kept
    assert {binary.header.cpu_type.name for binary in parts} == cpus and len(parts) == len(cpus)
    for binary in parts:
        assert binary.build_version.minos <= OLDEST_MACOS
        needed = {library.name for library in binary.libraries if library.command.name != "ID_DYLIB"}
        assert needed <= MACOS_RUN_TIME
        # Apple silicon runs nothing unsigned; a signature without a signer is enough.
        if binary.header.cpu_type.name == "ARM64":
            content = Path(file).read_bytes()[binary.fat_offset:]
            signature = content[binary.code_signature.data_offset:][:binary.code_signature.data_size]
            assert fits(signature, content)
    return parts


def fits(signature: bytes, content: bytes) -> bool:
    """Whether the hashes in a signature are those of the pages before it."""
    directory = signature[struct.unpack_from(">I", signature, 16)[0]:]  # its first part
    magic, hashes, pages, end, length, kind, page = struct.unpack_from(">I12xI8xIIBBxB", directory)
    assert (magic, length, kind) == (0xFADE0C02, 32, 2), "not a directory of SHA-256"
    computed = [hashlib.sha256(content[start:min(start + 2**page, end)]).digest() for start in range(0, end, 2**page)]
    return directory[hashes:hashes + length * pages] == b"".join(computed)


def tells_no_place(content: bytes):
    """Whether nothing in it tells where it was built, be it in a name that the linker has made of a path."""
    names = [re.sub(r"\W", "_", f"{place}/target/") for place in PLACES]
    return not any(told.encode() in content for told in (*map(str, PLACES), *names))
