//! Exact peaks of a structure of many masses, floor by floor: between the ends of pieces, too.
//!
//! A bound over a polynomial of the motion tells most of the time that a quantity has no larger magnitude there than so far.
//! Otherwise the quantity is expanded as a series in time. If a bound of the series exceeds the largest magnitude so far, the
//! quantity is looked at where its series is stationary. Its values there come from the state.

use super::peak_watch::{PeakWatch, Peaked};
use super::peaks::{Peak, TENDON, Tendon, has_tendon};
use super::{Finish, Run, RunError};
use crate::Structure;
use crate::engine::piece::{CONVERGED, Expansion, Part, Piece, Sample, Turning};
use crate::mechanics::floors::{FrameOutput, MotionOfFloors};
use crate::mechanics::gauge::{Gauge, Reading};
use crate::mechanics::instant::{Instant, Strut};
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::numbers::most::Most;
use crate::numbers::{Angle, Number, Turn};
use crate::series::extremes;
use crate::series::terms::Terms;
use crate::{Detail, Floor, Modes, Phase, State};
use serde::{Deserialize, Serialize};

/// The peaks of a structure of many masses over the motion that has been watched, a fall too.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Profile {
    /// Half-width of the base, m.
    B: f64,
    /// Peak of the ground acceleration |a_g|, m/s².
    pub a_g: Peak,
    /// The peaks that are searched.
    peaks: Vec<(FrameOutput, Peak)>,
    tendon: Option<Tendon>,
}

/// A quantity of a structure of many masses that has a peak.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peaking {
    /// An output.
    Output(FrameOutput),
    /// The force of the tendon P_t, N.
    Tendon,
}

impl Peaking {
    /// The name, with the number of the floor or storey from 1.
    pub fn name(self) -> String {
        match self {
            Peaking::Output(output) => output.name(),
            Peaking::Tendon => TENDON.name.into(),
        }
    }

    /// The symbol without a number.
    pub fn symbol(self) -> &'static str {
        match self {
            Peaking::Output(output) => output.symbol(),
            Peaking::Tendon => TENDON.name,
        }
    }

    /// The unit.
    pub fn unit(self) -> &'static str {
        match self {
            Peaking::Output(output) => output.unit(),
            Peaking::Tendon => TENDON.unit,
        }
    }
}

/// A polynomial of the motion in series, as far as several outputs read it.
pub(super) struct Over<'a> {
    of: Expansion<'a, Modes>,
    theta: Terms,
    theta_dot: Terms,
    turn: Turn<Terms>,
}

impl<'a> Over<'a> {
    pub(super) fn new(of: Expansion<'a, Modes>) -> Over<'a> {
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

impl MotionOfFloors<Terms> for Over<'_> {
    fn frame(&self) -> &Structure {
        self.of.piece.level.structure()
    }

    fn pivot(&self) -> f64 {
        self.of.piece.before.phase.side().sign() * self.frame().base().B
    }

    fn theta(&self) -> Terms {
        self.theta
    }

    fn theta_dot(&self) -> Terms {
        self.theta_dot
    }

    fn turn(&self) -> Turn<Terms> {
        self.turn
    }

    fn u(&self, floor: &Floor) -> Terms {
        Terms::from_fn(self.of.arc.order, |k| floor.displacement(&self.of.arc.u[k]))
    }

    fn u_dot(&self, floor: &Floor) -> Terms {
        Terms::from_fn(self.of.arc.order, |k| floor.displacement(&self.of.arc.u_dot[k]))
    }

    fn gauge(&self, gauge: &Gauge) -> Terms {
        let Expansion { piece, from, arc } = self.of;
        let (frame, phase) = (self.frame(), piece.before.phase);
        let (damping, load) = (frame.base().damping(phase), piece.load.from(from));
        let ramp = |value: f64, slope: f64| Terms::ramp(value, slope * arc.span);
        let reading = Reading {
            elastic: Terms::from_fn(arc.order, |k| gauge.elastic(frame, damping, &arc.u[k], &arc.u_dot[k])),
            push: ramp(gauge.push(frame, &load.value.F_t), gauge.push(frame, &load.slope.F_t)),
            turn: self.turn,
            theta_dot: self.theta_dot,
            theta_ddot: self.theta_dot.slope(arc.span),
            a_g: ramp(load.value.a_g, load.slope.a_g),
            a_v: ramp(load.value.a_v, load.slope.a_v),
        };
        gauge.value(frame.base(), phase.side().sign(), &reading)
    }
}

/// Bounds of the magnitudes of the coordinates of the modes, or of the forces on them.
#[derive(Clone, Copy)]
pub(super) struct Mosts(pub Modes);

impl Lateral<Most> for Mosts {
    fn of(&self, j: usize) -> Most {
        Most(self.0.of(j))
    }
}

/// Bounds of the magnitudes over a polynomial of the motion.
fn bounds<'a>(expansion: &Expansion<'a, Modes>) -> Turning<'a, Most, Mosts> {
    let &Expansion { piece, from, arc } = expansion;
    let (frame, end) = (piece.level.structure(), arc.end());
    let most = State {
        u: Modes::each(frame, |j, _| arc.most(&arc.series(|k| arc.u[k].of(j)), end.u.of(j))),
        u_dot: Modes::each(frame, |j, _| arc.most(&arc.series(|k| arc.u_dot[k].of(j)), end.u_dot.of(j))),
        theta: arc.most(&arc.theta, end.theta),
        theta_dot: arc.most(&arc.theta_dot, end.theta_dot),
    };
    bounds_of(piece, [from, from + arc.duration()], &most)
}

/// Bounds of the magnitudes over what is left of a leap: u and u̇ leave their chords by at most twice the vibration, and by at most
/// M h²/8 over the time h if their second derivative is at most M.
fn bounds_of_rest<'a>(part: &Part<'a, Modes>, [u, u_dot, u_ddot, jerk]: &[Modes; 4]) -> Turning<'a, Most, Mosts> {
    let ((from, first), (until, last)) = (part.start, part.end);
    let (frame, per_bend) = (part.piece.level.structure(), (until - from) * (until - from) / 8.0);
    let most = |first: Modes, last: Modes, vibration: &Modes, bend: &Modes| {
        Modes::each(frame, |j, _| {
            first.of(j).abs().max(last.of(j).abs()) + (2.0 * vibration.of(j)).min(per_bend * bend.of(j))
        })
    };
    let [u, u_dot] = [most(first.u, last.u, u, u_ddot), most(first.u_dot, last.u_dot, u_dot, jerk)];
    bounds_of(part.piece, [from, until], &State { u, u_dot, theta: 0.0, theta_dot: 0.0 })
}

/// Stands for any angular acceleration in a bound, rad/s²: no product with masses and heights overflows.
const UNBOUNDED: f64 = 1e200;

/// Bounds of the magnitudes between two times (s) of a `piece`, over which the state has the magnitudes `most`. While rocking there
/// is none of θ̈, which modes that are left out need.
fn bounds_of<'a>(piece: &'a Piece<'a, Modes>, times: [f64; 2], most: &State<Modes>) -> Turning<'a, Most, Mosts> {
    let (frame, phase) = (piece.level.structure(), piece.before.phase);
    let loads = times.map(|tau| piece.load.at(tau));
    let largest = |of: [f64; 2]| of[0].abs().max(of[1].abs());
    let theta = Most(most.theta);
    let x = Instant {
        structure: frame,
        s: phase.side().sign(),
        strut: Strut::Elastic(frame.base().damping(phase)),
        u: Mosts(most.u),
        u_dot: Mosts(most.u_dot),
        theta,
        theta_dot: Most(most.theta_dot),
        turn: theta.turn(),
        a_g: Most(largest(loads.map(|load| load.a_g))),
        F_t: Mosts(Modes::each(frame, |j, _| largest(loads.map(|load| load.F_t.of(j))))),
        a_v: Most(largest(loads.map(|load| load.a_v))),
    };
    Turning { x, theta_ddot: Most(if phase == Phase::FullContact { 0.0 } else { UNBOUNDED }) }
}

/// Whether the peak of `output` is searched.
fn is_searched(output: &FrameOutput) -> bool {
    use FrameOutput::{theta_dot, u_dot, uplift, v_t};
    !matches!(output, theta_dot | uplift | u_dot(_) | v_t(_))
}

impl Profile {
    /// Peaks of `frame` at the level `detail` from `time` (s) on, before any motion.
    pub fn since(time: f64, frame: &Structure, detail: Detail) -> Profile {
        let none = Peak { magnitude: 0.0, time };
        let peaks = FrameOutput::all(frame).filter(is_searched).map(|output| (output, none)).collect();
        let tendon = has_tendon(frame.base()).then(|| Tendon::new(frame.base(), detail, time));
        Profile { B: frame.base().B, a_g: none, peaks, tendon }
    }

    /// The quantities that have a peak, with their peaks: the outputs in the order of [`FrameOutput::all`], and the force of a tendon.
    pub fn peaks(&self) -> impl Iterator<Item = (Peaking, Peak)> {
        let with_uplift = |&(output, peak): &(FrameOutput, Peak)| {
            let uplift = 2.0 * self.B * libm::sin(peak.magnitude);
            let of_theta = (Peaking::Output(FrameOutput::uplift), Peak { magnitude: uplift, ..peak });
            [Some((Peaking::Output(output), peak)), (output == FrameOutput::theta).then_some(of_theta)]
        };
        let [(_, theta), ..] = self.peaks[..] else { unreachable!("theta is the first output") };
        let tendon = self.tendon.map(|tendon| (Peaking::Tendon, tendon.peak(self.B, theta)));
        self.peaks.iter().flat_map(with_uplift).flatten().chain(tendon)
    }

    /// The values of the outputs within `bounds`, in the order of the peaks.
    fn bounds(&self, bounds: &Turning<Most, Mosts>) -> Vec<f64> {
        self.peaks.iter().map(|(output, _)| output.of(bounds).0).collect()
    }

    /// Looks at a polynomial.
    fn look(&mut self, expansion: &Expansion<Modes>) {
        expansion.in_parts(&mut |part, is_finest| {
            let (bounds, reach) = (self.bounds(&bounds(part)), part.arc.reach);
            let ends = [0.0, reach].map(|sigma| part.sample(sigma));
            let [first, last] = [&ends[0], &ends[1]].map(Sample::<Modes>::outputs);
            let [start, end] = [&ends[0], &ends[1]].map(|sample| sample.motion.time);
            let mut over = None;
            for ((output, peak), bound) in self.peaks.iter_mut().zip(bounds) {
                if !peak.may_change(bound, start) {
                    continue;
                }
                let at_end = last(*output);
                peak.see(first(*output), start);
                peak.see(at_end, end);
                if !peak.may_change(bound, start) {
                    continue;
                }
                let series = output.of(over.get_or_insert_with(|| Over::new(*part)));
                if !is_finest && !part.has_converged(&series, at_end, CONVERGED) {
                    return false;
                }
                if peak.may_change(extremes::bound(series.used(), reach), start) {
                    extremes::stationary_points(series.used(), reach, |sigma| {
                        let sample = part.sample(sigma);
                        peak.see(sample.output(*output), sample.motion.time);
                    });
                }
            }
            true
        });
    }

    /// The peak of `output`, if it has one.
    pub fn of(&self, output: FrameOutput) -> Option<Peak> {
        self.peaks().find(|(of, _)| *of == Peaking::Output(output)).map(|(_, peak)| peak)
    }
}

impl Peaked for Modes {
    type Peaks = Profile;
    type Bounds = Vec<f64>;

    fn none(time: f64, structure: &Structure, detail: Detail) -> Profile {
        Profile::since(time, structure, detail)
    }

    fn goes_on(profile: &Profile) -> bool {
        profile.peaks.iter().any(|(_, peak)| peak.magnitude > 0.0)
    }

    fn see_ground(profile: &mut Profile, a_g: f64, time: f64) {
        profile.a_g.see(a_g, time);
    }

    fn see_instant(profile: &mut Profile, sample: &Sample<Modes>) {
        let value = sample.outputs();
        profile.peaks.iter_mut().for_each(|(output, peak)| peak.see(value(*output), sample.motion.time));
    }

    fn see(profile: &mut Profile, piece: &Piece<Modes>, tau: f64, state: &State<Modes>) {
        Modes::see_instant(profile, &piece.in_state(tau, *state));
    }

    fn bounds(profile: &Profile, piece: &Piece<Modes>) -> Vec<f64> {
        if let Some(arc) = piece.arc {
            return profile.bounds(&bounds(&Expansion { piece, from: 0.0, arc }));
        }
        match piece.arcs().rest() {
            Some((rest, swings)) => profile.bounds(&bounds_of_rest(&rest, &swings)),
            None => vec![f64::INFINITY; profile.peaks.len()],
        }
    }

    fn may_be_same(profile: &Profile, bounds: &Vec<f64>) -> bool {
        profile.peaks.iter().zip(bounds).any(|((_, peak), bound)| *bound > 0.0 && peak.may_be_same(*bound))
    }

    fn may_change(profile: &Profile, bounds: &Vec<f64>, time: f64) -> bool {
        profile.peaks.iter().zip(bounds).any(|((_, peak), bound)| peak.may_change(*bound, time))
    }

    fn look(profile: &mut Profile, piece: &Piece<Modes>) {
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            profile.look(&expansion);
            let is_over = |(rest, vibration): (Part<Modes>, [Modes; 4])| {
                let start = piece.before.time + rest.start.0;
                !Modes::may_change(profile, &profile.bounds(&bounds_of_rest(&rest, &vibration)), start)
            };
            if arcs.rest().is_some_and(is_over) {
                break;
            }
        }
    }
}

impl Run<'_, Modes> {
    /// The exact peaks of all of the run, floor by floor, and how it ended.
    pub fn profile(&self) -> Result<(Profile, Finish<Modes>), RunError> {
        let mut profile = Profile::since(self.ground.start(), &self.structure, self.detail);
        let finish = self.follow(&mut PeakWatch::new(&mut profile))?;
        Ok((profile, finish))
    }
}
