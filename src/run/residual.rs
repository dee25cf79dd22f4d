//! What is left at the end of a run on ground that slips and yields: the way of the base, and the rest on the settled ground.

use crate::engine::motion::Motion;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::Dissipators;
use crate::structure::ground::Foundation;
use crate::{Base, Phase, Structure, Ties};

/// A number of the end of a run.
#[derive(Debug)]
#[allow(missing_docs)]
pub struct Residual {
    pub name: &'static str,
    pub unit: &'static str,
    pub description: &'static str,
    is_of: fn(&Foundation) -> bool,
}

const fn residual(
    name: &'static str,
    unit: &'static str,
    description: &'static str,
    is_of: fn(&Foundation) -> bool,
) -> Residual {
    Residual { name, unit, description, is_of }
}

const SLIDES: fn(&Foundation) -> bool = |of| of.mu_c.is_some();
const YIELDS: fn(&Foundation) -> bool = |of| of.yields;

/// The numbers, in the order in which they are shown.
pub const RESIDUALS: [Residual; 8] = [
    residual("x_end", "m", "way of the base at the end", SLIDES),
    residual("slip_path", "m", "sum of the slips", SLIDES),
    residual("E_friction", "J", "energy that friction has taken", SLIDES),
    residual("theta_res", "rad", "rotation at rest on the settled ground", YIELDS),
    residual("settlement_res", "m", "settlement at rest of the lower outer point", YIELDS),
    residual("tilt", "rad", "rotation of the settled points", YIELDS),
    residual("settled", "m", "mean settlement of the points for good", YIELDS),
    residual("E_plastic", "J", "energy that settling for good has taken", YIELDS),
];

impl Residual {
    /// The numbers that a run of `structure` leaves.
    pub fn all(structure: &Structure) -> impl Iterator<Item = &'static Residual> {
        let foundation = structure.foundation().cloned();
        RESIDUALS.iter().filter(move |of| foundation.as_ref().is_some_and(of.is_of))
    }

    /// Its value after `motion` of `structure`. The rest of a structure that has overturned, or that has none, is NaN.
    pub fn of<Q: Coordinates>(&self, structure: &Structure, motion: &Motion<Q>) -> f64 {
        let Some(ground) = Q::foundation(structure) else { return f64::NAN };
        let Motion { phase, state, dissipators: Dissipators { slip, friction, settling, .. }, .. } = motion;
        let s = |i: usize| state.u.settlement(ground, i);
        let rest = || match phase {
            Phase::Overturned(_) => [f64::NAN; 2],
            _ => at_rest(ground, structure, &s),
        };
        match self.name {
            "x_end" => state.u.slide(ground).unwrap_or(f64::NAN),
            "slip_path" => *slip,
            "E_friction" => *friction,
            "tilt" => ground.residual(s, 1),
            "settled" => ground.residual(s, 0),
            "E_plastic" => *settling,
            "theta_res" => libm::asin(rest()[1]),
            _ => {
                let [y, sin] = rest();
                let outer = [0, ground.points.len() - 1].map(|i| y - ground.points[i].xi * sin);
                -outer[0].min(outer[1])
            }
        }
    }
}

/// Most steps towards rest.
const MOST_STEPS: usize = 200;

/// y (m) and sin θ of `structure` at rest on points that have settled by `s` (m), NaN if none is found near the tilt of the points: Σ N =
/// m_t g + P and Σ ξ N = g S_1 tan θ + g² sin θ Σ Γ²/(μ ω²), with N = min(q, k max(0, −e)).
fn at_rest(ground: &Foundation, structure: &Structure, s: &impl Fn(usize) -> f64) -> [f64; 2] {
    let (&Base { m_t, g, ties: Ties { P_0, k_t, .. }, .. }, S_1) = (structure.base(), structure.body().S_1);
    let leans = structure.modes().iter().map(|mode| (g * mode.gamma).powi(2) / mode.stiffness).sum::<f64>();
    let (mut y, mut sin) = (ground.y_s - ground.residual(s, 0), libm::sin(ground.residual(s, 1)));
    for _ in 0..MOST_STEPS {
        let pull = P_0 + k_t * (y - ground.y_s);
        let (taut, cos) = (f64::from(pull > 0.0), (1.0 - sin * sin).sqrt());
        let mut missing = [m_t * g + pull.max(0.0), (g * S_1 / cos + leans) * sin];
        let [mut k_0, mut k_1, mut k_2] = [taut * k_t, 0.0, g * S_1 / cos.powi(3) + leans];
        k_2 = -k_2;
        for (i, point) in ground.points.iter().enumerate() {
            let force = (-point.k * (y - point.xi * sin + s(i))).clamp(0.0, point.q);
            missing = [missing[0] - force, missing[1] - point.xi * force];
            if force > 0.0 && force < point.q {
                (k_0, k_1, k_2) = (k_0 + point.k, k_1 + point.k * point.xi, k_2 + point.k * point.xi * point.xi);
            }
        }
        // of y and sin θ the forces change by −k_0 Δy + k_1 Δ sin θ, the moments by −k_1 Δy + k_2 Δ sin θ
        let determinant = k_1 * k_1 - k_0 * k_2;
        let by =
            [(k_2 * missing[0] - k_1 * missing[1]) / determinant, (k_1 * missing[0] - k_0 * missing[1]) / determinant];
        let last = [y, sin];
        (y, sin) = (y + by[0], (sin + by[1]).clamp(-0.999, 0.999));
        if (y - last[0]).abs() <= 1e-14 * y.abs() && (sin - last[1]).abs() <= 1e-15 {
            return [y, sin];
        }
    }
    [f64::NAN; 2]
}
