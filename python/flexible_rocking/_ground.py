"""Ground that gives, for Structure(ground=...)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypedDict

from . import _native

if TYPE_CHECKING:
    from typing_extensions import Unpack


class _Numbers(TypedDict, total=False):
    f_v: float
    k_v: float
    zeta_v: float
    c_v: float
    n_points: int
    kr_ratio: float
    k_r: float
    xi: Sequence[float]
    k: Sequence[float]
    c: Sequence[float]
    mu_c: float
    fs: float
    q_u: Sequence[float]


class Ground(dict[str, Any]):
    """Soil-structure interaction by Winkler springs under the base, compression-only, with dashpots: Ground(f_v=40, zeta_v=0.2).

    f_v: frequency of the bounce, Hz, or else k_v: stiffness of all points, N/m. f_v=0 is rigid ground.
    zeta_v: damping ratio of the bounce, by default 0.2, or else c_v: damping of all points, N.s/m.
    n_points: 2 (the edges) to 21, equally spaced. kr_ratio: K_r/(k_v B^2), by default 1 for two points and 1/3 (a uniform bed) for
    more, or else k_r: rotational stiffness, N.m/rad.
    xi, k, c: the points themselves in the place of all these, from left to right: places (m), stiffnesses (N/m), dampings (N.s/m).
    mu_c: coefficient of friction of a base that may slide; without it the middle of the base is held.
    fs: every point yields at fs times its force at rest, or else q_u: capacities of the points, N. Points settle for good by then.
    The points take the place of impacts: r has no effect. The names of the structure stay the same.
    Raises ValueError for an unknown name.
    """

    def __init__(self, **numbers: "Unpack[_Numbers]") -> None:
        super().__init__(numbers)
        _native.check_ground(self)
