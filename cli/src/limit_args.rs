//! Arguments for the limits of the model; a value beyond its limit gives a warning.

use rocking::Refused;
use rocking::run::validity::Limits;

#[derive(clap::Args)]
#[command(next_help_heading = "Limits of the model")]
pub struct LimitArgs {
    /// Coefficient of friction of the ground, a limit of |R_h|/R_v and |I_h|/I_v [of concrete cast against smooth formwork:
    /// EN 1992-1-1, 6.2.5(2)]
    #[arg(long, value_name = "MU", default_value_t = Limits::default().friction, allow_hyphen_values = true)]
    friction: f64,
    /// Largest tension at the base without a warning, as a fraction of the weight, or of the impulse of an impact
    #[arg(long, value_name = "PART", default_value_t = Limits::default().tension, allow_hyphen_values = true)]
    tension: f64,
    /// Smallest load of the edge in contact without a warning, as a fraction of the weight
    #[arg(long, value_name = "PART", default_value_t = Limits::default().edge_load, allow_hyphen_values = true)]
    edge_load: f64,
    /// Largest energy gained at an impact without a warning, as a fraction of the kinetic energy before it
    #[arg(long, value_name = "PART", default_value_t = Limits::default().energy_gain, allow_hyphen_values = true)]
    energy_gain: f64,
}

impl LimitArgs {
    pub fn limits(&self) -> Result<Limits, Refused> {
        let &LimitArgs { friction, tension, edge_load, energy_gain } = self;
        let limits = Limits { friction, tension, edge_load, energy_gain };
        limits.check().map(|()| limits)
    }
}
