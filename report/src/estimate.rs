//! Demands without a time history, term by term (Eqs 4, 21 to 24).

use crate::quantities::NamedValue;
use anyhow::ensure;
use rocking::OneMass;
use rocking::estimates::demand::Demand;
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::run::record::Record;
use std::f64::consts::TAU;

/// The demand of a ground motion on a structure, without a time history.
pub struct Estimate {
    /// Demand while rocking (Eqs 21 to 24).
    pub demand: Demand,
    /// Demand on a fixed base (Eq 4) if there is a ground motion, then the demand while rocking, term by term.
    pub terms: Vec<NamedValue>,
}

impl Estimate {
    /// Of `structure` under `record`, or on ground at rest, with the dynamic amplification `C`, 0 to 2.
    pub fn new(structure: &OneMass, record: Option<&Record>, C: f64) -> anyhow::Result<Estimate> {
        ensure!(record.is_none_or(|record| record.force().is_none()), "Eqs 10 to 24 hold only without a force F_t");
        let spectral = |record| spectral_acceleration(record, TAU / structure.omega_u, structure.zeta_u);
        let S_a = record.map_or(0.0, spectral);
        let demand = Demand::new(structure, S_a, C)?;
        let &Demand { u_ddot_gr, ground, rocking, impact, a_t, V_t, M_t } = &demand;
        let term = NamedValue::new;
        let mut terms = Vec::new();
        if let Some(record) = record {
            let S_a = spectral_acceleration(record, TAU / structure.omega_fc, structure.parameters().zeta_fc);
            terms.extend([
                term("PGA", record.pga(), "m/s2", "", "peak ground acceleration"),
                term("S_a(T_fc, zeta_fc)", S_a, "m/s2", "Eq 4", "lateral acceleration on a fixed base"),
                term("V_fc", structure.parameters().m * S_a, "N", "Eq 4", "base shear on a fixed base"),
            ]);
        }
        terms.extend([
            term("T_u", TAU / structure.omega_u, "s", "before Eq 18", "period of the vibration mode while rocking"),
            term("zeta_u", structure.zeta_u, "1", "before Eq 18", "damping ratio of the vibration mode while rocking"),
            term("S_a(T_u, zeta_u)", S_a, "m/s2", "after Eq 20", "absolute spectral acceleration at T_u and zeta_u"),
            term("C", C, "1", "Eq 21", "dynamic amplification at a transition between rocking phases"),
            term(
                "u_ddot_gr",
                u_ddot_gr,
                "m/s2",
                "Eq 21",
                "elastic acceleration at a transition between rocking phases",
            ),
            term("(1-chi) S_a", ground, "m/s2", "Eq 22", "vibration that the ground excites"),
            term("chi g tan", rocking, "m/s2", "Eq 22", "rocking mode, chi g tan(alpha_cg)"),
            term("C chi g tan", impact, "m/s2", "Eq 22", "vibration that the transition excites"),
            term("a_t", a_t, "m/s2", "Eq 22", "lateral acceleration: (1-chi) S_a + (1+C) chi g tan"),
            term("V_t", V_t, "N", "Eq 23", "base shear m a_t"),
            term("M_t", M_t, "N.m", "Eq 24", "overturning moment m H a_t"),
        ]);
        Ok(Estimate { demand, terms })
    }
}
