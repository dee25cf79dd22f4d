//! Ground that gives under a base: the pressed points, rest, the ties between the base and the ground, energy.

use crate::mechanics::energy::mechanical;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::restraint::{Angles, Dissipators, Restraint, Restraints, Tie, pair};
use crate::numbers::{Angle, Number};
use crate::structure::ground::{Footing, Point};
use crate::structure::mode::Modes;
use crate::{Base, Contact, Foundation, Load, Phase, Side, State, Structure, Ties};

/// min(−e, f/k) of each point, m: positive if the point is pressed.
pub(crate) fn margins<Q: Coordinates>(foundation: &Foundation, state: &State<Q>) -> impl Iterator<Item = f64> {
    let footing = [state.u, state.u_dot].map(|q| q.footing(foundation));
    foundation.points.iter().map(move |&Point { xi, k, c }| {
        let [e, rate] = footing.map(|of| of.height(xi));
        (-e).min(-(e + c / k * rate))
    })
}

impl Foundation {
    /// `state` of a structure that is held at its rotation and lowered until the ground carries it, with a rate at which the forces of the
    /// springs start without a rate of their sum.
    pub(crate) fn begin<Q: Coordinates>(&self, state: &State<Q>, base: &Base) -> State<Q> {
        let (sin, cos) = libm::sincos(state.theta);
        let [y, slope] = if sin == 0.0 { [self.rest, 0.0] } else { self.held_at(sin, base) };
        let (mut begun, turning) = (*state, state.theta_dot * cos);
        begun.u.set_footing(self, Footing { y, sin, taken: 0.0 });
        begun.u_dot.set_footing(self, Footing { y: slope * turning, sin: turning, taken: 0.0 });
        begun
    }

    /// The points that carry the base in `state`.
    pub(crate) fn contact<Q: Coordinates>(&self, state: &State<Q>, base: &Base) -> Contact {
        let pressed = margins(self, state).enumerate().map(|(i, margin)| u32::from(margin > 0.0) << i).sum();
        let Ties { P_0, k_t, .. } = base.ties;
        let is_slack = k_t > 0.0 && P_0 + k_t * (state.u.footing(self).y - self.rest) < 0.0;
        Contact { pressed, points: self.points.len() as u8, is_slack }
    }

    /// The dissipators of a structure that was moved slowly to `state`.
    pub(crate) fn moved<Q: Coordinates>(&self, state: &State<Q>, base: &Base) -> Dissipators {
        let (Ties { xi_d, k_d, F_y, .. }, mut moved) = (base.ties, Dissipators::NEW);
        for (j, xi) in [xi_d, -xi_d].into_iter().enumerate().filter(|_| k_d > 0.0) {
            let elongation = state.u.footing(self).y - self.rest - xi * state.u.footing(self).sin;
            moved.plastic[j] = elongation - elongation.clamp(-F_y / k_d, F_y / k_d);
        }
        moved
    }
}

/// The tendon and both dissipators of `base` on ground that gives, at ξ in the place of a lever: a tie elongates by y − y_s − ξ sin θ and
/// pulls with F_0 + k (y − ξ sin θ) + c (ẏ − ξ θ̇ cos θ). `rest` is y_s.
pub(crate) fn ties_on_ground(base: &Base, rest: f64, dissipators: &Dissipators, contact: Contact) -> [Tie; 3] {
    let Ties { P_0, k_t, xi_d, .. } = base.ties;
    let [first, second] = pair(base, dissipators, [xi_d, -xi_d], dissipators.plastic.map(|plastic| plastic + rest));
    let [force, stiffness] = if contact.is_slack { [0.0; 2] } else { [P_0 - k_t * rest, k_t] };
    [Tie { lever: 0.0, force, stiffness, damping: 0.0 }, first, second]
}

/// The forces of `ties` on ground that gives, given the footing and its rates, N.
fn forces_on_ground<N: Number>(ties: &[Tie; 3], [footing, rates]: [Footing<N>; 2]) -> Restraints<N> {
    let [P_t, F_d1, F_d2] = ties.map(|Tie { lever, force, stiffness, damping }| {
        N::constant(force) + footing.height(lever) * stiffness + rates.height(lever) * damping
    });
    Restraints { P_t, F_d1, F_d2 }
}

/// The forces of the restraints at the instant `x`, N, at the `angles` of its level with the dissipators in this state.
pub(crate) fn restraints<N: Angle, Q: Lateral<N>>(
    x: &Instant<N, Q>,
    angles: Angles,
    dissipators: &Dissipators,
) -> Restraints<N> {
    if let Some(ground) = Q::foundation(x.structure) {
        let ties = ties_on_ground(x.base(), ground.rest, dissipators, x.contact);
        return forces_on_ground(&ties, x.footing(ground));
    }
    Restraint::about(x.base(), Side::of(x.s), dissipators).forces(&angles.chord(x.theta, x.theta_dot))
}

/// Energy on ground that gives with these points pressed, J, zero at height zero of the unloaded ground (F8):
///
/// ```text
/// E = ½ m_t ẏ² + Σ ½ m [(u̇ + hθ̇)² + u² θ̇²] + ½ J θ̇² − ẏ [sin θ (Σ Γ u̇ + S_1 θ̇) + μ θ̇ cos θ] + Σ ½ k u²
///     + g [m_t y + S_1 cos θ − μ sin θ] + Σ ½ k e² + P_0 (y − y_s) + ½ k_t (y − y_s)² + Σ F²/(2 k_d)
/// ```
///
/// A slack tendon has −P_0²/(2 k_t).
pub fn energy(structure: &Structure, contact: Contact, state: &State<Modes>, dissipators: &Dissipators) -> f64 {
    let x = Instant::<f64, Modes>::of(structure, Phase::OnGround(contact), state, Load::NONE);
    let Some(ground @ Foundation { points, rest, .. }) = structure.foundation() else { return mechanical(&x) };
    let (&Base { m_t, g, ties, .. }, S_1) = (structure.base(), structure.body().S_1);
    let [offset, rate] = [x.sum(|j, mode| x.u.of(j) * mode.gamma), x.sum(|j, mode| x.u_dot.of(j) * mode.gamma)];
    let (y, y_dot, turn) = (state.u.footing(ground).y, state.u_dot.footing(ground).y, x.turn);
    let across = turn.sin * (rate + S_1 * x.theta_dot) + offset * x.theta_dot * turn.cos;
    let pressed = points.iter().enumerate().filter(|(i, _)| contact.is_pressed(*i));
    let of_points: f64 = pressed.map(|(_, point)| 0.5 * point.k * (y - point.xi * turn.sin).powi(2)).sum();
    let [_, pair @ ..] = ties_on_ground(structure.base(), *rest, dissipators, contact);
    let pulled = |tie: &Tie| (tie.force + tie.stiffness * (y - tie.lever * turn.sin)).powi(2) / (2.0 * ties.k_d);
    let of_pair: f64 = if ties.k_d > 0.0 { pair.iter().map(pulled).sum() } else { 0.0 };
    let e = if contact.is_slack { -ties.P_0 / ties.k_t } else { y - rest };
    let of_tendon = e * (ties.P_0 + 0.5 * ties.k_t * e);
    mechanical(&x) + y_dot * (0.5 * m_t * y_dot - across) + m_t * g * y + of_points + of_tendon + of_pair
}
