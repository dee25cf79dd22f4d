//! A base with modes that slides on [ground that gives](crate::structure::ground), or flies, and points that yield.
//!
//! The way of the middle x is an unknown more than in [`on_ground`](super::on_ground). In the axes of the structure its matrix is an arrow.
//! With β = a_g + ẍ, F = γ sin θ − β cos θ, G = γ cos θ + β sin θ, m' = m_t − Σ Γ S and the friction H = −ν N, ν = ±μ_c or 0 in flight:
//!
//! ```text
//! m' F − S_res θ̈ = sin θ N + ν cos θ N − Σ Γ e
//! m_t G − μ θ̈   = cos θ N − ν sin θ N + θ̇ (2 μ̇ + S_1 θ̇)                                                        (S3)
//! D θ̈ − S_res F − μ G = Σ m h e − θ̇ (θ̇ Σ m h u + 2 Σ m u u̇) − cos θ Σ ξ N
//! ```
//!
//! Forces on floors and ties add the terms that they have there.

use crate::levels::modes::Abreast;
use crate::levels::on_ground::{OnGround, Pushes};
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::series::taylor::{LONGEST_SPAN, Series, ZERO, product};
use crate::structure::ground::{ContactPoint, Footing, free_mass};
use crate::structure::mode::Modes;
use crate::{Base, Foundation, Mode, PressedPoints, State, Structure};

impl Foundation {
    /// Coefficient `n` of the power c ė² that the dashpots of points take which yield over `arc`, W.
    pub(super) fn power_of_yielding(&self, contact: PressedPoints, settled: &[f64], arc: &Arc<Modes>, n: usize) -> f64 {
        let of_point = |(i, point): (usize, &ContactPoint)| {
            let rate = point.creep(arc.u[0].footing(self).height(point.xi) + settled[i]);
            point.c * rate * rate * point.fades(2.0 * arc.span).nth(n).unwrap_or(0.0)
        };
        self.points.iter().enumerate().filter(|(i, _)| contact.yields(*i)).map(of_point).sum()
    }

    /// The longest span of a series while points yield, s: the rate of a point falls in the time c/k, which all orders together show.
    pub(super) fn longest_yielding(&self, contact: PressedPoints) -> f64 {
        let times = (0..self.points.len()).filter(|i| contact.yields(*i)).map(|i| self.points[i].c / self.points[i].k);
        times.filter(|time| *time > 0.0).fold(f64::INFINITY, f64::min) * LONGEST_SPAN / 2.0
    }
}

/// The acceleration of the middle of the base in `state` for each newton of friction, 1/kg (S4).
pub(crate) fn mobility<Q: Coordinates>(structure: &Structure, state: &State<Q>) -> f64 {
    let (&Base { m_t, J0, S_res, .. }, modes) = (structure.base(), structure.modes());
    let sum = |of: &dyn Fn(&Mode, f64) -> f64| modes.iter().enumerate().map(|(j, mode)| of(mode, state.u.of(j))).sum();
    let (offset, inertia): (f64, f64) = (sum(&|mode, u| mode.gamma * u), sum(&|mode, u| mode.mass * u * u));
    let ((sin, cos), free) = (libm::sincos(state.theta), free_mass(structure.base(), modes));
    let turning = J0 + inertia - S_res * S_res / free - offset * offset / m_t;
    cos * cos / free + sin * sin / m_t + (offset * sin / m_t - S_res * cos / free).powi(2) / turning
}

impl<V: Abreast> OnGround<V> {
    /// Writes the motion of a base that slides or flies with these pressed points into `arc` (S3).
    pub(super) fn slide(&self, contact: PressedPoints, start: &Start<Modes>, arc: &mut Arc<Modes>) {
        let &Start { ref state, a_g, a_top, a_v, settled, .. } = start;
        let structure = &self.subject.structure;
        let (&Base { m_t, J0, S_res, g, .. }, S_1) = (structure.base(), structure.body().S_1);
        let (under, modes) = (structure.ground(), structure.modes());
        let nu = contact.friction.sign() * under.mu_c.unwrap_or(0.0);
        let span = start.interval.min(self.longest_slide).min(under.longest_yielding(contact));
        let (carried, free) = (Pushes::of(under, contact, settled), free_mass(structure.base(), modes));
        let points = carried.with_ties(&self.subject, start, contact);
        let ramp = |value: f64, slope: f64| [value, slope * span];
        let (ground, weight) = (ramp(a_g.value, a_g.slope), ramp(g + a_v.value, a_v.slope));
        // of forces on floors: over the mass of each mode, and on mass that no mode carries
        let push = |j: usize| {
            let share = modes[j].share;
            ramp(share * a_g.value - a_top.value.of(j), share * a_g.slope - a_top.slope.of(j))
        };
        let on_rest = [0, 1].map(|i| ramp(a_top.value.rest[i], a_top.slope.rest[i]));
        let sum = |of: &dyn Fn(usize) -> f64| (0..modes.len()).map(of).sum::<f64>();
        let (sin_0, cos_0) = libm::sincos(state.theta);
        let mut state = *state;
        state.u.set_footing(under, Footing { sin: sin_0, ..state.u.footing(under) });
        state.u_dot.set_footing(under, Footing { sin: state.theta_dot * cos_0, ..state.u_dot.footing(under) });
        let place = under.slide().expect("the base may slide");
        let mut series: [Series; 13] = [ZERO; 13];
        let [sin, cos, mu, inertia, N, M, normal, F, G, square, turning, middle, forced] = &mut series;
        let mu_at = |u: &Modes| sum(&|j| modes[j].gamma * u.of(j));
        (sin[0], cos[0], mu[0]) = (sin_0, cos_0, mu_at(&state.u));
        inertia[0] = sum(&|j| modes[j].mass * state.u.of(j) * state.u.of(j));
        turning[0] = state.theta_dot * cos_0;
        let offset = mu[0];
        let D = J0 + inertia[0];
        let delta = D - S_res * S_res / free - offset * offset / m_t;
        let per_span = 1.0 / span;
        let truncation = self.truncation(start, span, true);
        arc.expand(&state, span, &truncation, |arc, order, per| {
            let n = order - 1;
            let rate = order as f64 * per_span;
            let (u, u_dot, theta_dot) = (&arc.u, &arc.u_dot, &arc.theta_dot);
            let at = |ramp: [f64; 2], k: usize| ramp.get(k).copied().unwrap_or(0.0);
            let times = |ramp: [f64; 2], of: &Series| ramp[0] * of[n] + if n > 0 { ramp[1] * of[n - 1] } else { 0.0 };
            let footing = [&u[n], &u_dot[n]].map(|of| of.footing(under));
            [N[n], M[n]] = points.forces(footing, n);
            [normal[n], _] = carried.forces(footing, n);
            square[n] = product(theta_dot, theta_dot, n);
            (sin[order], cos[order]) = (turning[n] * per, -product(theta_dot, sin, n) * per);
            mu[order] = mu_at(&u[order]);
            let products = |j: usize, to: usize| (0..=to).map(|i| u[i].of(j) * u[to - i].of(j)).sum::<f64>();
            inertia[order] = sum(&|j| modes[j].mass * products(j, order));
            let elastic = |j: usize| {
                let mode = &modes[j];
                (mode.stiffness * u[n].of(j) + mode.damping * u_dot[n].of(j)) / mode.mass
            };
            let spun = |j: usize| (0..=n).map(|i| square[i] * u[n - i].of(j)).sum::<f64>();
            forced[n] = sum(&|j| {
                let of = push(j);
                modes[j].mass * (of[0] * u[n].of(j) + if n > 0 { of[1] * u[n - 1].of(j) } else { 0.0 })
            });
            let on_floors = [0, 1].map(|i| on_rest[0][i] + sum(&|j| modes[j].gamma * push(j)[i]));
            let (weighed, hung) = (product(sin, N, n), product(cos, N, n));
            let (rubbed, slid) = (nu * product(cos, normal, n), nu * product(sin, normal, n));
            let r_F = weighed + rubbed - times(on_rest[0], cos) - sum(&|j| modes[j].gamma * elastic(j));
            let tail =
                |a: &Series, b: &Series, from: usize, to: usize| (from..=to).map(|i| a[i] * b[to - i]).sum::<f64>();
            let mu_dot = |k: usize| (k + 1) as f64 * per_span * mu[k + 1];
            let r_G = hung - slid
                + times(on_floors, sin)
                + S_1 * square[n]
                + rate * tail(mu, theta_dot, 1, order)
                + (0..=n).map(|i| theta_dot[i] * mu_dot(n - i)).sum::<f64>();
            let r_theta = sum(&|j| modes[j].mass * modes[j].height * (elastic(j) - spun(j))) + tail(mu, G, 1, n)
                - product(cos, M, n)
                - rate * tail(inertia, theta_dot, 1, order)
                + times(on_rest[1], cos)
                - product(sin, forced, n);
            let theta_ddot = (r_theta + S_res * r_F / free + offset * r_G / m_t) / delta;
            (F[n], G[n]) = ((r_F + S_res * theta_ddot) / free, (r_G + offset * theta_ddot) / m_t);
            let gamma = product(F, sin, n) + product(G, cos, n);
            let beta = product(G, sin, n) - product(F, cos, n);
            let rates = u_dot[n].footing(under);
            middle[n] = rates.y - points.lever * rates.sin;
            let (of_middle, of_turning) = (product(middle, middle, n), product(turning, turning, n));
            let power = points.taken * of_middle
                + points.left_for_turning * of_turning
                + under.power_of_yielding(contact, settled, arc, n);
            let along = |j: usize| {
                let mode = &modes[j];
                mode.share * F[n] + times(push(j), cos) + spun(j) - elastic(j) - mode.height * theta_ddot
            };
            let rates_of_modes: [f64; crate::structure::mode::MOST_MODES] =
                std::array::from_fn(|j| if j < modes.len() { along(j) * per } else { 0.0 });
            arc.u_dot[n].set_footing(under, Footing { taken: power, ..rates });
            let (new, new_rate) = (&mut arc.u[order], &mut arc.u_dot[order]);
            (0..modes.len()).for_each(|j| new_rate.set(j, rates_of_modes[j]));
            let new_theta_dot = theta_ddot * per;
            arc.theta_dot[order] = new_theta_dot;
            turning[order] = product(&arc.theta_dot, cos, order);
            let y_dot = (gamma - at(weight, n)) * per;
            new_rate.set_footing(under, Footing { y: y_dot, sin: turning[order], taken: power });
            new_rate.set(place, (beta - at(ground, n)) * per);
            let of = new.footing(under);
            new.set_footing(under, Footing { taken: power * per, ..of });
            new_theta_dot
        });
    }
}
