//! A structure of one mass: its parameters and the constants that follow from them (before Eq 11, after 4, 8 and 13, before 18).

use crate::structure::base::Base;
use crate::structure::mode::Mode;
use crate::structure::parameters::{Parameters, Ties};
use crate::structure::quantity::Refused;
use std::f64::consts::TAU;

/// A structure: checked parameters and the constants that the equations use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneMass {
    parameters: Parameters,
    /// Mass ratio γ = (m + m0)/m (text before Eq 1).
    pub gamma: f64,
    /// Circular frequency in full contact ω_fc = 2π f_fc, rad/s.
    pub omega_fc: f64,
    /// Stiffness of the strut k = m ω_fc², N/m.
    pub k: f64,
    /// Viscous damping in full contact c_fc = 2 ζ_fc √(k m), N·s/m.
    pub c_fc: f64,
    /// Viscous damping while rocking c_u, N·s/m.
    pub c_u: f64,
    /// Modal participation χ = H p_l²/g (after Eq 13).
    pub chi: f64,
    /// 1 − χ = (J_P − m H²)/J_P, free of cancellation.
    pub one_minus_chi: f64,
    /// Critical displacement u_cr = (g tan α_cg + P_0 B/(m H))/ω_fc², m (after Eq 4): uplift of a base at rest.
    pub u_cr: f64,
    /// Circular frequency of the vibration mode while rocking ω_u = ω_fc/√(1−χ), rad/s (before Eq 18).
    pub omega_u: f64,
    /// Bound of the rates of rocking, 1/s: ω_u and p_l, with the stiffness and the damping that the ties add to them.
    pub(crate) rocking_rate: f64,
    pub(crate) base: Base,
    pub(crate) mode: Mode,
    /// ω_fc² = k/m, 1/s².
    pub(crate) stiffness: f64,
    /// c_fc/m, 1/s.
    pub(crate) damping_fc: f64,
    /// c_u/m, 1/s.
    pub(crate) damping_u: f64,
    /// (J0 + m0 B²)/m, m².
    pub(crate) foundation: f64,
    /// Damping ratio of the vibration mode ζ_u = c_u/(2√(k m (1−χ))) (before Eq 18).
    pub zeta_u: f64,
}

impl OneMass {
    /// Derives a structure from its parameters, or returns the first parameter that is out of range.
    pub fn new(parameters: Parameters) -> Result<OneMass, Refused> {
        parameters.check()?;
        let Parameters { m, m0, H, B, J0, f_fc, zeta_fc, c_ratio, r, g, .. } = parameters;
        let ties @ Ties { P_0, .. } = Ties::of(&parameters);
        let gamma = (m + m0) / m;
        let omega_fc = TAU * f_fc;
        let k = m * omega_fc * omega_fc;
        let c_fc = 2.0 * zeta_fc * m * omega_fc;
        let c_u = c_ratio * c_fc;
        let foundation_and_offset = J0 + (m + m0) * B * B;
        let J_P = foundation_and_offset + m * H * H;
        let chi = m * H * H / J_P;
        let one_minus_chi = foundation_and_offset / J_P;
        let tan_alpha_cg = gamma * B / H;
        let (p_l, omega_u) = ((m * g * H / J_P).sqrt(), omega_fc / one_minus_chi.sqrt());
        let foundation = (J0 + m0 * B * B) / m;
        let inertia = m * (foundation + B * B);
        let [springs, dampers] = [0, 1].map(|i| ties.about_pivot(B).iter().map(|(_, of)| of[i]).sum::<f64>());
        let rocking_rate = (omega_u * omega_u + springs / inertia).sqrt().max(p_l).max(dampers / inertia);
        Ok(OneMass {
            parameters,
            base: Base { m_t: m + m0, m0, S_res: 0.0, B, J0, J_P, r: Some(r), g, c_ratio, p_l, tan_alpha_cg, ties },
            mode: Mode { mass: m, gamma: m, share: 1.0, height: H, stiffness: k, damping: c_fc },
            gamma,
            omega_fc,
            k,
            c_fc,
            c_u,
            chi,
            one_minus_chi,
            u_cr: (g * tan_alpha_cg + P_0 * B / (m * H)) / (omega_fc * omega_fc),
            omega_u,
            rocking_rate,
            stiffness: omega_fc * omega_fc,
            damping_fc: c_fc / m,
            damping_u: c_u / m,
            foundation,
            zeta_u: c_u / (2.0 * (k * m * one_minus_chi).sqrt()),
        })
    }

    /// The rigid base.
    pub fn base(&self) -> &Base {
        &self.base
    }

    /// The parameters that this structure was derived from.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }
}
