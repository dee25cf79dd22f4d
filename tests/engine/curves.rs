//! Curves of runs from outside: what straight lines between their points say, beside the motion itself.

use crate::common::sampled;
use crate::modes::three_storeys;
use approx::assert_relative_eq;
use rocking::run::curve::{CurvePoint, RunCurve};
use rocking::run::record::Record;
use rocking::run::{End, Run, RunError, Runs};
use rocking::{Detail, OneMass, Output, Parameters, Phase, Sample, State, TransitionKind};

/// Lifts, bounces and lands the McManus specimen at every level: two sines that die away.
fn ground() -> Record {
    sampled(300, 0.02, |t| (4.0 * (9.0 * t).sin() + 2.0 * (23.0 * t).cos()) * (-0.4 * t).exp())
}

/// Values at `time` of the line through `points`, after a transition at that instant: the outputs, then a_g.
fn on_the_line(points: &[CurvePoint], time: f64) -> Vec<f64> {
    let after = points.partition_point(|point| point.time <= time).clamp(1, points.len() - 1);
    let (from, to) = (&points[after - 1], &points[after]);
    let part = if to.time > from.time { (time - from.time) / (to.time - from.time) } else { 1.0 };
    let [from, to] = [from, to].map(|point| point.outputs.iter().copied().chain([point.a_g]));
    from.zip(to).map(|(from, to)| from * (1.0 - part) + to * part).collect()
}

/// The curve of `run` to `part` of each largest value. Its lines pass through the peaks of these `outputs` and of the ground. They stay
/// as close to samples every 0.1 ms; `see` gets each sample and the lines there.
fn near_the_motion<Q: Runs>(
    run: &Run<Q>,
    part: f64,
    outputs: &[Output],
    see: impl Fn(&Sample<Q>, &[f64]),
) -> RunCurve<Q> {
    let curve = run.curve(part).unwrap();
    let (found, points) = (&curve.found, &curve.points);
    assert_eq!(*found, run.found(&mut ()).unwrap());
    let drawn = Output::drawn(&run.structure);
    let place = |of: &Output| drawn.iter().position(|drawn| drawn == of).unwrap();
    let largest = Vec::from_iter(outputs.iter().map(|of| found.peaks.of(*of).unwrap().magnitude));
    let of_ground = found.ground.magnitude;
    let most = |of: &dyn Fn(&CurvePoint) -> f64| points.iter().map(|point| of(point).abs()).fold(0.0, f64::max);
    assert_relative_eq!(most(&|point| point.a_g), of_ground, max_relative = 1e-9);
    for (of, largest) in outputs.iter().zip(&largest) {
        assert_relative_eq!(most(&|point| point.outputs[place(of)]), *largest, max_relative = 1e-9);
    }
    let show = |sample: &Sample<Q>| {
        let line = on_the_line(points, sample.motion.time);
        for (i, of) in outputs.iter().enumerate() {
            let missed = (line[place(of)] - sample.output(*of)).abs();
            assert!(missed <= part * largest[i].max(1e-12), "{:?} {part} {of:?}: {missed}", run.detail);
        }
        assert!((line[line.len() - 1] - sample.load.a_g).abs() < 1e-12 * of_ground, "{:?}", run.detail);
        see(sample, &line);
    };
    let times = (0..80_000).map(|i| 1e-4 * f64::from(i)).take_while(|time| *time < found.finish.motion.time);
    run.sample(times, show, &mut ()).unwrap();
    curve
}

/// The line of a picture passes through both sides of each transition.
#[test]
fn lines_stay_as_close_to_the_motion_as_was_asked_for() {
    let ground = ground();
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    for detail in Detail::ALL {
        let run = Run { detail, end: End::At(8.0), ..Run::new(structure, &ground) };
        let lines = [Output::theta, Output::u(0), Output::a_t(0)];
        near_the_motion(&run, 1e-4, &lines, |_, _| ());
        let curve = near_the_motion(&run, 1e-2, &lines, |_, _| ());
        assert!(curve.transitions.len() > 10 || detail == Detail::FixedBase);
        assert!(curve.points.is_sorted_by(|a, b| a.time <= b.time));
        assert_eq!(curve.points.last().unwrap().time, curve.found.finish.motion.time);
        // at level `linear` an uplift follows an impact at the same instant
        for transition in curve.transitions.iter().filter(|_| detail != Detail::Linear) {
            let i = curve.points.partition_point(|point| point.time < transition.time);
            let (before, after) = (&curve.points[i], &curve.points[i + 1]);
            assert_eq!((before.time, after.time), (transition.time, transition.time));
            assert_eq!((before.outputs[1], after.outputs[1]), (transition.before.u, transition.after.u));
            assert_eq!(before.phase == Phase::FullContact, matches!(transition.kind, TransitionKind::Uplift(_)));
        }
    }
}

/// A run whose curve would fill the memory is refused.
#[test]
fn a_curve_has_no_more_points_than_a_picture_needs() {
    let ground = Record::at_rest(1.0);
    let structure = OneMass::new(Parameters { zeta_fc: 0.0, ..Parameters::MCMANUS }).unwrap();
    let initial = State { u: 1e-3, ..State::default() };
    let run = Run { initial, end: End::At(1e7), ..Run::new(structure, &ground) };
    let Err(RunError::TooManyPoints { most: 1_000_000, time }) = run.curve(1e-3) else { panic!("it is drawn") };
    assert!(time > 1.0 && time < 1e6, "{time}");
}

/// Three storeys whose lines and peaks are those of their samples, floor by floor.
#[test]
fn lines_of_many_masses_stay_as_close_to_each_floor() {
    let frame = three_storeys(0.02, &[("r", 0.93), ("P_0", 1e5), ("k_t", 1e6)]);
    let ground = ground();
    let run = Run { end: End::At(6.0), ..Run::of_modes(frame, &ground) };
    let theta = run.peaks().unwrap().0.theta().magnitude;
    let of_floors = (0..3).flat_map(|i| [Output::u(i), Output::a_t(i)]);
    let lines = Vec::from_iter([Output::theta, Output::V_t, Output::M_t].into_iter().chain(of_floors));
    let tendon = Output::drawn(&run.structure).len() - Output::OF_TIES.len();
    let curve = near_the_motion(&run, 1e-3, &lines, |sample, line| {
        let e = 2.0 * 1.5 * f64::sin(sample.motion.state.theta.abs() / 2.0);
        assert!((line[tendon] - 1e5 - 1e6 * e).abs() <= 1.1e-3 * 1.5e6 * theta, "{} {e}", line[tendon]);
    });
    let transitions = curve.found.finish.motion.transitions;
    assert!(transitions > 5 && curve.transitions.len() as u64 == transitions);
}
