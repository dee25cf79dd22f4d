//! Ground that gives, for soil-structure interaction: Winkler springs under the base. Each contact point is a compression-only spring with a
//! dashpot, which push and never pull.
//!
//! A point at ξ from the middle of the base is compressed by −e and pushes with N:
//!
//! ```text
//! e = y − ξ sin θ,   f = −(k e + c ė),   N = f where e < 0 and f > 0 ("pressed"), and 0 elsewhere         (F1, F2)
//! ```
//!
//! y is the height of the middle of the base above the unloaded ground. The middle moves vertically only. At rest all points are
//! pressed, and y is y_s = −(m_t g + P_0)/Σ k. The points take the place of uplift, impact and restitution.
//!
//! With a coefficient of friction μ_c the middle slides by x, too. Points with a capacity q yield in series with spring and dashpot: they
//! settle by s for good, and e = y − ξ sin θ + s,   N = min(f, q)                                          (S5, S6)

use crate::numbers::Number;
use crate::series::bisection::last_where;
use crate::structure::quantity::{Quantity, Refused, Units, ensure, ensure_in};
use crate::{Base, Body, Mode, Ties};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The numbers of ground that gives, as a file has them in `[ground]`. A number that is left out has its default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ground {
    /// Bounce frequency √(K_z/m_t)/2π, Hz; 0 is rigid ground. Or else `k_v`.
    pub f_v: Option<f64>,
    /// Vertical stiffness of all points K_z, N/m.
    pub k_v: Option<f64>,
    /// Damping ratio of the bounce, by default 0.2. Or else `c_v`.
    pub zeta_v: Option<f64>,
    /// Vertical damping of all points, N·s/m.
    pub c_v: Option<f64>,
    /// Number of points, equally spaced from edge to edge, by default 2.
    pub n_points: Option<f64>,
    /// K_r/(K_z B²), by default 1 for two points and 1/3 for more. Or else `k_r`.
    pub kr_ratio: Option<f64>,
    /// Rotational stiffness of all points K_r, N·m/rad.
    pub k_r: Option<f64>,
    /// Coefficient of friction of the base; the middle is held if none is given.
    pub mu_c: Option<f64>,
    /// Static reserve: every point yields at this multiple of its force at rest; elastic points if none is given. Or else `q_u`.
    pub fs: Option<f64>,
    /// Capacity of each point, N.
    pub q_u: Vec<f64>,
    /// The points themselves, in the place of the numbers above: places (m), stiffnesses (N/m) and dampings (N·s/m), from left to right.
    pub xi: Vec<f64>,
    #[allow(missing_docs)]
    pub k: Vec<f64>,
    #[allow(missing_docs)]
    pub c: Vec<f64>,
}

/// A contact point: its place from the middle of the base to the right (m), its stiffness (N/m), its damping (N·s/m) and its capacity (N),
/// which is infinite if the point is elastic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct ContactPoint {
    pub xi: f64,
    pub k: f64,
    pub c: f64,
    pub q: f64,
}

impl ContactPoint {
    /// The force (N) of the point at rest that is pressed in by `depth` (m).
    pub(crate) fn force(&self, depth: f64) -> f64 {
        (self.k * depth).clamp(0.0, self.q)
    }
}

/// The contact points under a structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Foundation {
    /// The points, from left to right.
    pub points: Vec<ContactPoint>,
    /// The numbers that the points follow from, under another base too.
    #[serde(skip)]
    pub ground: Ground,
    /// y at rest y_s, m.
    pub y_s: f64,
    /// Coefficient of friction of a base that may slide.
    pub mu_c: Option<f64>,
    /// Whether the points may yield.
    pub yields: bool,
    /// The place of the [`Footing`] among the lateral coordinates, after the modes.
    pub(crate) place: usize,
}

/// Number of the coordinates of a [`Footing`].
pub(crate) const FOOTING: usize = 3;

/// The coordinates of a base on ground that gives beside those of the modes, or their rates.
#[derive(Clone, Copy, Debug)]
pub struct Footing<N = f64> {
    /// Height of the middle of the base above the unloaded ground, m.
    pub y: N,
    /// sin θ.
    pub sin: N,
    /// Energy that the ground has taken, J.
    pub taken: N,
}

impl<N> Footing<N> {
    /// The coordinates with these numbers, in the order in which they stand.
    pub fn of([y, sin, taken]: [N; FOOTING]) -> Footing<N> {
        Footing { y, sin, taken }
    }

    /// The numbers in that order.
    pub fn numbers(self) -> [N; FOOTING] {
        [self.y, self.sin, self.taken]
    }
}

impl<N: Number> Footing<N> {
    /// The height of the base at `xi` (m) above the unloaded ground (m), or its rate (F1).
    #[inline(always)]
    pub fn height(&self, xi: f64) -> N {
        self.y - self.sin * xi
    }
}

/// The names of the numbers of [`Ground`].
pub const NAMES: [&str; 13] =
    ["f_v", "k_v", "zeta_v", "c_v", "n_points", "kr_ratio", "k_r", "xi", "k", "c", "mu_c", "fs", "q_u"];

/// The most contact points.
pub const MOST_POINTS: usize = NONE_SETTLED.len();

/// Settlements of the contact points for good (m), or their rates; 0 of points that are none. A constant in the place of the number breaks
/// rustc 1.95.
pub type Settlements = [f64; 21];

/// No point has settled.
pub(crate) const NONE_SETTLED: Settlements = [0.0; 21];

/// Damping ratio of the bounce unless it is given.
const ZETA: f64 = 0.2;

/// Least inertia about the middle of the base as a fraction of m_t B².
const LEAST_INERTIA: f64 = 1e-4;

/// Part by which two numbers that must be equal may differ.
const SAME: f64 = 1e-9;

const F_V: Quantity<f64> = Quantity::limit("f_v", "Hz", [0.1, 1e3], "frequency of the bounce on the ground");
const K_V: Quantity<f64> = Quantity::limit("k_v", "N/m", [1e-6, 1e18], "vertical stiffness of the ground");
const ZETA_V: Quantity<f64> = Quantity::limit("zeta_v", "1", [0.0, 5.0], "damping ratio of the bounce on the ground");
const C_V: Quantity<f64> = Quantity::limit("c_v", "N.s/m", [0.0, 1e18], "vertical damping of the ground");
const KR_RATIO: Quantity<f64> =
    Quantity::limit("kr_ratio", "1", [0.0, 1.0], "rotational stiffness of the ground over k_v B^2, with two points 1");
const K_R: Quantity<f64> = Quantity::limit("k_r", "N.m/rad", [1e-6, 1e22], "rotational stiffness of the ground");
const MU_C: Quantity<f64> = Quantity::limit("mu_c", "1", [0.0, 2.0], "coefficient of friction of the base");
const FS: Quantity<f64> = Quantity::limit("fs", "1", [1.0, 100.0], "capacity of the ground over its load at rest");

/// Least damping ratio of the bounce of points that yield, if it is not 0: the ground follows a yielding point in the time 2 ζ_v/ω_v.
const LEAST_ZETA: f64 = 0.02;

/// Part of m_t below which a base without inertia slides.
const NO_MASS: f64 = 1e-9;

impl Ground {
    /// The same ground with numbers in SI units.
    pub fn in_si(mut self, units: Units) -> Ground {
        let to_si = |unit: &'static str| move |value: &mut f64| *value = units.in_si(*value, unit);
        self.k_v.iter_mut().chain(&mut self.k).for_each(to_si("N/m"));
        self.c_v.iter_mut().chain(&mut self.c).for_each(to_si("N.s/m"));
        self.k_r.iter_mut().for_each(to_si("N.m/rad"));
        self.q_u.iter_mut().for_each(to_si("N"));
        self
    }

    /// Shows each number that can have another value, those of evenly spaced points and defaults too, and takes the value that is left there.
    pub(crate) fn each(&mut self, mut see: impl FnMut(&Quantity<f64>, &mut f64)) {
        if self.is_rigid() {
            return;
        }
        let mut one_of =
            |of: &Quantity<f64>, value: &mut Option<f64>| value.iter_mut().for_each(|value| see(of, value));
        one_of(&MU_C, &mut self.mu_c);
        one_of(&FS, &mut self.fs);
        if !self.xi.is_empty() {
            return;
        }
        one_of(&F_V, &mut self.f_v);
        one_of(&K_V, &mut self.k_v);
        if self.c_v.is_none() {
            self.zeta_v.get_or_insert(ZETA);
        }
        one_of(&ZETA_V, &mut self.zeta_v);
        one_of(&C_V, &mut self.c_v);
        if self.n_points.is_some_and(|n| n > 2.0) {
            if self.k_r.is_none() {
                self.kr_ratio.get_or_insert(1.0 / 3.0);
            }
            one_of(&KR_RATIO, &mut self.kr_ratio);
            one_of(&K_R, &mut self.k_r);
        }
    }

    /// Whether this ground does not give.
    pub(crate) fn is_rigid(&self) -> bool {
        self.f_v == Some(0.0)
    }

    /// The points under a base of half-width `B` (m) that carries `m_t` (kg), none on rigid ground.
    fn points(&self, m_t: f64, B: f64) -> Result<Vec<ContactPoint>, Refused> {
        let &Ground { f_v, k_v, zeta_v, c_v, n_points, kr_ratio, k_r, .. } = self;
        let [xi, k, c] = [&self.xi, &self.k, &self.c];
        let list = Some(xi.len() as f64).filter(|points| *points > 0.0);
        for (one, other, both) in [
            ("f_v", "k_v", f_v.zip(k_v)),
            ("zeta_v", "c_v", zeta_v.zip(c_v)),
            ("kr_ratio", "k_r", kr_ratio.zip(k_r)),
            ("f_v", "xi", f_v.zip(list)),
            ("k_v", "xi", k_v.zip(list)),
            ("zeta_v", "xi", zeta_v.zip(list)),
            ("c_v", "xi", c_v.zip(list)),
            ("n_points", "xi", n_points.zip(list)),
            ("kr_ratio", "xi", kr_ratio.zip(list)),
            ("k_r", "xi", k_r.zip(list)),
            ("fs", "q_u", self.fs.zip(self.q_u.first().copied())),
        ] {
            ensure(both.is_none(), || format!("{one} and {other} are both given: leave one of them out"))?;
        }
        for (limit, value) in [
            (F_V, f_v.filter(|_| !self.is_rigid())),
            (K_V, k_v),
            (ZETA_V, zeta_v),
            (C_V, c_v),
            (MU_C, self.mu_c),
            (FS, self.fs),
        ] {
            value.map_or(Ok(()), |value| limit.check(value))?;
        }
        let n = n_points.unwrap_or(2.0);
        ensure((2.0..=MOST_POINTS as f64).contains(&n) && n.fract() == 0.0, || {
            format!("n_points = {n} is out of range: a whole number from 2 to {MOST_POINTS} is needed")
        })?;
        let n = n as usize;
        if !(xi.is_empty() && k.is_empty() && c.is_empty()) {
            let counts = [xi, k, c].map(Vec::len);
            ensure(counts == [counts[0]; 3] && (2..=MOST_POINTS).contains(&counts[0]), || {
                format!("xi, k and c have {counts:?} numbers: give 2 to {MOST_POINTS} of each, one for each point")
            })?;
            return Ok((0..xi.len()).map(|i| ContactPoint { xi: xi[i], k: k[i], c: c[i], q: f64::INFINITY }).collect());
        }
        if self.is_rigid() {
            ensure(self.mu_c.is_none() && self.fs.is_none() && self.q_u.is_empty(), || {
                "mu_c, fs and q_u are of ground that gives, and f_v = 0 Hz is rigid ground: give f_v or k_v".into()
            })?;
            return Ok(Vec::new());
        }
        let needed = |units: Units| {
            let unit = units.name(K_V.unit);
            format!("neither f_v (Hz) nor k_v ({unit}) is given: give one, or leave [ground] out for rigid ground")
        };
        let K_z = f_v.map(|f_v| m_t * (TAU * f_v) * (TAU * f_v)).or(k_v).ok_or_else(|| Refused::shown(needed))?;
        let tau = c_v.map_or(2.0 * zeta_v.unwrap_or(ZETA) / (K_z / m_t).sqrt(), |c_v| c_v / K_z);
        let xi = |i: usize| B * (2.0 * i as f64 / (n - 1) as f64 - 1.0);
        let (inner, most) = ((1..n - 1).map(|i| xi(i) * xi(i)).sum::<f64>(), (n - 2) as f64 * B * B);
        let ratio = k_r.map(|k_r| k_r / (K_z * B * B)).or(kr_ratio).unwrap_or(if n == 2 { 1.0 } else { 1.0 / 3.0 });
        let least = if n == 2 { 1.0 } else { inner / most };
        ensure(((1.0 - SAME) * least..=1.0 + SAME).contains(&ratio), || {
            let between = format!("it must lie between {least:.3} and 1, so that no stiffness is negative");
            let needed = if n == 2 { "of two points it is 1, and k_r is k_v B^2" } else { &between };
            format!("kr_ratio = {ratio} is not possible with {n} points: {needed}")
        })?;
        let k_int = if n == 2 { 0.0 } else { K_z * B * B * (1.0 - ratio) / (most - inner) };
        let k_end = (K_z - (n - 2) as f64 * k_int) / 2.0;
        let k = |i: usize| if i == 0 || i == n - 1 { k_end } else { k_int };
        let point = |i: usize| ContactPoint { xi: xi(i), k: k(i), c: tau * k(i), q: f64::INFINITY };
        Ok((0..n).map(point).filter(|point| point.k > 0.0).collect())
    }
}

impl Foundation {
    /// The foundation of `ground` under a structure; none on rigid ground.
    pub(crate) fn new(
        ground: &Ground,
        base: &Base,
        body: &Body,
        modes: &[Mode],
    ) -> Result<Option<Foundation>, Refused> {
        let &Base { m_t, J0, B, g, c_ratio, ties: Ties { P_0, .. }, .. } = base;
        let points = ground.points(m_t, B)?;
        if points.is_empty() {
            return Ok(None);
        }
        let is_close = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        for (i, (&ContactPoint { xi, k, c, .. }, mirrored)) in points.iter().zip(points.iter().rev()).enumerate() {
            let (is_ordered, is_under) = (i == 0 || points[i - 1].xi < xi, xi.abs() <= B * (1.0 + SAME));
            let is_symmetric =
                (xi + mirrored.xi).abs() <= SAME * B && is_close(k, mirrored.k) && is_close(c, mirrored.c);
            for (is_so, needed) in [
                (k > 0.0 && k.is_finite() && c >= 0.0 && c.is_finite(), "k must exceed 0 and c must not be negative"),
                (is_under, "the point must lie under the base, |xi| <= B"),
                (is_ordered, "give the points from left to right"),
                (is_symmetric, "the points must be symmetric about the middle: xi, -xi with the same k and c"),
            ] {
                ensure_in(is_so, |units| {
                    let [k, c] =
                        [(k, "N/m"), (c, "N.s/m")].map(|(of, unit)| units.show_by(|of| format!("{of:?}"), of, unit));
                    format!("xi[{}] = {xi:?} m, k = {k}, c = {c}: {needed}", i + 1)
                })?;
            }
        }
        ensure(c_ratio == 1.0, || {
            format!(
                "c_ratio = {c_ratio} has no meaning on ground that gives, where nothing rocks about an edge: set c_ratio to 1"
            )
        })?;
        let (mu_c, yields) = (ground.mu_c, ground.fs.is_some() || !ground.q_u.is_empty());
        let mut foundation = Foundation { points, ground: ground.clone(), y_s: 0.0, mu_c, yields, place: modes.len() };
        foundation.y_s = -(m_t * g + P_0) / foundation.sum(0);
        foundation.take_capacities(base)?;
        ensure_in(mu_c.is_none() || free_mass(base, modes) > NO_MASS * m_t, |units| {
            format!(
                "mu_c is given, and all mass is in the modes, m0 = {}: the base would slide without inertia, give the base a mass",
                units.show(base.m0, "kg")
            )
        })?;
        let [K_r, least] = [foundation.sum(2), least_stiffness(base, body, modes)];
        ensure_in(K_r > least, |units| {
            let [K_r, least] = [K_r, least].map(|of| units.show(of, "N.m/rad"));
            format!(
                "it cannot stand: the ground holds the rotation with K_r = {K_r}, and K_r = {least} is needed; raise f_v, k_v or kr_ratio"
            )
        })?;
        ensure_in(J0 >= LEAST_INERTIA * m_t * B * B, |units| {
            format!(
                "J0 = {} is too small, because the base turns about the middle of its lower side: give J0, for a block m0 (B^2 + t^2)/3 of the thickness t",
                units.show(body.J0, "kg.m2")
            )
        })?;
        Ok(Some(foundation))
    }

    /// Gives the points their capacities.
    fn take_capacities(&mut self, base: &Base) -> Result<(), Refused> {
        if !self.yields {
            return Ok(());
        }
        let (count, given, omega_v) = (self.points.len(), self.ground.q_u.len(), self.omega_v(base));
        ensure(given == 0 || given == count, || {
            format!("q_u has {given} numbers, and there are {count} points: give one for each, from left to right")
        })?;
        for i in 0..count {
            let zeta = 0.5 * self.points[i].c / self.points[i].k * omega_v;
            ensure(zeta == 0.0 || zeta >= LEAST_ZETA * (1.0 - SAME), || match self.ground.c.len() {
                0 => format!(
                    "zeta_v = {} is too small for points that yield: give 0, or {LEAST_ZETA} or more",
                    self.zeta_v(base)
                ),
                _ => format!(
                    "c[{}] = {} N.s/m is too small for a point that yields: give 0, or {} N.s/m or more",
                    i + 1,
                    self.points[i].c,
                    2.0 * LEAST_ZETA * self.points[i].k / omega_v
                ),
            })?;
            let at_rest = -self.points[i].k * self.y_s;
            let q = self.ground.fs.map_or_else(|| self.ground.q_u[i], |fs| fs * at_rest);
            let mirrored = self.ground.q_u.get(count - 1 - i).map_or(q, |q| *q);
            let name = || if given == 0 { "fs".into() } else { format!("q_u[{}]", i + 1) };
            ensure_in(q.is_finite() && q > at_rest, |units| {
                let [q, at_rest] = [q, at_rest].map(|of| units.show(of, "N"));
                format!("{}: it sinks at rest: the point can carry {q}, and carries {at_rest} at rest", name())
            })?;
            ensure((q - mirrored).abs() <= SAME * q, || {
                format!("{} and q_u[{}] differ: the points must be symmetric about the middle", name(), count - i)
            })?;
            self.points[i].q = q;
        }
        Ok(())
    }

    /// The least capacity of a point over its load at rest, infinite of elastic points.
    pub(crate) fn reserve(&self) -> f64 {
        self.points.iter().map(|point| -point.q / (point.k * self.y_s)).fold(f64::INFINITY, f64::min)
    }

    /// Number of the coordinates beside those of the modes.
    pub(crate) fn coordinates(&self) -> usize {
        FOOTING + usize::from(self.mu_c.is_some())
    }

    /// The place of x, the way of the middle to the right, among the lateral coordinates of a base that may slide.
    pub fn slide(&self) -> Option<usize> {
        self.mu_c.map(|_| self.place + FOOTING)
    }

    /// Whether the base may slide, or points may yield.
    pub(crate) fn may_stay_moved(&self) -> bool {
        self.mu_c.is_some() || self.yields
    }

    /// Σ k ξⁿ s of settlements s for good, over the same sum without s but of ξ²ⁿ: the mean settlement for n = 0, m, and the tilt for n = 1,
    /// rad.
    pub(crate) fn residual(&self, s: impl Fn(usize) -> f64, power: i32) -> f64 {
        let part = |(i, point): (usize, &ContactPoint)| s(i) * (point.k * point.xi.powi(power));
        self.points.iter().enumerate().map(part).sum::<f64>() * (1.0 / self.sum(2 * power))
    }

    /// Both ends of the strip of a base of half-width `B` (m) that point `i` stands for, m: halfway to the next points, or an edge.
    pub(crate) fn strip(&self, i: usize, B: f64) -> [f64; 2] {
        let halfway = |left: usize| Some((self.points.get(left)?.xi + self.points.get(left + 1)?.xi) / 2.0);
        [i.checked_sub(1).and_then(halfway).unwrap_or(-B), halfway(i).unwrap_or(B)]
    }

    /// The points whose strips reach into the outer sixth of a base of half-width `B` (m), or into the outer strip if this is wider, at the
    /// left (0) or right (1) edge. The sum of their forces times these factors (1/m) is the mean pressure there, N/m.
    pub(crate) fn of_edge(&self, side: usize, B: f64) -> impl Iterator<Item = (usize, f64)> {
        let end = (self.strip(0, B)[1] + B).max(B / 3.0) - B;
        let inside =
            (0..self.points.len()).map(move |i| (i, self.strip(i, B))).filter(move |(_, [from, _])| *from < end);
        let last = side * (self.points.len() - 1);
        inside.map(move |(i, [from, to])| (last.abs_diff(i), (to.min(end) - from) / (to - from) / (end + B)))
    }

    /// The sum of the stiffnesses of all points times this power of their places.
    pub fn sum(&self, power: i32) -> f64 {
        self.points.iter().map(|point| point.k * point.xi.powi(power)).sum()
    }

    /// The circular frequency of the bounce √(K_z/m_t), rad/s.
    pub(crate) fn omega_v(&self, base: &Base) -> f64 {
        (self.sum(0) / base.m_t).sqrt()
    }

    /// The damping ratio of the bounce, as it was given or else that of the points.
    pub(crate) fn zeta_v(&self, base: &Base) -> f64 {
        let of_points = || self.points.iter().map(|point| point.c).sum::<f64>() / (2.0 * base.m_t * self.omega_v(base));
        self.ground.zeta_v.filter(|_| self.ground.xi.is_empty()).unwrap_or_else(of_points)
    }

    /// A bound of the rates of small motions with these `frequencies` (rad/s), 1/s: the highest frequency ω, or if more the least of two
    /// bounds of what dashpots relax at: max(c/k) ω² of the points; and C_z/m_t of the bounce and (C_r + Σ c h²)/J + max c/m of rocking and
    /// the modes, where C_z = Σ c and C_r = Σ c ξ² of the dashpots, and c of each mode is its own.
    pub(crate) fn fastest(&self, frequencies: &[f64], base: &Base, modes: &[Mode]) -> f64 {
        let dashpots = |power: i32| self.points.iter().map(|point| point.c * point.xi.powi(power)).sum::<f64>();
        let turning = dashpots(2) + modes.iter().map(|mode| mode.damping * mode.height * mode.height).sum::<f64>();
        let of_modes = modes.iter().map(|mode| mode.damping / mode.mass).fold(0.0, f64::max);
        let highest = frequencies[frequencies.len() - 1];
        let of_points = self.points.iter().map(|point| point.c / point.k).fold(0.0, f64::max) * highest * highest;
        highest.max(of_points.min((dashpots(0) / base.m_t).max(turning / base.J0 + of_modes)))
    }

    /// The same for a base that slides with these modes on the mass m' that no mode carries, given this bound `held` of a base that is held:
    /// Ω² gains Σ Γ² ω²/m', Ω the rate Σ 2 ζ ω Γ²/m'.
    pub(crate) fn fastest_sliding(&self, held: f64, base: &Base, modes: &[Mode]) -> f64 {
        let free = free_mass(base, modes);
        let sum = |of: fn(&Mode) -> f64| {
            modes.iter().map(|mode| mode.gamma * mode.share * of(mode) / mode.mass).sum::<f64>() / free
        };
        (held * held + sum(|mode| mode.stiffness)).sqrt().max(sum(|mode| mode.damping))
    }

    /// The circular frequencies of small motions in full contact without damping, rad/s, lowest first: the bounce √(K_z/m_t), and the
    /// roots λ = ω² of
    ///
    /// ```text
    /// K_r − g S_1 − λ J = Σ (κ_j λ + g Γ_j)²/(ω_j² − λ)          J: inertia about the middle of the base
    /// ```
    ///
    /// The left side minus the right is what is left of K − λM of (q, θ) for θ once q is eliminated: as many roots lie below a λ as
    /// ω_j² do, and one more if it is negative.
    pub(crate) fn frequencies(&self, base: &Base, body: &Body, modes: &[Mode]) -> Vec<f64> {
        let (g, stiffness) = (base.g, self.sum(2) - base.g * body.S_1);
        let square = |mode: &Mode| mode.stiffness / mode.mass;
        let sum = |of: &dyn Fn(&Mode) -> f64| modes.iter().map(of).sum::<f64>();
        let inertia = base.J0 + sum(&|mode| mode.mass * mode.height * mode.height);
        let roots_below = |lambda: f64| {
            let couples = |mode: &Mode| mode.mass * mode.height * lambda + g * mode.gamma;
            let right = sum(&|mode| couples(mode) * couples(mode) / (mode.stiffness - mode.mass * lambda));
            let passed = modes.iter().filter(|mode| square(mode) < lambda).count();
            passed + usize::from(stiffness - lambda * inertia - right < 0.0)
        };
        let turned = sum(&|mode| mode.height * (mode.stiffness * mode.height + 2.0 * g * mode.gamma));
        let beyond = sum(&square) + (stiffness + turned) / base.J0; // the sum of all roots
        let root = |n: usize| last_where(0.0, beyond, |lambda| roots_below(lambda) <= n).sqrt();
        let mut all: Vec<_> = (0..=modes.len()).map(root).chain([self.omega_v(base)]).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The energy (J) above rest below which no point certainly leaves the ground, by the weakest way there: small motions in full contact.
    pub(crate) fn least_lift(&self, base: &Base, body: &Body, modes: &[Mode]) -> f64 {
        let [K_z, K_r] = [0, 2].map(|power| self.sum(power));
        let outer = self.points[0].xi;
        0.5 * self.y_s * self.y_s / (1.0 / K_z + outer * outer / (K_r - least_stiffness(base, body, modes)))
    }

    /// y of a structure that is held at the rotation of this sine, whose tendon has the prestress P_0 at y_s and the stiffness k_t:
    ///
    /// ```text
    /// Σ k max(0, ξ sin θ − y) = m_t g + max(0, P_0 + k_t (y − y_s))
    /// ```
    ///
    /// and the slope of y over sin θ there. A point carries no more than its capacity.
    pub(crate) fn held_at(&self, sin: f64, base: &Base) -> [f64; 2] {
        let &Base { m_t, g, ties: Ties { P_0, k_t, .. }, .. } = base;
        if self.yields {
            let y = self.level(sin, base, &|_| 0.0);
            let is_elastic = |of: &&ContactPoint| (f64::MIN_POSITIVE..of.q).contains(&of.force(of.xi * sin - y));
            let elastic = self.points.iter().filter(is_elastic);
            let hold = if P_0 + k_t * (y - self.y_s) > 0.0 { k_t } else { 0.0 };
            let [K_0, K_1] = elastic.fold([hold, 0.0], |[a, b], point| [a + point.k, b + point.k * point.xi]);
            return [y, if K_0 > 0.0 { K_1 / K_0 } else { 0.0 }];
        }
        let mut y = self.y_s - self.points[0].xi.abs() * sin.abs();
        let mut slope = 0.0;
        // a step of Newton's method is exact once the pressed points are known
        for _ in 0..2 * MOST_POINTS {
            let is_taut = P_0 + k_t * (y - self.y_s) > 0.0;
            let [pull, hold] = if is_taut { [P_0 - k_t * self.y_s, k_t] } else { [0.0; 2] };
            let pressed = || self.points.iter().filter(|point| point.xi * sin > y);
            let [K_0, K_1] = pressed().fold([hold, 0.0], |[a, b], point| [a + point.k, b + point.k * point.xi]);
            let next = (K_1 * sin - m_t * g - pull) / K_0;
            slope = K_1 / K_0;
            if next == y {
                break;
            }
            y = next;
        }
        [y, slope]
    }

    /// y of a structure that is held at the rotation of this sine on points that have settled by `s` (m): Σ min(q, k max(0, ξ sin θ − s − y))
    /// = m_t g + max(0, P_0 + k_t (y − y_s)).
    pub(crate) fn level(&self, sin: f64, base: &Base, s: &dyn Fn(usize) -> f64) -> f64 {
        let &Base { m_t, g, ties: Ties { P_0, k_t, .. }, .. } = base;
        let top = |(i, point): (usize, &ContactPoint)| point.xi * sin - s(i);
        let carries = |y: f64| {
            let forces = self.points.iter().enumerate().map(|(i, point)| point.force(top((i, point)) - y));
            forces.sum::<f64>() >= m_t * g + (P_0 + k_t * (y - self.y_s)).max(0.0)
        };
        let highest = self.points.iter().enumerate().map(top).fold(f64::NEG_INFINITY, f64::max);
        let mut lower = (0..64).map(|i| highest + libm::exp2(f64::from(i)) * self.y_s);
        last_where(lower.find(|y| carries(*y)).unwrap_or(highest), highest, carries)
    }

    /// The moment about its middle by which the ground turns back the `base` of a structure that is held at the rotation of this sine and
    /// cosine: Σ ξ N cos θ, N·m, with N = min(q, k max(0, ξ sin θ − y)) and y of the vertical balance.
    pub(crate) fn restoring(&self, base: &Base, [sin, cos]: [f64; 2]) -> f64 {
        let y = if sin == 0.0 { self.y_s } else { self.held_at(sin, base)[0] };
        // as many points lie on the other side: at rest nothing is left of rounding
        let moment = |point: &ContactPoint| {
            let depth = |xi: f64| (xi * sin - y).clamp(0.0, point.q / point.k);
            point.k * point.xi * (depth(point.xi) - depth(-point.xi))
        };
        0.5 * self.points.iter().map(moment).sum::<f64>() * cos
    }

    /// The rotation of a structure on this `base`, held at growing angles, at which the first point leaves the ground, rad; π/2 if it is
    /// beyond.
    pub(crate) fn first_release(&self, base: &Base) -> f64 {
        let left = self.points[0].xi;
        let is_pressed = |sin: f64| self.held_at(sin, base)[0] < left * sin;
        libm::asin(if self.yields { last_where(0.0, 1.0, is_pressed) } else { (self.y_s / left).min(1.0) })
    }
}

/// m', the mass that no mode carries sideways, kg.
pub(crate) fn free_mass(base: &Base, modes: &[Mode]) -> f64 {
    base.m_t - modes.iter().map(|mode| mode.gamma * mode.share).sum::<f64>()
}

/// g S_1 and Σ (g Γ)²/(μ ω²): by which the weight of a structure turns its base over, per sine of the rotation, N·m.
pub(crate) fn overturns(base: &Base, body: &Body, modes: &[Mode]) -> (f64, f64) {
    let leaning = |mode: &Mode| (base.g * mode.gamma).powi(2) / mode.stiffness;
    (base.g * body.S_1, modes.iter().map(leaning).sum())
}

/// The rotational stiffness of the ground at which a structure at rest falls over, g S_1 + Σ (g Γ)²/(μ ω²), N·m/rad.
fn least_stiffness(base: &Base, body: &Body, modes: &[Mode]) -> f64 {
    let (weighs, leans) = overturns(base, body, modes);
    weighs + leans
}
