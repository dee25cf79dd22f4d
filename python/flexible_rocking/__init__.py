"""FlexibleRocking: the FMU of a structure that rocks on its foundation, ready for fmpy, and those of your own structures."""

import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from importlib.metadata import distribution
from os import PathLike
from pathlib import Path

__all__ = ["export", "fmu"]


def _installed(name: str) -> Path:
    """The file of this package that is called so, wherever the installation has put it."""
    files = distribution("flexible-rocking").files or []
    return next(Path(file.locate()).resolve() for file in files if file.name in (name, f"{name}.exe"))


def fmu() -> Path:
    """The FMU of McManus's bridge pier, for every platform, with a pulse as its ground motion until `record` names another."""
    return _installed("FlexibleRocking.fmu")


def export(
    target: str | PathLike,
    *,
    parameters: Mapping[str, float] | None = None,
    preset: str | None = None,
    record: str | PathLike | Iterable[str | PathLike] = (),
    name: str | None = None,
    fmi: int = 2,
) -> Path:
    """Writes the FMU of a structure to `target` and returns its path.

    `parameters` are m, m0, H, B, f_fc, zeta_fc, r and, where they differ from 0, 1 and 9.81, J0, c_ratio, g, in SI units;
    without them it is a specimen, `preset` ("mcmanus", "evison"). It follows the first `record`, and has the others inside.
    `name` is what hosts call the model, `fmi` the version of the standard, 2 (2.0) or 3 (3.0). What is refused raises ValueError
    with the reason.
    """
    target = Path(target).absolute()
    records = [record] if isinstance(record, (str, PathLike)) else list(record)
    arguments = [_installed("rocking-fmu"), "--quiet", "export", "--library", fmu(), "--output", target, "--fmi", str(fmi)]
    if preset is not None:
        arguments += ["--preset", preset]
    if name is not None:
        arguments += ["--name", name]
    if records:
        arguments += ["--record", *records]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "parameters.toml"
        if parameters is not None:
            lines = (f"{key} = {_number(key, value)!r}\n" for key, value in parameters.items())
            file.write_text("".join(lines), encoding="utf-8")
            arguments += ["--parameters", file]
        done = subprocess.run(arguments, capture_output=True, text=True, encoding="utf-8")
    if done.returncode != 0:
        raise ValueError(done.stderr.strip().removeprefix("error: ").replace(f"parameters in {file}", "parameters"))
    return target


def _number(name: str, value: float) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {value!r}: it is no number") from None
