//! The picture of a run over the height: the peaks of floors and storeys, and those of the structure on a fixed base.
use crate::picture::{Picture, TITLE, axes, chart, colour, dashed, line, titled};
use plotters::prelude::*;
use rocking::Output;
use rocking::mechanics::shown::Place;
use rocking_report::quantities::of_motion;
use rocking_report::run::{OF_FLOOR, RunReport, RunSetup};

const WIDTH: u32 = 1000;
const PLOT: u32 = 420;

/// Draws the peaks `found` in `run` over the height, and those of the same run on a fixed base.
pub fn draw(picture: Picture, run: &RunSetup, found: &RunReport) -> anyhow::Result<()> {
    let on_fixed_base = run.on_fixed_base(found.end)?;
    let [floors, fixed] = [found, &on_fixed_base].map(|found| run.floors(found));
    let (height, g) = (floors[floors.len() - 1][0], run.structure.base().g);
    picture.draw((WIDTH, TITLE + PLOT), |area| {
        let about = "peaks of floors and storeys; solid: rocking, dashed: the same structure on a fixed base";
        let area = titled(area, run.ground.title(), about)?;
        let shown = Vec::from_iter(Output::over_height());
        for (k, (area, (of, place))) in area.split_evenly((1, shown.len())).iter().zip(shown).enumerate() {
            let (label, i) = (
                of.legend().map_or("", |legend| legend.label),
                OF_FLOOR.iter().position(|(name, _)| *name == of.symbol()).expect("floors have its peaks"),
            );
            let most = floors.iter().chain(&fixed).map(|floor| floor[i]).fold(0.0, f64::max);
            let (per_unit, unit) = of_motion(most, of.unit(), g);
            let ground = [found, &on_fixed_base].map(|found| found.peaks[0].magnitude);
            let largest = 1.1 * most.max(if place == Place::Floors { ground[0] } else { 0.0 }) / per_unit;
            let across = 0.0..if largest > 0.0 { largest } else { 1.0 };
            let mut plot = chart(area, 46.0).build_cartesian_2d(across, 0.0..1.02 * height)?;
            axes(&mut plot, [&format!("{label} ({unit})"), if k == 0 { "height (m)" } else { " " }], [3, 8])?;
            let over = |floors: &[[f64; OF_FLOOR.len()]], ground| {
                points(floors, i, place, ground).into_iter().map(|(value, height)| (value / per_unit, height)).collect()
            };
            let [rocks, stands]: [Vec<_>; 2] = [over(&floors, ground[0]), over(&fixed, ground[1])];
            dashed(&mut plot, &stands, colour::VERMILLION)?;
            plot.draw_series([PathElement::new(rocks, line(colour::BLUE))])?;
        }
        Ok(())
    })
}

/// The line of value `i` over the height from the base on.
fn points(floors: &[[f64; OF_FLOOR.len()]], i: usize, place: Place, ground: f64) -> Vec<(f64, f64)> {
    let heights = || floors.iter().map(|floor| floor[0]);
    let below = || [0.0].into_iter().chain(heights());
    let values = floors.iter().map(|floor| floor[i]);
    match place {
        Place::Floors => [ground].into_iter().chain(values).zip(below()).collect(),
        Place::Feet => values.chain([0.0]).zip(below()).collect(),
        _ => {
            let ends = |((value, from), to)| [(value, from), (value, to)];
            values.zip(below()).zip(heights()).flat_map(ends).collect()
        }
    }
}
