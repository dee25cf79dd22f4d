//! The maps: a dot for every structure over slenderness and frequency.

use super::Change;
use super::population::{FREQUENCY, Pair, SLENDERNESS};
use crate::chart::{Axis, Entry, Figure, Marker, Panel, Style, colour};
use rocking::run::validity::{EDGE_LOAD, ENERGY, FRICTION, IMPACT_FRICTION, IMPACT_TENSION, TENSION};

/// A map: its title, its number for a structure, and the two numbers beyond which a dot changes its colour.
struct Map {
    title: &'static str,
    of: fn(&Pair) -> f64,
    limits: [f64; 2],
}

const fn dots(colour: plotters::style::RGBColor) -> Style {
    Style::marked(colour, 0, Marker::Circle)
}

/// Within the first limit, between both, beyond the second.
const CLASSES: [(&str, Style); 3] = [
    ("within both limits", dots(colour::PALE)),
    ("beyond the first", dots(colour::SKY)),
    ("beyond the second", dots(colour::VERMILLION)),
];

const SPECIMEN: Style = Style::marked(colour::BLACK, 0, Marker::Diamond);

const ASSUMED: [Map; 6] = [
    Map {
        title: "tension under a base that is down, over W: 0.05, 0.5",
        of: |pair| pair.model.found.worst[TENSION].value,
        limits: [0.05, 0.5],
    },
    Map {
        title: "pull at the edge while rocking, over W: 0, 1",
        of: |pair| -pair.model.found.worst[EDGE_LOAD].value,
        limits: [0.0, 1.0],
    },
    Map {
        title: "friction above 0.5: any, 5 % of the time",
        of: |pair| pair.model.found.worst[FRICTION].beyond / pair.model.found.duration,
        limits: [0.0, 0.05],
    },
    Map {
        title: "friction of impacts: 0.5, 1",
        of: |pair| pair.model.found.worst[IMPACT_FRICTION].value,
        limits: [0.5, 1.0],
    },
    Map {
        title: "pull of an impact, over its impulse: 0, 1",
        of: |pair| pair.model.found.worst[IMPACT_TENSION].value,
        limits: [0.0, 1.0],
    },
    Map {
        title: "energy gained at an impact, over T: 0, 0.01",
        of: |pair| pair.model.found.worst[ENERGY].value,
        limits: [0.0, 0.01],
    },
];

const REPAIRED: [Map; 2] = [
    Map { title: "change of the peak of θ: 5 %, 50 %", of: |pair| Change::of(pair).theta, limits: [0.05, 0.5] },
    Map { title: "change of the peak of a_t: 5 %, 50 %", of: |pair| Change::of(pair).a_t, limits: [0.05, 0.5] },
];

/// What is taken for granted, over `population`; `specimens` are marked.
pub fn assumed(population: &[Pair], specimens: &[(&str, Pair)]) -> Figure {
    figure("What the model leaves out", &ASSUMED, population, specimens, 3)
}

/// What the repaired rule of uplift changes.
pub fn repaired(population: &[Pair], specimens: &[(&str, Pair)]) -> Figure {
    figure("Uplift at R_m = B R_v instead of |u| = u_cr", &REPAIRED, population, specimens, 2)
}

fn figure(title: &str, maps: &[Map], population: &[Pair], specimens: &[(&str, Pair)], columns: usize) -> Figure {
    let mut legend: Vec<_> = CLASSES.map(|(text, style)| Entry::new(text, style)).into();
    legend.push(Entry::new("the two specimens", SPECIMEN));
    Figure {
        title: title.into(),
        panel: (480, 380),
        columns,
        panels: maps.iter().map(|map| panel(map, population, specimens)).collect(),
        legend_columns: 4,
        legend,
    }
}

fn panel(map: &Map, population: &[Pair], specimens: &[(&str, Pair)]) -> Panel {
    let x = Axis::linear("slenderness H/B", SLENDERNESS.0, SLENDERNESS.1);
    let y = Axis::logarithmic("frequency in full contact, Hz", FREQUENCY.0, FREQUENCY.1);
    let mut panel = Panel::new(map.title, x, y);
    for (class, (name, style)) in CLASSES.into_iter().enumerate() {
        let is_of_it = |pair: &&Pair| map.limits.iter().filter(|limit| (map.of)(pair) > **limit).count() == class;
        panel = panel.with(name, population.iter().filter(is_of_it).map(place), style);
    }
    for (name, pair) in specimens {
        let at = place(pair);
        panel = panel.with(*name, [at], SPECIMEN).note(at, *name, colour::BLACK);
    }
    panel
}

fn place(pair: &Pair) -> (f64, f64) {
    let parameters = pair.structure.parameters();
    (parameters.H / parameters.B, parameters.f_fc)
}
