//! The settings before a simulation starts.

use crate::inputs::Between;
use crate::resources::Contents;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::load::LOADS;
use rocking::run::ground_motion::Placement;
use rocking::run::record::Record;
use rocking::{Detail, GroundMotion, State};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    /// The numbers of the structure's description that have variables.
    pub(crate) numbers: Vec<f64>,
    /// With u and u̇ of each floor.
    pub(crate) initial: State<Vec<f64>>,
    pub(crate) detail: Detail,
    pub(crate) tolerance: f64,
    pub(crate) start_time: f64,
    /// Which record the ground follows; none if empty.
    pub(crate) record: Arc<str>,
    /// Which record it follows vertically; none if empty.
    pub(crate) record_v: Arc<str>,
    pub(crate) placement: Placement,
    /// Whether a_v has been set: until then the ground moves vertically by record_v alone.
    pub(crate) vertical: bool,
    /// Whether a_g and a_v are followed one step late.
    pub(crate) a_g_late: bool,
    /// Whether F_t goes on with the slope of its last two values.
    pub(crate) F_t_extrapolated: bool,
    pub(crate) peaks: bool,
    pub(crate) validity: bool,
}

impl Setup {
    pub(crate) fn new(contents: &Contents) -> Setup {
        let at_rest = vec![0.0; contents.structure.floors().len()];
        Setup {
            initial: State { u: at_rest.clone(), u_dot: at_rest, ..State::default() },
            numbers: contents.numbers(),
            tolerance: DEFAULT_TOLERANCE,
            record: contents.default_record().into(),
            record_v: contents.vertical.as_ref().map_or("", |packed| &packed.file).into(),
            ..Setup::default()
        }
    }

    /// The acceleration of gravity, m/s².
    pub(crate) fn g(&self, contents: &Contents) -> f64 {
        contents.description().with(&self.numbers).parameters.g
    }

    pub(crate) fn between(&self) -> [Between; LOADS.len()] {
        let of_ground = if self.a_g_late { Between::Late } else { Between::Held };
        let F_t = if self.F_t_extrapolated { Between::Extrapolated } else { Between::Held };
        [of_ground, F_t, of_ground]
    }

    /// The scaled `record` at its place in time.
    pub(crate) fn ground_motion<'a>(&self, record: &'a Record) -> GroundMotion<'a> {
        GroundMotion { record, start: self.placement.start }
    }
}
