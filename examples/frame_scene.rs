//! A frame of many masses under accelerations that are linear between samples: numbers are read, transitions, and
//! rotation, displacements and accelerations of the floors at the samples are printed (tests/test_frames.py).

use rocking::engine::Settings;
use rocking::structure::parameters::TIES;
use rocking::{Body, Detail, Engine, Floor, Ground, LinearLoad, Load, Modes, Output, State, Structure, Transition};
use rocking::{Mode, Ties};
use std::array::from_fn;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = std::io::read_to_string(std::io::stdin())?;
    let mut numbers = text.split_whitespace().map(|word| word.parse::<f64>().expect("a number"));
    let mut next = || numbers.next().expect("one more number");
    let [is_auto, tolerance, m0, J0, m_s, S_1, I_2, B, r, g] = from_fn(|_| next());
    let (r, mut ties) = ((r > 0.0).then_some(r), Ties::default());
    TIES.iter().take(next() as usize).for_each(|of| (of.set)(&mut ties, next()));
    let body = Body { m0, J0, m_s, S_1, I_2, B, r, g, c_ratio: 1.0, ties };
    let [modes, floors] = from_fn(|_| next() as usize);
    let read = [(); 4].map(|()| Modes::new(&Vec::from_iter((0..modes).map(|_| next()))));
    let [omega, zeta, gamma, kappa] = read.each_ref().map(Modes::numbers);
    let modes: Vec<_> = (0..modes).map(|j| Mode::new(omega[j], zeta[j], gamma[j], kappa[j])).collect();
    let floors: Vec<_> = (0..floors)
        .map(|_| Floor {
            mass: next(),
            height: next(),
            shape: Modes::new(&Vec::from_iter(modes.iter().map(|_| next()))),
        })
        .collect();
    let points = next() as usize;
    let [xi, k, c] = [(); 3].map(|()| Vec::from_iter((0..points).map(|_| next())));
    let frame = Structure::of_body(body, &modes, &floors)?;
    let [mu_c, fs] = [(); 2].map(|()| Some(next()).filter(|of| *of >= 0.0));
    let frame = if points == 0 { frame } else { frame.on(&Ground { xi, k, c, mu_c, fs, ..Ground::default() })? };
    let [dt, samples] = from_fn(|_| next());
    let ground: Vec<[f64; 2]> = (0..samples as usize).map(|_| from_fn(|_| next())).collect();

    let detail = if is_auto == 1.0 { Detail::Auto } else { Detail::Nonlinear };
    let settings = Settings { detail, tolerance, vertical: true, ..Settings::default() };
    let mut engine = Engine::of_modes(frame, State::default(), 0.0, settings)?;
    let mut show = |transition: &Transition<Modes>| println!("T {:?} {}", transition.time, transition.kind.name());
    for pair in ground.windows(2) {
        let [value, end] = [pair[0], pair[1]].map(|[a_g, a_v]| Load { a_g, a_v, ..Load::default() });
        let slope = Load { a_g: (end.a_g - value.a_g) / dt, a_v: (end.a_v - value.a_v) / dt, ..value };
        engine.advance(dt, LinearLoad { value, slope }, &mut show)?;
        let now = engine.sample(end);
        print!("S {:?}", now.output(Output::theta));
        if let Some(ground) = engine.structure().foundation() {
            print!(" {:?}", now.output(Output::y));
            ground.mu_c.iter().for_each(|_| print!(" {:?}", now.output(Output::x)));
            (0..ground.points.len()).filter(|_| ground.yields).for_each(|i| print!(" {:?}", now.output(Output::s(i))));
        }
        for of in [Output::u, Output::a_t] {
            (0..engine.structure().floors().len()).for_each(|floor| print!(" {:?}", now.output(of(floor))));
        }
        println!();
    }
    Ok(())
}
