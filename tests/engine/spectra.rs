//! Floor spectra against an integration of their own: Duhamel's integral over short steps by Gauss's rule, of samples of a_t.

use crate::common::{GAUSS, shaking, transitions_of};
use crate::modes::three_storeys;
use rocking::estimates::response_spectrum::{FloorContents, floor_spectra};
use rocking::run::{End, Run, Runs};
use rocking::{Ground, OneMass, Output, Parameters, Piece, Structure, Watch};
use std::array;
use std::f64::consts::TAU;

/// The longest step, s: 0.16 rad of the stiffest oscillator.
const STEP: f64 = 5e-4;

/// An oscillator with its motion u, u̇ and its largest |ü + a|.
#[derive(Clone, Copy)]
struct Oscillator {
    omega: f64,
    zeta: f64,
    motion: [f64; 2],
    peak: f64,
}

impl Oscillator {
    /// The motion after `tau` seconds, with the acceleration at Gauss's nodes.
    fn after(&self, tau: f64, a: [f64; 4]) -> [f64; 2] {
        let &Oscillator { omega, zeta, motion: [u, u_dot], .. } = self;
        let free = |t: f64| {
            let (d, decay) = (omega * (1.0 - zeta * zeta).sqrt(), (-zeta * omega * t).exp());
            (decay * (d * t).cos(), decay * (d * t).sin() / d)
        };
        let (C, S) = free(tau);
        let damping = zeta * omega * S;
        let start = [(C + damping) * u + S * u_dot, (C - damping) * u_dot - omega * omega * S * u];
        GAUSS.iter().zip(a).fold(start, |[u, u_dot], ((node, weight), a)| {
            let (C, S) = free(tau * (1.0 - node));
            [u - tau * weight * a * S, u_dot - tau * weight * a * (C - zeta * omega * S)]
        })
    }

    /// ü + a and its rate, with the acceleration `a`.
    fn absolute(&self, [u, u_dot]: [f64; 2], a: f64) -> [f64; 2] {
        let (stiffness, damping) = (self.omega * self.omega, 2.0 * self.zeta * self.omega);
        let absolute = stiffness * u + damping * u_dot;
        [absolute, stiffness * u_dot - damping * (a + absolute)]
    }

    /// Goes on for `tau` seconds, at the nodes and the ends of which the acceleration is `a`, at other times `at`.
    fn go_on(&mut self, tau: f64, (nodes, ends): ([f64; 4], [f64; 2]), at: &dyn Fn(f64) -> f64) {
        let end = self.after(tau, nodes);
        let [first, last] = [self.absolute(self.motion, ends[0]), self.absolute(end, ends[1])];
        self.peak = self.peak.max(last[0].abs());
        if first[1] * last[1] < 0.0 && last[0].abs() > 0.9 * self.peak {
            let (mut low, mut high) = (0.0, tau);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                let there = self.after(middle, GAUSS.map(|(node, _)| at(middle * node)));
                let [absolute, rate] = self.absolute(there, at(middle));
                self.peak = self.peak.max(absolute.abs());
                *(if rate * first[1] > 0.0 { &mut low } else { &mut high }) = middle;
            }
        }
        self.motion = end;
    }
}

/// Oscillators on each floor.
struct Floors(Vec<Vec<Oscillator>>);

impl<Q: Runs> Watch<Q> for Floors {
    fn piece(&mut self, piece: &Piece<Q>) {
        for (i, oscillators) in self.0.iter_mut().enumerate() {
            go_on(oscillators, piece.duration, &|tau| piece.sample(piece.before.time + tau).output(Output::a_t(i)));
        }
    }
}

/// All go on for `duration` (s) under the acceleration `a`.
fn go_on(oscillators: &mut [Oscillator], duration: f64, a: &dyn Fn(f64) -> f64) {
    let steps = (duration / STEP).ceil();
    let step = duration / steps;
    for start in (0..steps as u32).map(|i| f64::from(i) * step) {
        let at = |tau| a(start + tau);
        let known = (GAUSS.map(|(node, _)| at(node * step)), [at(0.0), at(step)]);
        oscillators.iter_mut().for_each(|of| of.go_on(step, known, &at));
    }
}

/// Forty oscillators on every floor of `run`, whose structure makes at least so many transitions in 4 s; one at 1 ms has the peak of a_t.
fn assert_spectra<Q: Runs>(run: Run<Q>, transitions: usize) {
    let (end, floors) = (4.0, Vec::from_iter(0..run.structure.floors().len()));
    let run = Run { end: End::At(end), ..run };
    assert!(transitions_of(&run).len() >= transitions, "{}", transitions_of(&run).len());
    let of: [_; 40] = array::from_fn(|i| (0.02 * f64::powf(200.0, i as f64 / 39.0), [0.0, 0.02, 0.05, 0.3][i % 4]));
    let own = |(T, zeta)| Oscillator { omega: TAU / T, zeta, motion: [0.0; 2], peak: 0.0 };
    let mut expected = Floors(vec![of.map(own).to_vec(); floors.len()]);
    run.follow(&mut expected).unwrap();
    let (peaks, _) = run.peaks().unwrap();
    let all = floors.iter().flat_map(|floor| of.map(|(T, zeta)| FloorContents { floor: *floor, T, zeta }));
    let found = floor_spectra(&run, end, &Vec::from_iter(all), &mut ()).unwrap();
    for (floor, found) in found.chunks(of.len()).enumerate() {
        go_on(&mut expected.0[floor], 2.0, &|_| 0.0);
        for ((of, found), Oscillator { peak, .. }) in of.iter().zip(found).zip(&expected.0[floor]) {
            assert!((found - peak).abs() <= 1e-9 * peak, "floor {floor}, {of:?}: {found}, not {peak}");
        }
        let stiff = floor_spectra(&run, end, &[FloorContents { floor, T: 1e-3, zeta: 0.7 }], &mut ()).unwrap()[0];
        let peak = peaks.of(Output::a_t(floor)).unwrap().magnitude;
        assert!((stiff - peak).abs() < 1e-3 * peak, "floor {floor}: {stiff}, not {peak}");
    }
}

#[test]
fn a_floor_has_the_spectrum_of_its_acceleration() {
    let tied = Parameters { P_0: 400.0, k_t: 2e4, xi_d: 0.2, c_d: 150.0, k_d: 2e5, F_y: 120.0, ..Parameters::MCMANUS };
    let [weak, ground] = [2.0, 4.0].map(|peak| shaking(3, 0.01, 301, peak));
    for (parameters, ground) in [(Parameters::MCMANUS, &weak), (tied, &ground)] {
        assert_spectra(Run::new(OneMass::new(parameters).unwrap(), ground), 10);
    }
    let springs = Ground { f_v: Some(20.0), zeta_v: Some(0.1), n_points: Some(4.0), ..Ground::default() };
    let springs = Structure::new(Parameters { J0: 1.2, ..Parameters::EVISON }).unwrap().on(&springs).unwrap();
    for structure in [three_storeys(0.02, &[]), springs] {
        assert_spectra(Run::of_modes(structure, &ground), 10);
    }
}
