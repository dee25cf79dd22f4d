//! A ground motion made for the tests.

use rocking::{Parameters, State};
use study::scene::{StudyScene, ground};

/// McManus's specimen under four sines that swell and fade, sampled every 0.01 s for 4 s.
pub fn scene() -> StudyScene {
    const SAMPLES: usize = 401;
    let dt = 0.01;
    let sines = [(0.9, 0.3), (1.7, 1.1), (3.1, 2.9), (5.3, 0.2)];
    let a_g = (0..SAMPLES).map(|k| k as f64 * dt).map(|t| {
        let swell = (std::f64::consts::PI * t / (SAMPLES as f64 * dt)).sin();
        let sum: f64 = sines.iter().map(|(f, phase)| (std::f64::consts::TAU * f * t + phase).sin()).sum();
        1.6 * swell * sum
    });
    let title = "McManus's specimen, four sines";
    StudyScene::new("synthetic", title, Parameters::MCMANUS, State::default(), ground(dt, a_g.collect()))
}
