//! An integrator of its own on the equations of the library: never below the floor, and nearer to the engine the smaller
//! its steps. Bad integrators are in `evidence/model_exchange`.

use crate::common::{distance, engine_of, sampled, transitions};
use rocking::run::ground_motion::Elapsed;
use rocking::run::host_step::{BAND, Checked, Checkpoint};
use rocking::run::record::Record;
use rocking::{Detail, Engine, GroundMotion, LinearLoad, Load, OneMass, Parameters, Phase, State, Transition};

/// A burst that lifts McManus's pier some twenty times.
fn burst() -> Record {
    sampled(401, 0.01, |t| 5.0 * (-t / 2.0_f64).exp() * (std::f64::consts::TAU * 2.3 * t).sin())
}

/// An integrator on an engine's equations.
struct HostedEngine<'a> {
    engine: Engine,
    ground: GroundMotion<'a>,
    known: Checkpoint,
    transitions: Vec<Transition>,
}

impl<'a> HostedEngine<'a> {
    /// From rest.
    fn new(detail: Detail, record: &'a Record) -> HostedEngine<'a> {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let mut engine = engine_of(structure, State::default(), 1e-12, detail);
        let (mut transitions, ground) = (Vec::new(), GroundMotion::from(record));
        let a_g = LinearLoad::default().on_ground(ground.at(Elapsed::default())).value;
        engine.transit_at_once(a_g, &mut |transition: &Transition| transitions.push(*transition));
        let known = Checkpoint { motion: *engine.motion(), elapsed: Elapsed::default(), load: Load::default() };
        HostedEngine { engine, ground, known, transitions }
    }

    fn load(&self) -> Load {
        LinearLoad::default().on_ground(self.ground.at(self.elapsed())).value
    }

    fn elapsed(&self) -> Elapsed {
        Elapsed::default().and(self.engine.motion().time)
    }

    /// ẋ at `time` and `state`.
    fn rates(&mut self, time: f64, state: [f64; 4]) -> [f64; 4] {
        self.engine.set_time(time);
        self.engine.set_state(State::of(state));
        self.engine.sample(self.load()).state_rates().components()
    }

    fn step(&mut self, h: f64) {
        let (t, x) = (self.engine.motion().time, self.engine.motion().state.components());
        let ahead = |x: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
        let k1 = self.rates(t, x);
        let k2 = self.rates(t + h / 2.0, ahead(x, k1, h / 2.0));
        let k3 = self.rates(t + h / 2.0, ahead(x, k2, h / 2.0));
        let k4 = self.rates(t + h, ahead(x, k3, h));
        let end = ahead(x, std::array::from_fn(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0), h);
        self.rates(t + h, end);
        let (elapsed, load, transitions) = (self.elapsed(), self.load(), &mut self.transitions);
        let mut watch = |transition: &Transition| transitions.push(*transition);
        let Checked { motion, is_corrected, .. } =
            self.known.check(&mut self.engine, Some(&self.ground), elapsed, Load::default(), &mut watch).unwrap();
        assert!(is_corrected || motion.state == self.engine.motion().state, "the integrator's own state is lost");
        self.engine.set_motion(motion);
        self.engine.transit_at_once(load, &mut watch);
        self.known = Checkpoint { motion: *self.engine.motion(), elapsed, load: Load::default() };
        assert!(self.height() >= -BAND || self.has_overturned(), "below the floor at t = {}", t + h);
    }

    /// s θ/α_cg while rocking.
    fn height(&self) -> f64 {
        let alpha = self.engine.structure().base().tan_alpha_cg.atan();
        match self.engine.motion().phase {
            Phase::Rocking(side) => side.sign() * self.engine.motion().state.theta / alpha,
            _ => self.engine.motion().state.theta.abs(),
        }
    }

    fn has_overturned(&self) -> bool {
        matches!(self.engine.motion().phase, Phase::Overturned(_))
    }
}

/// The sway u + H θ at every hundredth of a second, by steps of `h`.
fn outside(detail: Detail, record: &Record, h: f64) -> (Vec<f64>, HostedEngine<'_>) {
    let mut outside = HostedEngine::new(detail, record);
    let steps = (0.01 / h).round() as usize;
    let row = |_| {
        (0..steps).for_each(|_| outside.step(h));
        sway(&outside.engine)
    };
    ((0..400).map(row).collect(), outside)
}

/// The same by the engine, and its transitions.
fn own(detail: Detail, record: &Record) -> (Vec<f64>, Vec<Transition>) {
    let HostedEngine { mut engine, ground, mut transitions, .. } = HostedEngine::new(detail, record);
    let mut elapsed = Elapsed::default();
    let row = |_| {
        let mut watch = |transition: &Transition| transitions.push(*transition);
        ground.advance(&mut engine, &mut elapsed, 0.01, LinearLoad::default(), &mut watch).unwrap();
        sway(&engine)
    };
    ((0..400).map(row).collect(), transitions)
}

fn sway(engine: &Engine) -> f64 {
    let State { u, theta, .. } = engine.motion().state;
    u + engine.structure().floors()[0].height * theta
}

/// Of fourth order through all transitions, which are the engine's own in kind and, nearly, in time.
#[test]
fn the_smaller_the_steps_the_nearer_to_the_engine() {
    let record = burst();
    for detail in [Detail::Auto, Detail::Linear, Detail::Modal, Detail::Rigid, Detail::FixedBase] {
        let (expected, transitions) = own(detail, &record);
        let error = |h| {
            let (found, outside) = outside(detail, &record, h);
            let kinds = |of: &[Transition]| of.iter().map(|transition| transition.kind).collect::<Vec<_>>();
            assert_eq!(kinds(&outside.transitions), kinds(&transitions), "{detail:?} at {h}");
            distance(&found, &expected)
        };
        let (coarse, fine) = (error(1e-3), error(2.5e-4));
        assert!(fine < 1e-7 && (fine < coarse / 50.0 || coarse < 1e-10), "{detail:?}: {coarse:e}, then {fine:e}");
    }
}

/// A hop that starts and ends within one step leaves no trace at the step's end but the engine's. A step's end that is beyond a
/// guard, whether the engine reaches that or not, is put back to where the engine is.
#[test]
fn a_step_that_hides_a_hop_or_ends_below_the_floor_is_put_right() {
    let hop = State { theta: 1e-5, theta_dot: 1e-4, ..State::default() };
    let high = State { theta: 0.03, ..State::default() };
    for (initial, duration, hops, ends) in
        [(hop, 0.05, true, [hop.theta, -1e-3].as_slice()), (high, 1e-3, false, &[-1e-3, 3.0, f64::NAN])]
    {
        let [mut engine, mut alone] =
            [(); 2].map(|()| Engine::new(OneMass::new(Parameters::EVISON).unwrap(), initial, 0.0, 1e-12).unwrap());
        let known = Checkpoint { motion: *engine.motion(), elapsed: Elapsed::default(), load: Load::default() };
        let transitions = transitions(&mut alone, duration, Load::default());
        assert_eq!(!transitions.is_empty(), hops);
        for &theta in ends {
            let state = State { theta, ..initial }; // an integrator to which nothing has happened, or that fell
            engine.set_time(duration);
            engine.set_state(state);
            let mut seen = Vec::new();
            let mut watch = |transition: &Transition| seen.push(*transition);
            let checked = known.check(&mut engine, None, Elapsed::default(), Load::default(), &mut watch).unwrap();
            let was_hidden = state == initial;
            assert_eq!(checked, Checked { motion: *alone.motion(), is_corrected: true, was_hidden }, "{theta}");
            assert_eq!(seen, transitions);
            assert!(engine.motion().state == state || theta.is_nan());
        }
    }
}
