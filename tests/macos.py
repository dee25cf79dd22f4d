"""A library for macOS in an emulated processor: placed and bound as macOS's own loader would, with the few functions of the
system that a run calls, which are written here. One that is not here is an error."""

import math
import os
import struct

import lief
import unicorn
from unicorn import arm64_const as arm
from unicorn import x86_const as x86

PAGE = 0x4000
# Where what is, each far from the next, and how much of it.
LIBRARY, STACK, HEAP, SYSTEM = (n << 32 for n in (1, 2, 3, 4))
STACK_SIZE, HEAP_SIZE, SYSTEM_SIZE = 8 << 20, 64 << 20, PAGE

FAILED = 2**64 - 1
CLOSE_ON_EXEC = 0x1000000  # and for reading alone, which is 0


class X86:
    """How functions are called on x86-64."""

    engine = unicorn.UC_ARCH_X86, unicorn.UC_MODE_64
    integers = [x86.UC_X86_REG_RDI, x86.UC_X86_REG_RSI, x86.UC_X86_REG_RDX, x86.UC_X86_REG_RCX, x86.UC_X86_REG_R8,
                x86.UC_X86_REG_R9]
    reals = [x86.UC_X86_REG_XMM0, x86.UC_X86_REG_XMM1, x86.UC_X86_REG_XMM2]
    result, stack = x86.UC_X86_REG_RAX, x86.UC_X86_REG_RSP
    return_instruction = b"\xc3"


class Arm:
    """How functions are called on ARM64."""

    engine = unicorn.UC_ARCH_ARM64, unicorn.UC_MODE_ARM
    integers = [getattr(arm, f"UC_ARM64_REG_X{n}") for n in range(8)]
    reals = [arm.UC_ARM64_REG_D0, arm.UC_ARM64_REG_D1, arm.UC_ARM64_REG_D2]
    result, stack = arm.UC_ARM64_REG_X0, arm.UC_ARM64_REG_SP
    return_instruction = struct.pack("<I", 0xD65F03C0)


class Library:
    """The part for one processor of the library in a file."""

    def __init__(self, path, cpu: str):
        self._parts = lief.MachO.parse(path)  # owns its binaries
        (self._binary,) = (binary for binary in self._parts if binary.header.cpu_type.name == cpu)
        self._cpu = {"X86_64": X86, "ARM64": Arm}[cpu]
        self._emulator = unicorn.Uc(*self._cpu.engine)
        if self._cpu is Arm:
            self._emulator.ctl_set_cpu_model(arm.UC_CPU_ARM64_MAX)
            self._emulator.reg_write(arm.UC_ARM64_REG_CPACR_EL1, 3 << 20)  # floating point is not trapped
        size = max(segment.virtual_address + segment.virtual_size for segment in self._binary.segments)
        for start, length in ((LIBRARY, -(-size // PAGE) * PAGE), (STACK, STACK_SIZE), (HEAP, HEAP_SIZE), (SYSTEM, SYSTEM_SIZE)):
            self._emulator.mem_map(start, length)
        self._heap_end, self._sizes = HEAP, {}
        self._system, self._failure = [], None
        self._emulator.hook_add(unicorn.UC_HOOK_CODE, self._of_the_system, begin=SYSTEM, end=SYSTEM + SYSTEM_SIZE)
        self._errno = self.put("i", 0)
        self._load()
        self._exported = {symbol.name: LIBRARY + symbol.value for symbol in self._binary.exported_symbols}

    def _load(self):
        for segment in self._binary.segments:
            self._emulator.mem_write(LIBRARY + segment.virtual_address, bytes(segment.content))
        for place in (LIBRARY + relocation.address for relocation in self._binary.relocations):
            self.set(place, "Q", LIBRARY + self.get(place, "Q")[0])
        for binding in self._binary.bindings:
            self.set(LIBRARY + binding.address, "Q", self._address(binding.symbol.name))
        sections = {section.name: section for section in self._binary.sections}
        data, zeros = sections["__thread_data"], sections["__thread_bss"]
        self._thread = self.malloc(zeros.virtual_address + zeros.size - data.virtual_address)
        self._emulator.mem_write(self._thread, bytes(data.content))

    def call(self, function: str, *arguments: int | float) -> int:
        """What a function of the library returns."""
        integers = [argument for argument in arguments if not isinstance(argument, float)]
        for register, value in zip(self._cpu.integers, integers):
            self._emulator.reg_write(register, value)
        for register, value in zip(self._cpu.reals, (argument for argument in arguments if isinstance(argument, float))):
            self._set_real(register, value)
        end, stack = self._address("end"), STACK + STACK_SIZE // 2
        if self._cpu is Arm:
            self._emulator.reg_write(arm.UC_ARM64_REG_LR, end)
        else:  # where to return to is on the stack, and above it what has no register
            stack -= 8
            rest = integers[len(self._cpu.integers):]
            self.set(stack, f"{1 + len(rest)}Q", end, *rest)
        self._emulator.reg_write(self._cpu.stack, stack)
        self._emulator.emu_start(self._exported[f"_{function}"], 0)
        if self._failure:
            raise self._failure
        return self._emulator.reg_read(self._cpu.result)

    def put(self, layout: str, *values) -> int:
        """The address of these values, laid out as by `struct`."""
        address = self.malloc(struct.calcsize(f"<{layout}"))
        self.set(address, layout, *values)
        return address

    def text(self, text: str) -> int:
        """The address of a text for C."""
        return self.put(f"{len(text.encode()) + 1}s", text.encode())

    def set(self, address: int, layout: str, *values):
        """Writes values, laid out as by `struct`."""
        self._emulator.mem_write(address, struct.pack(f"<{layout}", *values))

    def get(self, address: int, layout: str) -> tuple:
        """The values at an address, laid out as by `struct`."""
        return struct.unpack(f"<{layout}", self._emulator.mem_read(address, struct.calcsize(f"<{layout}")))

    def _set_real(self, register: int, value: float):
        self._emulator.reg_write(register, struct.unpack("<Q", struct.pack("<d", value))[0])

    def _address(self, name: str) -> int:
        """Where a function of the system is called: at an instruction that returns, before which it is done."""
        if name not in self._system:
            self._emulator.mem_write(SYSTEM + 16 * len(self._system), self._cpu.return_instruction)
            self._system.append(name)
        return SYSTEM + 16 * self._system.index(name)

    def _of_the_system(self, _emulator, address: int, _size, _data):
        name = self._system[(address - SYSTEM) // 16]
        try:
            function = getattr(self, name.lstrip("_").partition("$")[0])
            arguments = self._cpu.integers[: function.__func__.__code__.co_argcount - 1]
            result = function(*map(self._emulator.reg_read, arguments))
            if result is not None:
                self._emulator.reg_write(self._cpu.result, result)
        except OSError as error:
            self.set(self._errno, "i", error.errno)
            self._emulator.reg_write(self._cpu.result, FAILED)
        except Exception as failure:
            self._failure = failure
            self._emulator.emu_stop()

    # What follows is called by the library.

    def end(self):
        self._emulator.emu_stop()

    def malloc(self, size):
        start = -(-self._heap_end // 16) * 16  # never used again
        self._heap_end, self._sizes[start] = start + size, size
        return start

    def realloc(self, address, size):
        new = self.malloc(size)
        self._emulator.mem_write(new, bytes(self._emulator.mem_read(address, min(size, self._sizes[address]))))
        return new

    def free(self, address):
        del self._sizes[address]  # what was not had, or was given back, is an error

    def bzero(self, address, size):
        self._emulator.mem_write(address, bytes(size))

    def strnlen(self, address, size):
        return next((n for n in range(size) if self.get(address + n, "c") == (b"\0",)), size)

    def tlv_bootstrap(self, variable):
        return self._thread + self.get(variable + 16, "Q")[0]

    def CCRandomGenerateBytes(self, address, size):
        self._emulator.mem_write(address, bytes(range(size)))
        return 0

    def sincos_stret(self):
        angle = struct.unpack("<d", struct.pack("<Q", self._emulator.reg_read(self._cpu.reals[0]) & FAILED))[0]
        self._set_real(self._cpu.reals[0], math.sin(angle))
        self._set_real(self._cpu.reals[1], math.cos(angle))

    def _nothing_to_do(self):
        return 0

    # There is one thread.
    pthread_mutexattr_init = pthread_mutexattr_settype = pthread_mutexattr_destroy = _nothing_to_do
    pthread_mutex_init = pthread_mutex_trylock = pthread_mutex_lock = pthread_mutex_unlock = _nothing_to_do
    pthread_mutex_destroy = _nothing_to_do

    def error(self):
        return self._errno

    def open(self, path, flags):
        assert flags == CLOSE_ON_EXEC
        return os.open(self._path(path), os.O_RDONLY)

    def read(self, file, address, size):
        content = os.read(file, size)
        self._emulator.mem_write(address, content)
        return len(content)

    def close(self, file):
        os.close(file)
        return 0

    def realpath(self, path, place):
        assert place == 0
        found = os.path.realpath(self._path(path), strict=True)
        return self.put(f"{len(found) + 1}s", found)

    def stat(self, path, status):
        return self.fstat(self._path(path), status)

    def fstat(self, file, status):
        found = os.stat(file)
        self.set(status, "4xH90xq", found.st_mode, found.st_size)
        return 0

    def _path(self, address):
        return bytes(self._emulator.mem_read(address, self.strnlen(address, PAGE)))
