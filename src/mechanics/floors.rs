//! The outputs of a structure of many masses at an instant: of its base, its floors and its storeys.
//!
//! A formula reads the motion in numbers of any kind: at an instant, or as series in time over a polynomial of the motion.

use crate::mechanics::gauge::Gauge;
use crate::mechanics::instant::{Place, uplift};
use crate::numbers::{Number, Turn};
use crate::{Floor, Structure};
use serde::{Deserialize, Serialize};

/// An output of a structure of many masses. Floors and storeys count from 0, from below; storey i is below floor i.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(non_camel_case_types)] // the names of the outputs
pub enum FrameOutput {
    /// Rotation of the base θ, rad.
    theta,
    /// Angular velocity θ̇, rad/s.
    theta_dot,
    /// Uplift of the free edge of the base δ_u = 2 B sin|θ|, m (Eq 25).
    uplift,
    /// Base shear V_t, N.
    V_t,
    /// Overturning moment M_t, N·m.
    M_t,
    /// Elastic displacement of a floor u_i, m.
    u(usize),
    /// Elastic velocity of a floor u̇_i, m/s.
    u_dot(usize),
    /// Drift of a storey u_i − u_{i−1}, m.
    drift(usize),
    /// Displacement of a floor relative to the ground δ_i, m (Eq 26).
    delta_t(usize),
    /// Velocity of a floor relative to the ground, the rate of δ_i, m/s.
    v_t(usize),
    /// Acceleration of a floor along the turning e_x a_i, m/s².
    a_t(usize),
    /// Shear of a storey V_i, N.
    V(usize),
    /// Overturning moment at the foot of a storey M_i, N·m.
    M(usize),
}

/// A motion in numbers of the kind `N`, as formulas of outputs read it.
pub(crate) trait MotionOfFloors<N> {
    fn frame(&self) -> &Structure;
    /// Place of the pivot, sB, m.
    fn pivot(&self) -> f64;
    fn theta(&self) -> N;
    fn theta_dot(&self) -> N;
    fn turn(&self) -> Turn<N>;
    /// Elastic displacement of a floor, m.
    fn u(&self, floor: &Floor) -> N;
    /// Elastic velocity of a floor, m/s.
    fn u_dot(&self, floor: &Floor) -> N;
    fn gauge(&self, gauge: &Gauge) -> N;
}

impl FrameOutput {
    /// The outputs of the base.
    const OF_BASE: [FrameOutput; 5] =
        [FrameOutput::theta, FrameOutput::theta_dot, FrameOutput::uplift, FrameOutput::V_t, FrameOutput::M_t];

    /// The outputs of a floor and of the storey below the floor.
    const OF_FLOOR: [fn(usize) -> FrameOutput; 8] = [
        FrameOutput::u,
        FrameOutput::u_dot,
        FrameOutput::drift,
        FrameOutput::delta_t,
        FrameOutput::v_t,
        FrameOutput::a_t,
        FrameOutput::V,
        FrameOutput::M,
    ];

    /// All outputs of `frame`: of its base, then each output of the floors from below.
    pub fn all(frame: &Structure) -> impl Iterator<Item = FrameOutput> + use<> {
        let floors = frame.floors().len();
        let of_floors = FrameOutput::OF_FLOOR.iter().flat_map(move |of| (0..floors).map(of));
        FrameOutput::OF_BASE.into_iter().chain(of_floors)
    }

    /// The name, unit and description, and the floor if the output is of a floor, which takes the place of `#`.
    fn told(self) -> (&'static str, &'static str, &'static str, Option<usize>) {
        match self {
            FrameOutput::theta => ("theta", "rad", "rotation of the base", None),
            FrameOutput::theta_dot => ("theta_dot", "rad/s", "angular velocity of the base", None),
            FrameOutput::uplift => ("uplift", "m", "uplift of the free edge of the base", None),
            FrameOutput::V_t => ("V_t", "N", "base shear if all F_t are 0: the sum of m a_t", None),
            FrameOutput::M_t => ("M_t", "N.m", "overturning moment if all F_t are 0: the sum of m h a_t", None),
            FrameOutput::u(i) => ("u", "m", "elastic displacement of floor #", Some(i)),
            FrameOutput::u_dot(i) => ("u_dot", "m/s", "elastic velocity of floor #", Some(i)),
            FrameOutput::drift(i) => ("drift", "m", "drift of storey #", Some(i)),
            FrameOutput::delta_t(i) => ("delta_t", "m", "displacement of floor # relative to the ground", Some(i)),
            FrameOutput::v_t(i) => ("v_t", "m/s", "velocity of floor # relative to the ground", Some(i)),
            FrameOutput::a_t(i) => ("a_t", "m/s2", "lateral acceleration of floor #", Some(i)),
            FrameOutput::V(i) => ("V", "N", "shear of storey # if all F_t are 0: the sum of m a_t above it", Some(i)),
            FrameOutput::M(i) => ("M", "N.m", "overturning moment at the foot of storey # if all F_t are 0", Some(i)),
        }
    }

    /// The name, with the number of the floor or storey from 1: `a_t[3]`.
    pub fn name(self) -> String {
        let (name, _, _, floor) = self.told();
        floor.map_or(name.into(), |floor| format!("{name}[{}]", floor + 1))
    }

    /// The symbol without a number, the same for all floors.
    pub fn symbol(self) -> &'static str {
        self.told().0
    }

    /// The unit.
    pub fn unit(self) -> &'static str {
        self.told().1
    }

    /// The description.
    pub fn description(self) -> String {
        let (_, _, description, floor) = self.told();
        floor.map_or(description.into(), |floor| description.replace('#', &(floor + 1).to_string()))
    }

    /// Whether the output depends on the ground acceleration directly.
    pub fn has_feedthrough(self, frame: &Structure) -> bool {
        self.gauge(frame).is_some_and(Gauge::has_feedthrough)
    }

    /// The gauge that measures the output.
    fn gauge(self, frame: &Structure) -> Option<&Gauge> {
        let gauges = frame.gauges();
        match self {
            FrameOutput::V_t => Some(&gauges.V_t),
            FrameOutput::M_t => Some(&gauges.M_t),
            FrameOutput::a_t(i) => Some(&gauges.a[i]),
            FrameOutput::V(i) => Some(&gauges.V[i]),
            FrameOutput::M(i) => Some(&gauges.M[i]),
            _ => None,
        }
    }

    /// The output in the motion `x`.
    pub(crate) fn of<N: Number>(self, x: &impl MotionOfFloors<N>) -> N {
        if let Some(gauge) = self.gauge(x.frame()) {
            return x.gauge(gauge);
        }
        let floor = |i: usize| &x.frame().floors()[i];
        let place = |i| Place { share: 1.0, height: floor(i).height, u: x.u(floor(i)) };
        match self {
            FrameOutput::theta => x.theta(),
            FrameOutput::theta_dot => x.theta_dot(),
            FrameOutput::uplift => uplift(x.pivot(), &x.turn()),
            FrameOutput::u(i) => x.u(floor(i)),
            FrameOutput::u_dot(i) => x.u_dot(floor(i)),
            FrameOutput::drift(0) => x.u(floor(0)),
            FrameOutput::drift(i) => x.u(floor(i)) - x.u(floor(i - 1)),
            FrameOutput::delta_t(i) => place(i).right(x.pivot(), &x.turn()),
            FrameOutput::v_t(i) => place(i).rate_of_right(x.pivot(), &x.turn(), [x.u_dot(floor(i)), x.theta_dot()]),
            FrameOutput::V_t | FrameOutput::M_t | FrameOutput::a_t(_) | FrameOutput::V(_) | FrameOutput::M(_) => {
                unreachable!("a gauge measures it")
            }
        }
    }
}
