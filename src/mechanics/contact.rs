//! Ground that gives under a base: the pressed points, rest, energy.

use crate::mechanics::energy::mechanical;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::restraint::{self, Dissipators, Kept, Tie, places};
use crate::series::taylor::reciprocal;
use crate::structure::ground::{ContactPoint, Footing, Settlements, overturns};
use crate::structure::mode::Modes;
use crate::{Base, Foundation, Friction, Load, Phase, PressedPoints, Side, State, Structure, Ties};

/// −e and f/k of each point, m (S5): both are positive if the point is pressed, which yields at q/k.
pub(crate) fn heights<Q: Coordinates>(
    foundation: &Foundation,
    state: &State<Q>,
    settled: &[f64],
) -> impl Iterator<Item = [f64; 2]> {
    let footing = [&state.u, &state.u_dot].map(|q| q.footing(foundation));
    foundation.points.iter().enumerate().map(move |(i, &ContactPoint { xi, k, c, .. })| {
        let [e, rate] = footing.map(|of| of.height(xi));
        let e = e + settled[i];
        [-e, -(e + c / k * rate)]
    })
}

/// While a point yields, its spring and dashpot carry q together, so that e = −q/k + (e_0 + q/k) exp(−k t/c), whatever the structure does.
impl ContactPoint {
    /// k/c, 1/s; 0 without a dashpot, where e does not change.
    fn fading(&self) -> f64 {
        if self.c > 0.0 { self.k / self.c } else { 0.0 }
    }

    /// ė (m/s) at the height `e` (m) above the settled level.
    pub(crate) fn creep(&self, e: f64) -> f64 {
        -(e + self.q / self.k) * self.fading()
    }

    /// e (m) after a `time` (s) from `e` (m) on.
    pub(crate) fn crept(&self, e: f64, time: f64) -> f64 {
        let end = -self.q / self.k;
        if self.c > 0.0 { end + (e - end) * libm::exp(-self.fading() * time) } else { end }
    }

    /// The coefficients over `span` (s) of exp(−k t/c).
    pub(crate) fn fades(&self, span: f64) -> impl Iterator<Item = f64> {
        let fades = -self.fading() * span;
        (1..).scan(1.0, move |next, k| Some(std::mem::replace(next, *next * fades * reciprocal(k))))
    }
}

/// Part by which a bend is passed.
const BEYOND_BEND: f64 = 1e-9;

/// Part of its capacity that separates a point at rest from it, at least.
const NEAR_CAPACITY: f64 = 1e-3;

/// Part of its capacity by which a point at rest may be beyond it: the energy at rest then has an error that is small beside the energy that
/// [`NEAR_CAPACITY`] leaves.
const BEYOND_CAPACITY: f64 = NEAR_CAPACITY * NEAR_CAPACITY / 16.0;

/// Part of its capacity by which a point may miss it and yield all the same.
const ON_CAPACITY: f64 = 1e-12;

impl Foundation {
    /// `state` of a structure that is held at its rotation and lowered until the ground carries it, with a rate at which the forces of the
    /// springs start without a rate of their sum.
    pub(crate) fn begin<Q: Coordinates>(&self, state: &State<Q>, base: &Base) -> State<Q> {
        let (sin, cos) = libm::sincos(state.theta);
        let [y, slope] = if sin == 0.0 { [self.y_s, 0.0] } else { self.held_at(sin, base) };
        let (mut begun, turning) = (*state, state.theta_dot * cos);
        begun.u.set_footing(self, Footing { y, sin, taken: 0.0 });
        begun.u_dot.set_footing(self, Footing { y: slope * turning, sin: turning, taken: 0.0 });
        if let Some(place) = self.slide() {
            begun.u.set(place, 0.0);
            begun.u_dot.set(place, 0.0);
        }
        begun
    }

    /// y (m) and sin θ of `structure` at rest on points that have settled for good by `s` (m): Σ N = m_t g + P and Σ ξ N = g S_1 tan θ +
    /// g² sin θ Σ Γ²/(μ ω²), with N = min(q, k max(0, −e)). A rounded bed has several rests: this one is the way that the structure goes
    /// without inertia from the rotation of the sine `now`. None if it falls over from there.
    pub(crate) fn at_rest(&self, structure: &Structure, now: f64, s: &dyn Fn(usize) -> f64) -> Option<[f64; 2]> {
        if (0..self.points.len()).all(|i| s(i) == 0.0) && now.abs() <= self.y_s / self.points[0].xi {
            return Some([self.y_s, 0.0]);
        }
        let way = if self.turned_back(structure, now, s) < 0.0 { 1.0 } else { -1.0 };
        let sin = self.first_turn(structure, [now, way], u64::BITS, s, &|back| way * back < 0.0)?;
        Some([self.level(sin, structure.base(), s), sin])
    }

    /// The moment that turns `structure` back to a rotation of 0, N·m, at this sine of its rotation.
    fn turned_back(&self, structure: &Structure, sin: f64, s: &dyn Fn(usize) -> f64) -> f64 {
        let (weighs, leans) = overturns(structure.base(), structure.body(), structure.modes());
        let y = self.level(sin, structure.base(), s);
        let moment = |(i, of): (usize, &ContactPoint)| of.xi * of.force(of.xi * sin - y - s(i));
        self.points.iter().enumerate().map(moment).sum::<f64>() - (weighs / (1.0 - sin * sin).sqrt() + leans) * sin
    }

    /// The first sine `from` this one on, and before `far`, at which the moment that turns the structure back is not `so` any more: it is so at
    /// the sine found, which is as close as `halvings` of the part between two bends of this moment bring it.
    fn first_turn(
        &self,
        structure: &Structure,
        [mut from, far]: [f64; 2],
        halvings: u32,
        s: &dyn Fn(usize) -> f64,
        so: &dyn Fn(f64) -> bool,
    ) -> Option<f64> {
        let (way, is_so) = (Side::of(far - from).sign(), |sin: f64| so(self.turned_back(structure, sin, s)));
        while way * (far - from) > 0.0 {
            let mut to = way * (way * self.next_bend(structure.base(), from, way, s)).min(way * far);
            if !is_so(to) {
                for _ in 0..halvings {
                    let middle = 0.5 * (from + to);
                    *(if is_so(middle) { &mut from } else { &mut to }) = middle;
                }
                return Some(from);
            }
            from = to;
        }
        None
    }

    /// The sine just beyond the next one at which the ground touches or releases a point, a point comes to its capacity or leaves it, or the
    /// tendon goes slack or taut, while the structure turns from `sin` to the side `way` without inertia; the one of a quarter turn if none is.
    fn next_bend(&self, base: &Base, sin: f64, way: f64, s: &dyn Fn(usize) -> f64) -> f64 {
        let Ties { P_0, k_t, .. } = base.ties;
        let (y, taut) = (self.level(sin, base, s), self.y_s - P_0 / k_t);
        let depths = || self.points.iter().enumerate().map(move |(i, of)| (of, of.xi * sin - y - s(i)));
        let carry = depths().filter(|(of, depth)| *depth > 0.0 && of.k * depth < of.q);
        let held = if y > taut { k_t } else { 0.0 };
        let [K_0, K_1] = carry.fold([held, 0.0], |[a, b], (of, _)| [a + of.k, b + of.k * of.xi]);
        let falls = K_1 / K_0;
        let of_points = depths().flat_map(|(of, depth)| [0.0, of.q / of.k].map(|at| (at - depth) / (of.xi - falls)));
        let next = of_points.chain([(taut - y) / falls]).map(|by| way * by).filter(|by| *by > 0.0);
        let next = next.fold(f64::INFINITY, f64::min);
        (sin + way * (next * (1.0 + BEYOND_BEND) + BEYOND_BEND * BEYOND_BEND)).clamp(-1.0, 1.0)
    }

    /// The energy (J) above this rest, of y (m) and sin θ on points that have settled by `s` (m), below which no point certainly yields:
    /// half of the least ½ k δ² + ½ v²/w that brings a point to its capacity q = N + k δ + c v, with the velocity w = 1/m_t + ξ²/J_0 that an
    /// impulse of 1 gives it, where gravity adds no more than the other half within a rotation d, and the energy that turns the base by d.
    /// A point that rests close to its capacity counts as held, because it settles by less than a millionth of q/k after that; 0 if one
    /// is beyond it, so that the rest is none.
    pub(crate) fn least_yield(&self, structure: &Structure, [y, sin]: [f64; 2], s: &dyn Fn(usize) -> f64) -> f64 {
        let (&Base { m_t, J0, g, ties: Ties { P_0, k_t, .. }, .. }, (weighs, leans)) =
            (structure.base(), overturns(structure.base(), structure.body(), structure.modes()));
        let to_capacity = |(i, point): (usize, &ContactPoint)| {
            let left = (point.q - point.k * (point.xi * sin - y - s(i)).max(0.0)) / point.q;
            let left = if left < -BEYOND_CAPACITY { 0.0 } else { point.q * left.max(NEAR_CAPACITY) };
            left * left / (2.0 * (point.k + point.c * point.c * (1.0 / m_t + point.xi * point.xi / J0)))
        };
        let pressed = self.points.iter().enumerate().map(to_capacity).fold(f64::INFINITY, f64::min);
        // 1 − cos θ is at most 0.55 sin² θ up to half a radian
        let turned = (pressed / (1.1 * weighs + leans)).sqrt();
        let raised = |sin: f64| {
            let y = self.level(sin, structure.base(), s);
            let e = y - self.y_s;
            let tendon = if P_0 + k_t * e > 0.0 { e * (P_0 + 0.5 * k_t * e) } else { 0.0 };
            let spring =
                |(i, point): (usize, &ContactPoint)| 0.5 * point.k * (y - point.xi * sin + s(i)).min(0.0).powi(2);
            let of_points = self.points.iter().enumerate().map(spring).sum::<f64>();
            of_points + tendon + m_t * g * y + weighs * (1.0 - sin * sin).sqrt() - 0.5 * leans * sin * sin
        };
        let rest = raised(sin);
        // beyond a barrier the structure falls over, or finds another rest
        let room = |way: f64| {
            let far = (sin + way * turned).clamp(-1.0, 1.0);
            let barrier = self.first_turn(structure, [sin, far], 6, s, &|back| way * back > 0.0);
            raised(barrier.unwrap_or(far)) - rest
        };
        (0.5 * pressed).min(room(1.0)).min(room(-1.0))
    }

    /// How far points have settled under a structure that was moved slowly to `state`.
    pub(crate) fn settled<Q: Coordinates>(&self, state: &State<Q>) -> Settlements {
        let footing = state.u.footing(self);
        let beyond = |point: &ContactPoint| (-footing.height(point.xi) - point.q / point.k).max(0.0);
        std::array::from_fn(|i| self.points.get(i).map_or(0.0, beyond))
    }

    /// The rates (m/s) at which points with this `contact`, on ground that has `settled` by so much (m), settle for good while the base is and
    /// moves like this (S7).
    pub(crate) fn settling(
        &self,
        contact: PressedPoints,
        [footing, rates]: [Footing; 2],
        settled: &[f64],
    ) -> Settlements {
        std::array::from_fn(|i| match self.points.get(i) {
            Some(point) if contact.yields(i) => {
                point.creep(footing.height(point.xi) + settled[i]) - rates.height(point.xi)
            }
            _ => 0.0,
        })
    }

    /// Lets points without a dashpot that yield at this place of the base have settled as far as their capacity holds it.
    pub(crate) fn hold(&self, contact: PressedPoints, footing: Footing, settled: &mut [f64]) {
        for (i, point) in self.points.iter().enumerate().filter(|(i, point)| contact.yields(*i) && point.c == 0.0) {
            settled[i] = -point.q / point.k - footing.height(point.xi);
        }
    }

    /// The points that carry the base in `state`.
    pub(crate) fn contact<Q: Coordinates>(&self, state: &State<Q>, settled: &[f64], base: &Base) -> PressedPoints {
        let bits = |is_so: &dyn Fn(usize, [f64; 2]) -> bool| -> u32 {
            heights(self, state, settled).enumerate().map(|(i, of)| u32::from(is_so(i, of)) << i).sum()
        };
        let pressed = bits(&|_, [depth, push]| depth > 0.0 && push > 0.0);
        let yields = bits(&|i, [_, push]| self.points[i].k * push >= self.points[i].q * (1.0 - ON_CAPACITY)) & pressed;
        let friction = match state.u_dot.slide(self) {
            Some(_) if pressed == 0 => Friction::Free,
            Some(x_dot) if x_dot != 0.0 => Friction::Slides(Side::of(x_dot)),
            _ => Friction::Sticks,
        };
        let Ties { P_0, k_t, .. } = base.ties;
        let is_slack = k_t > 0.0 && P_0 + k_t * (state.u.footing(self).y - self.y_s) < 0.0;
        PressedPoints { pressed, points: self.points.len() as u8, is_slack, yields, friction }
    }

    /// Whether the points may be in this `contact`.
    pub(crate) fn admits(&self, contact: PressedPoints) -> bool {
        let PressedPoints { pressed, points, yields, friction, .. } = contact;
        let is_of_points = self.points.len() == usize::from(points) && pressed >> points == 0 && yields & !pressed == 0;
        is_of_points && (yields == 0 || self.yields) && (friction == Friction::Sticks || self.mu_c.is_some())
    }

    /// The dissipators of a structure that was moved slowly to `state`.
    pub(crate) fn moved<Q: Coordinates>(&self, state: &State<Q>, base: &Base) -> Dissipators {
        let Footing { y, sin, .. } = state.u.footing(self);
        let moved = Dissipators::NEW.moved_to(base, |j| y - self.y_s - places(base)[j] * sin);
        Dissipators { hysteretic: 0.0, ..moved }
    }
}

/// Energy on ground that gives with these points pressed, J, zero at height zero of the unloaded ground (F8):
///
/// ```text
/// E = ½ m_t ẏ² + Σ ½ m [(u̇ + hθ̇)² + u² θ̇²] + ½ J θ̇² − ẏ [sin θ (Σ Γ u̇ + S_1 θ̇) + μ θ̇ cos θ] + Σ ½ k u²
///     + g [m_t y + S_1 cos θ − μ sin θ] + Σ ½ k e² + P_0 (y − y_s) + ½ k_t (y − y_s)² + Σ F²/(2 k_d)
/// ```
///
/// A slack tendon has −P_0²/(2 k_t). A base that slides adds ½ m_t ẋ² + ẋ [cos θ (Σ Γ u̇ + S_1 θ̇) − μ θ̇ sin θ].
pub(crate) fn energy(
    structure: &Structure,
    contact: PressedPoints,
    state: &State<Modes>,
    (dissipators, settled): Kept,
) -> f64 {
    let x = Instant::<f64, Modes>::of(structure, Phase::OnGround(contact), state, Load::NONE);
    let Some(ground @ Foundation { points, y_s, .. }) = structure.foundation() else { return mechanical(&x) };
    let (&Base { m_t, g, ties, .. }, S_1) = (structure.base(), structure.body().S_1);
    let [offset, rate] = [&x.u, &x.u_dot].map(|of| Modes::sum(structure, |j, mode| of.of(j) * mode.gamma));
    let (y, y_dot, turn) = (state.u.footing(ground).y, state.u_dot.footing(ground).y, x.turn);
    let across = turn.sin * (rate + S_1 * x.theta_dot) + offset * x.theta_dot * turn.cos;
    let pressed = points.iter().enumerate().filter(|(i, _)| contact.is_pressed(*i));
    let e = |i: usize, xi: f64| y - xi * turn.sin + settled[i];
    let of_points: f64 = pressed.map(|(i, point)| 0.5 * point.k * e(i, point.xi).powi(2)).sum();
    let x_dot = state.u_dot.slide(ground).unwrap_or(0.0);
    let along = turn.cos * (rate + S_1 * x.theta_dot) - offset * x.theta_dot * turn.sin;
    let [_, pair @ ..] = restraint::ties(structure.base(), dissipators, *y_s, contact.is_slack);
    let pulled = |tie: &Tie| (tie.force + tie.stiffness * (y - tie.lever * turn.sin)).powi(2) / (2.0 * ties.k_d);
    let of_pair: f64 = if ties.k_d > 0.0 { pair.iter().map(pulled).sum() } else { 0.0 };
    let e = if contact.is_slack { -ties.P_0 / ties.k_t } else { y - y_s };
    let of_tendon = e * (ties.P_0 + 0.5 * ties.k_t * e);
    let of_slide = x_dot * (0.5 * m_t * x_dot + along);
    mechanical(&x) + y_dot * (0.5 * m_t * y_dot - across) + of_slide + m_t * g * y + of_points + of_tendon + of_pair
}
