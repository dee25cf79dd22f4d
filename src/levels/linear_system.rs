//! A linear model of rocking about side s: what the levels of detail with linear equations share.
//!
//! ```text
//! ü = U_u u + U_u̇ u̇ + U_θ θ + U_a (a_g − F_t/m) + s U_s
//! θ̈ = T_u u + T_u̇ u̇ + T_θ θ + T_a (a_g − F_t/m) + s T_s
//! ```

use crate::Side;
use crate::levels::level::{Pace, Rates};
use crate::mechanics::instant::Second;
use crate::numbers::bend::Bend;
use crate::series::taylor::{Arc, Start};

/// Coefficients of u, u̇, θ, a_g − F_t/m and s in one equation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub u: f64,
    pub u_dot: f64,
    pub theta: f64,
    pub a_top: f64,
    pub side: f64,
}

/// Both equations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearSystem {
    pub u_ddot: Row,
    pub theta_ddot: Row,
}

impl Row {
    /// The terms of the loads.
    #[inline]
    fn forcing(&self, a_top: f64, side: f64) -> f64 {
        self.a_top * a_top + self.side * side
    }
}

impl LinearSystem {
    /// Bounds of (ü, θ̈) and of their derivatives, given bounds of the motion. The load has no second derivative.
    pub(crate) fn second(&self, rates: &Rates) -> Second<Bend> {
        let &Rates { u_dot, u_ddot, u_dddot, theta_dot, theta_ddot, .. } = rates;
        let sum = |row: &Row, u: f64, u_dot: f64, theta: f64| {
            row.u.abs() * u + row.u_dot.abs() * u_dot + row.theta.abs() * theta
        };
        let [u_bend, theta_bend] = [&self.u_ddot, &self.theta_ddot].map(|row| sum(row, u_ddot, u_dddot, theta_ddot));
        let theta_rate = sum(&self.theta_ddot, u_dot, u_ddot, theta_dot);
        Second {
            u_ddot: Bend { value: u_ddot, rate: u_dddot, bend: u_bend },
            theta_ddot: Bend { value: theta_ddot, rate: theta_rate, bend: theta_bend },
        }
    }

    /// Writes the motion from `start` about `side` into `arc`.
    pub(crate) fn series(&self, pace: &Pace, side: Side, start: &Start, arc: &mut Arc) {
        let &Start { state, a_top, .. } = start;
        let span = pace.span(start);
        let rows = [&self.u_ddot, &self.theta_ddot];
        let mut forcing = rows.map(|row| row.forcing(a_top.value, side.sign()));
        let mut next_forcing = rows.map(|row| row.forcing(a_top.slope * span, 0.0));
        let mut u_dot = state.u_dot;
        arc.expand(&state, span, pace.truncation(start, span), |arc, k, per| {
            let (u, theta) = (arc.u[k - 1], arc.theta[k - 1]);
            // what the last order of u̇ adds comes last: only that has to be waited for
            let [u_rate, theta_rate] = [0, 1].map(|i| {
                let row = rows[i];
                (row.u * u + row.theta * theta + forcing[i]) * per + row.u_dot * per * u_dot
            });
            (forcing, next_forcing) = (next_forcing, [0.0; 2]);
            u_dot = u_rate;
            (u_rate, theta_rate)
        });
    }
}
