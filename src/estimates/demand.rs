//! Demands without a time history (Eqs 21–24).
//!
//! ```text
//! ü_gr,max = C χ/(1−χ) g tan α_cg                                                                      (21)
//! a_t,max  = (1−χ) S_a(T_u, ζ_u) + (1+C) χ g tan α_cg                                                  (22)
//! V_t,max  = m a_t,max                                                                                 (23)
//! M_t,max  = m H a_t,max                                                                               (24)
//! ```
//!
//! S_a is the absolute acceleration spectrum of the ground motion at the vibration mode while rocking
//! ([`crate::estimates::response_spectrum`]). C is the dynamic amplification of the weight's change of sides at an impact: 2 for
//! an instant change that meets a quiet structure, down to 0 for a slow one.
//!
//! The equations are for a structure that its weight alone turns back. A structure with a tendon or dissipators is an error.

use crate::OneMass;
use crate::structure::parameters::TIES;
use crate::structure::quantity::{Quantity, Refused, ensure};

/// The amplification C of an instant transition, and its largest value.
pub const INSTANT_TRANSITION: f64 = 2.0;

/// Refuses a `structure` with a tendon or dissipators, which the equations do not include.
pub(crate) fn check_is_free(structure: &OneMass) -> Result<(), Refused> {
    ensure(!structure.base().is_restrained(), || {
        let ties = TIES.iter().map(|of| (of, (of.get)(&structure.base().ties))).filter(|(_, value)| *value > 0.0);
        let ties =
            ties.map(|(of, value)| format!("{} = {value:?} {}", of.name, of.unit)).collect::<Vec<_>>().join(", ");
        format!("Eqs 10 to 24 hold only without tendon and dissipators, but {ties}: simulate the motion instead")
    })
}

/// The demands on a rocking structure, term by term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// Largest elastic acceleration excited by the weight's change of sides, ü_gr,max, m/s² (Eq 21).
    pub u_ddot_gr: f64,
    /// Vibration that the ground excites: (1−χ) S_a, m/s² (Eq 22).
    pub ground: f64,
    /// Rocking mode: χ g tan α_cg, m/s² (Eq 22).
    pub rocking: f64,
    /// Vibration that the change of sides excites: C χ g tan α_cg = (1−χ) ü_gr,max, m/s² (Eq 22).
    pub impact: f64,
    /// Lateral acceleration of the top mass: the sum of the three terms, m/s² (Eq 22).
    pub a_t: f64,
    /// Base shear, N (Eq 23).
    pub V_t: f64,
    /// Overturning moment, N·m (Eq 24).
    pub M_t: f64,
}

impl Demand {
    /// The demand from the spectral acceleration `S_a` = S_a(T_u, ζ_u) (m/s²) and the amplification `C`, 0 to 2.
    pub fn new(structure: &OneMass, S_a: f64, C: f64) -> Result<Demand, Refused> {
        let description = "dynamic amplification at a transition between rocking phases; 2 for an instant one";
        Quantity::limit("C", "1", [0.0, INSTANT_TRANSITION], description).check(C)?;
        check_is_free(structure)?;
        let &crate::Parameters { m, H, g, .. } = structure.parameters();
        let ground = structure.one_minus_chi * S_a;
        let rocking = structure.chi * g * structure.base().tan_alpha_cg;
        let impact = C * rocking;
        let a_t = ground + rocking + impact;
        Ok(Demand {
            u_ddot_gr: impact / structure.one_minus_chi,
            ground,
            rocking,
            impact,
            a_t,
            V_t: m * a_t,
            M_t: m * H * a_t,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::nonlinear::accelerations;
    use crate::mechanics::load::Load;
    use crate::mechanics::restraint::Dissipators;
    use crate::{Parameters, Side, State};
    use approx::assert_relative_eq;

    /// The paper: 0.66 g for McManus with C = 2; Eq 13 gives 0.34 g for Evison with the χ of its table, 0.92 for 0.91.
    #[test]
    fn the_specimens_have_the_numbers_of_the_paper() {
        let in_g = |parameters, C| {
            let demand = Demand::new(&OneMass::new(parameters).unwrap(), 0.0, C).unwrap();
            format!("{:.4}", demand.a_t / parameters.g)
        };
        assert_eq!(in_g(Parameters::MCMANUS, 2.0), "0.6585");
        assert_eq!(in_g(Parameters::EVISON, 0.0), "0.3333");
        let tan_alpha_cg = OneMass::new(Parameters::EVISON).unwrap().base().tan_alpha_cg;
        assert_eq!(format!("{:.2}", 0.92 * tan_alpha_cg), "0.34");
    }

    /// The structure is at rest at the static displacement of one side. By Eqs 5 and 6 a change of sides then accelerates the top
    /// mass by ü_gr,max for C = 2, up to terms in g/(ω_u² H) that Eq 18 neglects.
    #[test]
    fn an_instant_change_of_sides_accelerates_as_equation_21_says() {
        let structure = OneMass::new(Parameters { f_fc: 1e3, ..Parameters::MCMANUS }).unwrap();
        let demand = Demand::new(&structure, 0.0, INSTANT_TRANSITION).unwrap();
        let quiet = State { u: structure.chi * structure.u_cr, ..State::default() };
        let u_ddot = accelerations(&structure, Side::Left, &quiet, Load::default(), &Dissipators::NEW).unwrap()[0];
        assert_relative_eq!(u_ddot, -demand.u_ddot_gr, max_relative = 1e-5);
    }
}
