//! Reactions on the ground and impulses of impacts: the balance of momentum.

use crate::common::{Balance, GAUSS, balance, sampled, transitions_of};
use rocking::run::{End, Run};
use rocking::{Detail, Load, OneMass, Parameters, Reactions, Sample};

/// Over a whole motion, momentum changes by what gravity, the ground's acceleration and F_t give it less what the
/// reactions and the impulses of impacts hand on to the ground, whatever the level of detail.
#[test]
fn the_momentum_balance_closes_across_impacts() {
    let ground = sampled(801, 2.5e-3, |t| 5.0 * (22.0 * t).sin());
    let forces = Vec::from_iter(ground.times().iter().map(|t| 150.0 * (9.0 * t).cos()));
    let ground = ground.clone().with_force(ground.times(), &forces).unwrap();
    for (parameters, detail) in [Parameters::MCMANUS, Parameters::EVISON]
        .into_iter()
        .flat_map(|parameters| Detail::ALL.map(|detail| (parameters, detail)))
    {
        let &Parameters { m, m0, g, .. } = &parameters;
        let structure = OneMass::new(parameters).unwrap();
        let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure, &ground) };
        let instants = transitions_of(&run).iter().map(|transition| transition.time).collect();
        let mut cuts = [ground.times().to_vec(), instants].concat();
        cuts.sort_by(f64::total_cmp);
        let nodes = cuts.windows(2).flat_map(|cut| {
            let duration = cut[1] - cut[0];
            GAUSS.map(|(node, weight)| (cut[0] + node * duration, weight * duration)).into_iter()
        });
        let nodes = Vec::from_iter(nodes.filter(|(_, weight)| *weight > 0.0));
        let (mut weights, mut given, mut size) = (nodes.iter(), [0.0; 3], [0.0; 3]);
        let see = |sample: &Sample| {
            let Some((_, weight)) = weights.next() else { return }; // the end of the run
            let (Load { a_g, F_t, .. }, Reactions { R_h, R_v, R_m }) = (sample.load, sample.reactions());
            let Balance { x, y, .. } = balance(&parameters, sample.motion.phase, &sample.motion.state);
            let rates = [
                F_t - (m + m0) * a_g - R_h,
                R_v - (m + m0) * g,
                F_t * y[0] + g * (m * x[0] + m0 * x[1]) - a_g * (m * y[0] + m0 * y[1]) - R_m,
            ];
            for (i, rate) in rates.into_iter().enumerate() {
                given[i] += weight * rate;
                size[i] += weight * rate.abs();
            }
        };
        let motion = run.sample(nodes.iter().map(|(time, _)| *time), see, &mut ()).unwrap().motion;
        assert_eq!((motion.transitions > 5, weights.len()), (detail != Detail::FixedBase, 0));
        let impulse = motion.impulse;
        let Balance { right, up, turning, .. } = balance(&parameters, motion.phase, &motion.state);
        let changes = [right + impulse.I_h, up - impulse.I_v, turning + impulse.I_m];
        for i in 0..3 {
            let name = detail.name();
            assert!((changes[i] - given[i]).abs() < 1e-8 * (size[i] + 1.0), "{name} {i}: {changes:?} {given:?}");
        }
        assert_eq!(impulse.I_v > 0.0, detail != Detail::FixedBase);
    }
}
