from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Final, Literal, TypedDict, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from ._ground import Ground
from ._results import Advice, Estimate, Peak, Profile, Response, Transitions, Worst

__version__: str

_Array = NDArray[np.float64]
_Path = str | PathLike[str]
_Detail = Literal["auto", "nonlinear", "linear", "modal", "rigid", "fixed_base"]
_Unit = Literal["g", "m/s2", "cm/s2", "gal", "mm/s2", "in/s2", "ft/s2", "mg", "%g"]
_Shape = Literal["half_sine", "sine", "cosine", "ricker", "antisymmetric_ricker", "mavroeidis_papageorgiou"]
_Criterion = Literal["theta", "u", "a_t", "theta_history", "u_history", "a_t_history"]

class _Numbers(TypedDict, total=False):
    m: float
    m0: float
    H: float
    B: float
    J0: float
    f_fc: float
    zeta_fc: float
    c_ratio: float
    r: float
    g: float
    P_0: float
    k_t: float
    xi_d: float
    c_d: float
    k_d: float
    F_y: float
    period_fc: float
    weight: float
    weight0: float
    width: float
    alpha_cg: float
    p_l: float
    units: Literal["N, m, kg", "kN, m, t"]
    ground: Ground

class _Rayleigh(TypedDict):
    f: tuple[float, float]
    zeta: float

class _InitialValues(TypedDict, total=False):
    theta_0: float
    theta_dot_0: float
    u_0: ArrayLike
    u_dot_0: ArrayLike

@final
class Structure:
    @overload
    def __new__(cls, *, preset: Literal["mcmanus", "evison"] | None = None, **numbers: Unpack[_Numbers]) -> Structure: ...
    @overload
    def __new__(cls, *, storeys: Sequence[Mapping[str, float]], zeta: ArrayLike | _Rayleigh, **base: float | str | Ground) -> Structure: ...
    @staticmethod
    def from_matrices(
        masses: ArrayLike, heights: ArrayLike, K: ArrayLike, *, zeta: ArrayLike | _Rayleigh, **base: float | str | Ground
    ) -> Structure: ...
    @staticmethod
    def from_modes(
        *,
        mass: ArrayLike,
        zeta: ArrayLike | _Rayleigh,
        f: ArrayLike | None = None,
        period: ArrayLike | None = None,
        height: ArrayLike | None = None,
        moment: ArrayLike | None = None,
        m_s: float | None = None,
        S_1: float | None = None,
        I_2: float | None = None,
        J_P: float | None = None,
        masses: ArrayLike | None = None,
        heights: ArrayLike | None = None,
        shapes: ArrayLike | None = None,
        **base: float | str | Ground,
    ) -> Structure: ...
    @overload
    def replace(self, **numbers: Unpack[_Numbers]) -> Structure: ...
    @overload
    def replace(self, **numbers: Any) -> Structure: ...
    parameters: Final[dict[str, Any]]
    derived: Final[dict[str, float]]
    mode_table: Final[dict[str, _Array]]
    def effective_frequency(self, theta: float) -> float: ...
    def pushover(self, points: int = 100) -> dict[str, _Array]: ...
    def restoring(self, theta: float) -> dict[str, _Array]: ...
    def modes(self, response: Response) -> dict[str, _Array]: ...
    def __getattr__(self, name: str) -> float: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object) -> bool: ...

@final
class Record:
    LAYOUTS: str
    def __new__(
        cls,
        time: Any,  # numbers, or a Trace or Stream of ObsPy
        a_g: ArrayLike | None = None,
        a_v: ArrayLike | None = None,
        *,
        unit: _Unit | None = None,
        time_scale: float = 1.0,
        scale: float = 1.0,
        title: str | None = None,
    ) -> Record: ...
    @staticmethod
    def read(
        file: _Path,
        *,
        vertical: _Path | None = None,
        unit: _Unit | None = None,
        dt: float | None = None,
        column: int | str | None = None,
        vertical_column: int | str | None = None,
        ignore_npts: bool = False,
        time_scale: float = 1.0,
        scale: float = 1.0,
    ) -> Record: ...
    time: Final[_Array]
    a_g: Final[_Array]
    a_v: Final[_Array | None]
    F_t: Final[_Array | None]
    title: Final[str]
    pga: Final[float]
    pgv: Final[float]
    duration: Final[float]
    def with_force(self, time: ArrayLike, F_t: ArrayLike) -> Record: ...
    def scaled(self, scale: float = 1.0, *, time_scale: float = 1.0) -> Record: ...
    def spectrum(self, periods: ArrayLike, zeta: float = 0.05) -> _Array: ...
    def write(self, file: _Path, *, vertical: _Path | None = None) -> None: ...
    def __len__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object) -> bool: ...

@final
class Run:
    structure: Final[Structure]
    record: Final[Record]
    detail: Final[str]
    tolerance: Final[float]
    peaks: Final[dict[str, Peak]]
    overturned: Final[bool | None]
    ending: Final[str]
    start: Final[float]
    end: Final[float]
    fall: Final[float | None]
    transitions: Final[Transitions]
    steps: Final[int]
    evaluations: Final[int]
    validity: Final[dict[str, Worst]]
    def validity_within(
        self,
        *,
        friction: float | None = None,
        tension: float | None = None,
        edge_load: float | None = None,
        energy_gain: float | None = None,
    ) -> dict[str, Worst]: ...
    def at(self, times: ArrayLike) -> Response: ...
    profile: Final[Profile]
    def spectrum(self, floor: int, periods: ArrayLike | None = None, zeta: float = 0.05) -> dict[str, _Array]: ...
    def plot(self, kind: Literal["history", "profile"] = "history") -> Any: ...
    def page(self) -> str: ...

@final
class Curve:
    def __new__(
        cls, median: float, dispersion: float, known: tuple[list[list[float]], float] | None = None
    ) -> Curve: ...
    median: Final[float]
    dispersion: Final[float]
    median_range: Final[tuple[float, float] | None]
    def probability(self, intensities: ArrayLike) -> _Array: ...
    def band(self, intensities: ArrayLike) -> _Array | None: ...

def simulate(
    structure: Structure,
    record: Record | None = None,
    *,
    duration: float | None = None,
    detail: _Detail = "auto",
    tolerance: float = 1e-9,
    **initial: Unpack[_InitialValues],
) -> Run: ...
def advise(
    structure: Structure,
    record: Record,
    *,
    within: float = 0.05,
    of: _Criterion | Sequence[_Criterion] | None = None,
    duration: float | None = None,
    **initial: Unpack[_InitialValues],
) -> Advice: ...
def estimate(structure: Structure, record: Record | None = None, *, amplification: float = 2.0) -> Estimate: ...
def pulse(
    shape: _Shape,
    *,
    amplitude: float,
    frequency: float,
    cycles: float | None = None,
    phase: float = 0.0,
    error: float = 1e-4,
    structure: Structure | None = None,
    g: float = 9.81,
) -> Record: ...
# The functions below are for this package: _sweep.py, _ground.py and __init__.py have their arguments.
def sweep(*arguments: Any) -> tuple[list[str], list[tuple[str, Any]], BaseException | None]: ...
def overturning_map(*arguments: Any) -> str: ...
def exceeds(*arguments: Any) -> list[bool | None]: ...
def fragility(*arguments: Any) -> tuple[Curve, list[tuple[float, float, float, int, int, int]]]: ...
def check_ground(value: Ground) -> None: ...
def columns_of(limit: str, columns: list[str]) -> list[str]: ...
def heading_of(intensity: str) -> str: ...
def export(*arguments: Any) -> None: ...
