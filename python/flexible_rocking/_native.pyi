from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Final, Literal, TypedDict, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from ._ground import Ground
from ._results import Advice, Condition, Estimate, Peak, Profile, Response, Transitions, Worst

__version__: str

_Array = NDArray[np.float64]
_Path = str | PathLike[str]
_Rows = Any  # of storeys, floors or modes: dicts, or a DataFrame
_Detail = Literal["auto", "nonlinear", "linear", "modal", "rigid", "fixed_base"]
_Unit = Literal["g", "m/s2", "cm/s2", "gal", "mm/s2", "in/s2", "ft/s2", "mg", "%g"]
_Shape = Literal["half_sine", "sine", "cosine", "ricker", "antisymmetric_ricker", "mavroeidis_papageorgiou"]
_Criterion = Literal["theta", "u", "a_t", "theta_history", "u_history", "a_t_history"]

class _Numbers(TypedDict, total=False):
    m: float; "kg"
    m0: float; "kg"
    H: float; "m"
    B: float; "m"
    J0: float; "kg.m2"
    f_fc: float; "Hz"
    zeta_fc: float; "1"
    c_ratio: float; "1"
    r: float; "1"
    g: float; "m/s2"
    P_0: float; "N"
    k_t: float; "N/m"
    xi_d: float; "m"
    c_d: float; "N.s/m"
    k_d: float; "N/m"
    F_y: float; "N"
    period_fc: float; "s"
    weight: float; "N"
    weight0: float; "N"
    width: float; "m"
    alpha_cg: float; "rad"
    p_l: float; "rad/s"
    units: Literal["N, m, kg", "kN, m, t"]
    ground: Ground

class _Rayleigh(TypedDict):
    f: tuple[float, float]
    zeta: float

class _InitialValues(TypedDict, total=False):
    theta_0: float; "rad"
    theta_dot_0: float; "rad/s"
    u_0: ArrayLike; "m"
    u_dot_0: ArrayLike; "m/s"

@final
class Structure:
    @overload
    def __new__(cls, *, preset: Literal["mcmanus", "evison"] | None = None, **numbers: Unpack[_Numbers]) -> Structure: ...
    @overload
    def __new__(
        cls, *, zeta: ArrayLike | _Rayleigh, storeys: _Rows = ..., floors: _Rows = ..., K: ArrayLike = ..., modes: _Rows = ...,
        total: Mapping[str, float] = ..., p_delta: bool = ..., keep: int = ..., **base: Any,
    ) -> Structure: ...
    @staticmethod
    def read(file: _Path) -> Structure: ...
    def write(self, file: _Path) -> None: ...
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
    derived: Final[dict[str, float]]; "in SI units"
    mode_table: Final[dict[str, _Array]]; "f, f_u (Hz), mass (kg), height (m), zeta, share, chi"
    def effective_frequency(self, theta: float) -> float: "Hz, of theta in rad"
    def pushover(self, points: int = 100) -> Response: "theta (rad), u, delta_t (m), P (N), M (N.m)"
    def restoring(self, theta: float) -> Response: "theta (rad), moment (N.m)"
    def modes(self, response: Response) -> dict[str, _Array]: "q_r, q_u (rad), a_r, a_u (m/s2)"
    def __getattr__(self, name: str) -> float: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object) -> bool: ...

@final
class Record:
    LAYOUTS: str
    def __new__(
        cls,
        time: Any,  # numbers in s, a Series of pandas, or a Trace or Stream of ObsPy
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
        record_v: _Path | None = None,
        unit: _Unit | None = None,
        dt: float | None = None,
        column: int | str | None = None,
        column_v: int | str | None = None,
        ignore_npts: bool = False,
        time_scale: float = 1.0,
        scale: float = 1.0,
    ) -> Record: ...
    time: Final[_Array]; "s"
    a_g: Final[_Array]; "m/s2"
    a_v: Final[_Array | None]; "m/s2"
    F_t: Final[_Array | None]; "N"
    title: Final[str]
    pga: Final[float]; "m/s2"
    pgv: Final[float]; "m/s"
    duration: Final[float]; "s"
    def with_force(self, time: ArrayLike, F_t: ArrayLike) -> Record: "time in s, F_t in N"
    def scaled(self, scale: float = 1.0, *, time_scale: float = 1.0) -> Record: ...
    @overload
    def spectrum(self, periods: float, zeta: float = 0.05) -> float: "S_a in m/s2, periods in s"
    @overload
    def spectrum(self, periods: ArrayLike, zeta: float = 0.05) -> _Array: "S_a in m/s2, periods in s"
    def write(self, file: _Path, *, record_v: _Path | None = None) -> None: ...
    def plot(self) -> Any: ...
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
    condition: Final[Condition | None]
    residuals: Final[dict[str, float]]
    overturned: Final[bool | None]
    ending: Final[str]
    start: Final[float]; "s"
    end: Final[float]; "s"
    fall: Final[float | None]; "s"
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
    def at(self, times: ArrayLike) -> Response: "times in s; Response.units has the units"
    profile: Final[Profile]
    def spectrum(self, floor: int, periods: ArrayLike | None = None, zeta: float = 0.05) -> Response: "period (s), S_a (m/s2)"
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
    record: Record | _Path | None = None,
    *,
    duration: float | None = None,
    detail: _Detail = "auto",
    tolerance: float = 1e-9,
    condition: bool = False,
    **initial: Unpack[_InitialValues],
) -> Run: ...
def advise(
    structure: Structure,
    record: Record | _Path,
    *,
    within: float = 0.05,
    of: _Criterion | Sequence[_Criterion] | None = None,
    duration: float | None = None,
    **initial: Unpack[_InitialValues],
) -> Advice: ...
def estimate(structure: Structure, record: Record | _Path | None = None, *, amplification: float = 2.0) -> Estimate: ...
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
# The functions below are for this package: _sweep.py, _design.py, _calibrate.py, _ground.py and __init__.py have their arguments.
def numbers_of(structure: Structure) -> list[tuple[str, str, float, float, float]]: ...
def varied(structure: Structure, values: Mapping[str, float]) -> Structure: ...
def sweep(*arguments: Any) -> tuple[list[str], list[tuple[str, Any]], BaseException | None]: ...
def design(*arguments: Any) -> tuple[float | None, list[list[float]], list[list[float]], str, str, list[Any]]: ...
def overturning_map(*arguments: Any) -> str: ...
def exceeds(*arguments: Any) -> list[bool | None]: ...
def fragility(*arguments: Any) -> tuple[Curve, list[tuple[float, float, float, int, int, int]]]: ...
def check_ground(value: Ground) -> None: ...
def columns_of(limit: str, columns: list[str]) -> list[str]: ...
def heading_of(intensity: str) -> str: ...
def export(*arguments: Any) -> None: ...
