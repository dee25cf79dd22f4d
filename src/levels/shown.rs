//! What a level shows of a motion: the outputs at an instant, and over a step as series in time like the motion itself.
//!
//! δ_t (Eq 26) and a_t (Eq 27) are sums and products of the series of θ, u, sin θ and cos θ. They tell *where* an output is
//! largest; what it is there is evaluated from the state. At the rigid level a_t is that of [`rigid`].

use crate::levels::detail::{Detail, Model};
use crate::levels::level::Now;
use crate::levels::output_series::{Turn, delta_t_bound};
use crate::levels::rigid;
use crate::mechanics::load::LinearLoad;
use crate::mechanics::outputs::damping;
use crate::series::extremes::{self, Bound};
use crate::series::taylor::{Arc, Series, product};
use crate::{Outputs, Phase, State};

impl Model {
    fn is_rigid(&self) -> bool {
        self.detail == Detail::Rigid
    }

    /// The outputs in `phase`.
    #[inline]
    pub(crate) fn outputs(&self, phase: Phase, now: &Now) -> Outputs {
        let outputs = Outputs::of(&self.structure, phase, now.state, now.load.F_t);
        if self.is_rigid() { self.with_rigid_a_t(outputs, phase, now) } else { outputs }
    }

    fn with_rigid_a_t(&self, outputs: Outputs, phase: Phase, now: &Now) -> Outputs {
        let [_, theta_ddot] = self.level.accelerations(&self.structure, phase, now);
        outputs.with_a_t(&self.structure, rigid::a_t(&self.structure, phase, now.state, theta_ddot, now.load))
    }

    /// Time derivatives of the outputs under `load`, given (ü, θ̈) and (u⃛, θ⃛).
    pub(crate) fn output_rates(
        &self,
        phase: Phase,
        state: &State,
        [accelerations, jerks]: [[f64; 2]; 2],
        load: LinearLoad,
    ) -> Outputs {
        let rates = Outputs::rates_by(&self.structure, phase, state, accelerations, load);
        if self.is_rigid() {
            let of_theta = [accelerations[1], jerks[1]];
            return rates.with_a_t(&self.structure, rigid::a_t_rate(&self.structure, phase, state, of_theta, load));
        }
        rates
    }

    /// δ_t over `arc` (Eq 26).
    pub(crate) fn delta_t_series(&self, phase: Phase, arc: &Arc, turn: &Turn) -> Series {
        let &crate::Parameters { H, B, .. } = self.structure.parameters();
        let offset = phase.side().sign() * B;
        arc.series(|k| {
            let elastic = product(&arc.u, &turn.cos, k);
            let one = if k == 0 { 1.0 } else { 0.0 };
            offset * (one - turn.cos[k]) + elastic + H * turn.sin[k]
        })
    }

    /// a_t over `arc` under `load`, by Eq 5: g sin θ − (c u̇ + k u)/m + (F_t/m) cos θ.
    pub(crate) fn a_t_series(&self, phase: Phase, load: LinearLoad, arc: &Arc, turn: &Turn) -> Series {
        let structure = &self.structure;
        if self.is_rigid() {
            return rigid::a_t_series(structure, phase, load, arc, turn);
        }
        let &crate::Parameters { m, g, .. } = structure.parameters();
        let damping = damping(structure, phase) / m;
        let (push, push_slope) = (load.value.F_t / m, load.slope.F_t / m * arc.span);
        arc.series(|k| {
            let elastic = damping * arc.u_dot[k] + structure.stiffness * arc.u[k];
            let pushed = push * turn.cos[k] + if k > 0 { push_slope * turn.cos[k - 1] } else { 0.0 };
            g * turn.sin[k] - elastic + pushed
        })
    }

    /// Bounds of |θ|, |u|, |δ_t| and |a_t| that follow from those of |θ|, |u| and |u̇|; `F_t` is that of |F_t|. At the rigid
    /// level these do not bound a_t, nor is there anything crude that does.
    pub(crate) fn crude_bounds(&self, phase: Phase, F_t: f64, [theta, u, u_dot]: [f64; 3]) -> [f64; 4] {
        let structure = &self.structure;
        let &crate::Parameters { m, H, B, g, .. } = structure.parameters();
        let a_t = if self.is_rigid() {
            f64::INFINITY
        } else {
            g * theta + structure.stiffness * u + (damping(structure, phase) * u_dot + F_t) / m
        };
        [theta, u, u + H * theta + B * theta * theta / 2.0, a_t]
    }

    /// Bounds of |θ|, |u|, |δ_t| and |a_t| over `arc` under `load`: of what is linear in θ and u, and of the rest.
    pub(crate) fn bounds(&self, phase: Phase, load: LinearLoad, arc: &Arc) -> [Bound; 4] {
        let structure = &self.structure;
        if self.is_rigid() {
            return rigid::bounds(structure, phase, load, arc);
        }
        let &crate::Parameters { m, H, g, .. } = structure.parameters();
        let (stiffness, damping) = (structure.stiffness, damping(structure, phase) / m);
        let push = [load.value.F_t / m, load.slope.F_t / m * arc.span];
        let row = |k: usize| {
            let (theta, u) = (arc.theta[k], arc.u[k]);
            let push = if k < 2 { push[k] } else { 0.0 };
            [theta, u, u + H * theta, g * theta - damping * arc.u_dot[k] - stiffness * u + push]
        };
        let [theta, u, sway, pull] = extremes::bounds(row, arc.order, arc.reach);
        let (most_theta, theta_rate, most_push) = (theta.largest(), theta.rate[1], push[0].abs() + push[1].abs());
        let square = most_theta * most_theta;
        let a_t = square * (g * most_theta / 6.0 + most_push / 2.0);
        let a_t_rate = most_theta * theta_rate * (g * most_theta / 2.0 + most_push) + square * push[1].abs() / 2.0;
        [theta, u, delta_t_bound(structure, theta, u, sway), pull.and(a_t, a_t_rate)]
    }
}
