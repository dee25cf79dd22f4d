//! A ball that bounces. The page `docs/dev/write_an_fmu.md` walks through this example, which writes the FMU of the ball.

use fmi_unit::{Causality::*, *};
use model_description::archive;
use std::{error::Error, path::Path, sync::Arc};

const REST: f64 = 1e-2; // a bounce that leaves less speed, m/s, is the last

/// Numbers are height, velocity, gravity, coefficient of restitution and time.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub struct Ball {
    known: [f64; 5], // where the exact motion was last known
    here: [f64; 5],  // where the host is
    bounces: i32,
    rests: bool,
}

fmi_unit::export_fmu!(Ball);

impl Ball {
    /// The exact motion until `until`, s, or, if it `stops`, up to the first contact on the way.
    fn follow(&mut self, until: f64, stops: bool) -> StepEnd {
        let until = until.max(self.known[4]); // no host turns back
        while !self.rests {
            let [h, v, g, e, t] = self.known;
            let fall = (v + (v * v + 2.0 * g * h).sqrt()) / g; // the first root of h + v τ - g τ²/2
            if !fall.is_finite() || t + fall > until {
                break;
            }
            self.known = [0.0, v - g * fall, g, e, t + fall];
            if stops && fall > 0.0 {
                self.here = self.known;
                return StepEnd::Event;
            }
            let speed = e * (g * fall - v);
            (self.rests, self.bounces) = (speed < REST, self.bounces + 1);
            self.known[1] = if self.rests { 0.0 } else { speed };
        }
        let [h, v, g, e, t] = self.known;
        let (a, tau) = (if self.rests { 0.0 } else { -g }, until - t);
        self.known = [h + v * tau + a * tau * tau / 2.0, v + a * tau, g, e, until];
        self.here = self.known;
        StepEnd::Complete
    }
}

impl Model for Ball {
    fn open(_resources: &Path) -> Result<Box<dyn Model>, Failure> {
        Ok(Box::new(Ball { known: [0.0; 5], here: [1.0, 0.0, 9.81, 0.7, 0.0], bounces: 0, rests: false }))
    }

    fn variables(&self) -> Arc<[Variable]> {
        Arc::new([
            Variable::real(Output, "h", "m", "height").state().between(0.0, 1e6, 1.0),
            Variable::real(Output, "v", "m/s", "velocity, up").state().between(-1e6, 1e6, 0.0),
            Variable::real(Parameter, "g", "m/s2", "gravity").between(1e-3, 1e3, 9.81),
            Variable::real(Parameter, "e", "1", "coefficient of restitution").between(0.0, 0.99, 0.7),
            Variable::real(Local, "der(h)", "m/s", "rate of h").rate_of("h").from(["v"]),
            Variable::real(Local, "der(v)", "m/s2", "rate of v").rate_of("v").from(["g"]),
            Variable::real(Local, "gap", "m", "height until the ball rests").indicator().from(["h"]),
            Variable::of_type(DataType::Integer, Output, "bounces", "bounces so far"),
            Variable::time(),
        ])
    }

    fn get(&mut self, reference: u32) -> Result<Value, Failure> {
        let [h, v, g, e, t] = self.here;
        let (rate, gap) = if self.rests { (0.0, 1.0) } else { (-g, h + 1e-12) }; // no integration begins on a root
        let reals = [h, v, g, e, v, rate, gap, 0.0, t];
        Ok(if reference == 7 { Value::Integer(self.bounces) } else { Value::Real(reals[reference as usize]) })
    }

    fn set(&mut self, reference: u32, value: Value) {
        let Value::Real(value) = value else { return };
        self.here[reference.min(4) as usize] = value;
    }
    fn start(&mut self, _interface: Interface, _log: &Logger) -> Result<(), Failure> {
        self.known = self.here;
        Ok(())
    }
    fn advance(&mut self, step: StepRequest, _log: &Logger) -> Result<StepEnd, Failure> {
        Ok(self.follow(step.start + step.duration, step.stops_at_events))
    }
    fn complete_step(&mut self, _log: &Logger) -> Result<Completed, Failure> {
        let needs_event_mode = { *self }.follow(self.here[4], true) == StepEnd::Event;
        Ok(Completed { needs_event_mode, has_ended: false })
    }
    fn update(&mut self, _log: &Logger) -> Result<Update, Failure> {
        let host = self.here;
        self.follow(host[4], false);
        Ok(Update { has_new_states: self.here != host, ..Update::default() })
    }

    fmi_unit::state_by_serde!();
}

/// Writes the FMU.
pub fn main() -> Result<(), Box<dyn Error>> {
    archive::write_example("BouncingBall", &*Ball::open(Path::new(""))?, "bouncing_ball_unit")
}
