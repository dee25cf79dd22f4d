//! Exact peaks of a structure of many masses, floor by floor: between the ends of pieces, too.
//!
//! Each quantity is expanded as a series in time over each polynomial of the motion. If a bound of the series exceeds the largest
//! magnitude so far, the quantity is looked at where its series is stationary. Its values there come from the state.

use super::peaks::Peak;
use super::{Finish, Run, RunError};
use crate::engine::piece::{Expansion, Piece, Sample, Watch};
use crate::mechanics::gauge::{Gauge, Reading};
use crate::mechanics::instant::Place;
use crate::numbers::{Angle, Number, Turn};
use crate::series::extremes;
use crate::series::terms::Terms;
use crate::structure::frame::Frame;
use crate::{Floor, Modes, Phase};

/// Peaks of a floor and of the storey below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloorPeaks {
    /// Elastic displacement |u_i|, m.
    pub u: Peak,
    /// Drift of the storey |u_i − u_{i−1}|, m.
    pub drift: Peak,
    /// Displacement relative to the ground |δ_i|, m (Eq 26).
    pub delta: Peak,
    /// Acceleration along the turning e_x |a_i|, m/s².
    pub a: Peak,
    /// Shear of the storey |V_i|, N.
    pub V: Peak,
}

/// The peaks of a structure of many masses over the motion that has been watched, a fall too.
#[derive(Clone, Debug)]
pub struct Profile {
    frame: Frame,
    /// Peak of the ground acceleration |a_g|, m/s².
    pub a_g: Peak,
    /// Peak of |θ|, rad.
    pub theta: Peak,
    /// Peak of the base shear |V_t|, N.
    pub V_t: Peak,
    /// Peak of the overturning moment |M_t|, N·m.
    pub M_t: Peak,
    /// Peaks of the floors, from below.
    pub floors: Vec<FloorPeaks>,
}

/// A quantity that has a peak.
#[derive(Clone, Copy)]
enum Quantity<'a> {
    Theta,
    Gauge(&'a Gauge),
    Elastic(&'a Floor),
    Drift(&'a Floor, Option<&'a Floor>),
    Delta(&'a Floor),
}

/// A polynomial of the motion in series, as far as several quantities read it.
struct Over<'a> {
    of: Expansion<'a, Modes>,
    theta: Terms,
    theta_dot: Terms,
    turn: Turn<Terms>,
}

impl<'a> Over<'a> {
    fn new(of: Expansion<'a, Modes>) -> Over<'a> {
        let none = Terms::constant(0.0);
        let (theta, theta_dot, turn) = match of.piece.before.phase {
            Phase::FullContact => (none, none, Turn::none()),
            Phase::Rocking(_) | Phase::Overturned(_) => {
                let [theta, theta_dot] = [&of.arc.theta, &of.arc.theta_dot].map(|it| Terms::of(it, of.arc.order));
                (theta, theta_dot, theta.turn())
            }
        };
        Over { of, theta, theta_dot, turn }
    }
}

/// Drift of the storey below `floor`, m, for the coordinates `u`.
fn drift(floor: &Floor, below: Option<&Floor>, u: &Modes) -> f64 {
    floor.displacement(u) - below.map_or(0.0, |below| below.displacement(u))
}

impl Quantity<'_> {
    /// The value at an instant.
    fn value(self, sample: &Sample<Modes>) -> f64 {
        let u = &sample.motion.state.u;
        match self {
            Quantity::Theta => sample.motion.state.theta,
            Quantity::Gauge(gauge) => sample.value(gauge),
            Quantity::Elastic(floor) => floor.displacement(u),
            Quantity::Drift(floor, below) => drift(floor, below, u),
            Quantity::Delta(floor) => sample.displacement(floor),
        }
    }

    /// The quantity over a polynomial.
    fn terms(self, over: &Over) -> Terms {
        let Expansion { piece, from, arc } = over.of;
        let (frame, phase) = (piece.level.structure(), piece.before.phase);
        let s = phase.side().sign();
        let elastic = |of: &dyn Fn(&Modes) -> f64| Terms::from_fn(arc.order, |k| of(&arc.u[k]));
        match self {
            Quantity::Theta => over.theta,
            Quantity::Elastic(floor) => elastic(&|u| floor.displacement(u)),
            Quantity::Drift(floor, below) => elastic(&|u| drift(floor, below, u)),
            Quantity::Delta(floor) => {
                let u = elastic(&|u| floor.displacement(u));
                Place { share: 1.0, height: floor.height, u }.right(s * frame.base.B, &over.turn)
            }
            Quantity::Gauge(gauge) => {
                let (damping, load) = (frame.base.damping(phase), piece.load.from(from));
                let ramp = |value: f64, slope: f64| Terms::ramp(value, slope * arc.span);
                let reading = Reading {
                    elastic: Terms::from_fn(arc.order, |k| gauge.elastic(frame, damping, &arc.u[k], &arc.u_dot[k])),
                    push: ramp(gauge.push(frame, &load.value.F_t), gauge.push(frame, &load.slope.F_t)),
                    turn: over.turn,
                    theta_dot: over.theta_dot,
                    theta_ddot: over.theta_dot.slope(arc.span),
                    a_g: ramp(load.value.a_g, load.slope.a_g),
                    a_v: ramp(load.value.a_v, load.slope.a_v),
                };
                gauge.value(&frame.base, s, &reading)
            }
        }
    }
}

impl Profile {
    /// Peaks of `frame` from `time` (s) on, before any motion.
    pub fn since(time: f64, frame: &Frame) -> Profile {
        let none = Peak { magnitude: 0.0, time };
        let floor = FloorPeaks { u: none, drift: none, delta: none, a: none, V: none };
        let floors = vec![floor; frame.floors().len()];
        Profile { frame: frame.clone(), a_g: none, theta: none, V_t: none, M_t: none, floors }
    }

    /// Peak of the uplift δ_u = 2 B sin|θ|, m (Eq 25).
    pub fn uplift(&self) -> Peak {
        Peak { magnitude: 2.0 * self.frame.base.B * libm::sin(self.theta.magnitude), ..self.theta }
    }

    /// Looks at each quantity with its peak so far.
    fn each(&mut self, mut look: impl FnMut(Quantity, &mut Peak)) {
        let Profile { frame, theta, V_t, M_t, floors: peaks, .. } = self;
        let (floors, gauges) = (frame.floors(), frame.gauges());
        look(Quantity::Theta, theta);
        look(Quantity::Gauge(&gauges.V_t), V_t);
        look(Quantity::Gauge(&gauges.M_t), M_t);
        for (i, FloorPeaks { u, drift, delta, a, V }) in peaks.iter_mut().enumerate() {
            let (floor, below) = (&floors[i], i.checked_sub(1).map(|below| &floors[below]));
            look(Quantity::Elastic(floor), u);
            look(Quantity::Drift(floor, below), drift);
            look(Quantity::Delta(floor), delta);
            look(Quantity::Gauge(&gauges.a[i]), a);
            look(Quantity::Gauge(&gauges.V[i]), V);
        }
    }
}

impl Watch<Modes> for Profile {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece<Modes>) {
        for tau in [0.0, piece.duration] {
            self.a_g.see(piece.load.at(tau).a_g, piece.before.time + tau);
        }
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            let (over, reach) = (Over::new(expansion), expansion.arc.reach);
            let ends = [0.0, reach].map(|sigma| expansion.sample(sigma));
            self.each(|quantity, peak| {
                let mut see = |sample: &Sample<Modes>| peak.see(quantity.value(sample), sample.motion.time);
                ends.iter().for_each(&mut see);
                let series = quantity.terms(&over);
                if peak.may_change(extremes::bound(series.used(), reach), ends[0].motion.time) {
                    extremes::stationary_points(series.used(), reach, |sigma| {
                        let sample = expansion.sample(sigma);
                        peak.see(quantity.value(&sample), sample.motion.time);
                    });
                }
            });
        }
    }
}

impl Run<'_, Modes> {
    /// The exact peaks of all of the run, floor by floor, and how it ended.
    pub fn profile(&self) -> Result<(Profile, Finish<Modes>), RunError> {
        let mut profile = Profile::since(self.ground.start(), &self.structure);
        let finish = self.follow(&mut profile)?;
        Ok((profile, finish))
    }
}
