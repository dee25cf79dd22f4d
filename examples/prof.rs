use rocking::run::record::Record;
use rocking::run::validity::Limits;
use rocking::run::{End, Run};
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Given;
use rocking::{Frame, Parameters, Structure};
use std::collections::BTreeMap;
fn base(parameters: &Parameters) -> Given {
    let &Parameters { m0, B, J0, r, g, c_ratio, .. } = parameters;
    let own = [("m0", m0), ("B", B), ("J0", J0), ("r", r), ("g", g), ("c_ratio", c_ratio)];
    Given::try_from(BTreeMap::from_iter(own.into_iter().map(|(n, v)| (n.to_owned(), v)))).unwrap()
}
fn main() {
    let text = std::fs::read_to_string("out/RSN6_IMPVALL.I_I-ELC180-hor1.AT2").unwrap();
    let a: Vec<f64> = text
        .lines()
        .skip(4)
        .flat_map(|l| l.split_whitespace().map(|x| x.parse::<f64>().unwrap() * 9.81).collect::<Vec<_>>())
        .collect();
    let t: Vec<f64> = (0..a.len()).map(|i| i as f64 * 0.01).collect();
    let ground = Record::from_samples("", t, a).unwrap();
    let p = Parameters::MCMANUS;
    let one = Structure::new(p).unwrap();
    let w = std::f64::consts::TAU * p.f_fc;
    let storey = Storey { m: p.m, h: p.H, k: p.m * w * w };
    let same = Frame::from_storeys(&base(&p), &Damping::All(p.zeta_fc), &[storey]).unwrap();
    let storeys = [(40e3, 3.5, 60e6), (40e3, 7.0, 50e6), (30e3, 10.5, 40e6)].map(|(m, h, k)| Storey { m, h, k });
    let b = Parameters { m0: 20e3, B: 1.5, J0: 3e4, r: 0.93, g: 9.81, c_ratio: 1.0, ..p };
    let three = Frame::from_storeys(&base(&b), &Damping::All(0.02), &storeys).unwrap();
    let which = std::env::args().nth(1).unwrap();
    let n: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let _ = (End::AtRest, Limits::default());
    for _ in 0..n {
        match &*which {
            "one" => {
                std::hint::black_box(Run::new(one, &ground).found(&mut ()).unwrap());
            }
            "same" => {
                std::hint::black_box(Run::of_modes(same.clone(), &ground).found(&mut ()).unwrap());
            }
            "three" => {
                std::hint::black_box(Run::of_modes(three.clone(), &ground).found(&mut ()).unwrap());
            }
            "one0" => {
                let f = Run::new(one, &ground).follow(&mut ()).unwrap();
                std::hint::black_box(f);
            }
            "same0" => {
                std::hint::black_box(Run::of_modes(same.clone(), &ground).follow(&mut ()).unwrap());
            }
            "three0" => {
                std::hint::black_box(Run::of_modes(three.clone(), &ground).follow(&mut ()).unwrap());
            }
            _ => panic!(),
        }
    }
}
