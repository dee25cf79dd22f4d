//! Lateral coordinates: u of one mass, or a coordinate for each mode of a structure of many masses.
//!
//! A structure is a rigid base that carries modes of vibration in full contact. A formula of this room is a sum over the modes. For
//! one mass the sum is its only term, so that no result differs from the paper's formula in a bit.

use crate::numbers::Number;
use crate::numbers::dual::Dual;
use crate::numbers::most::Most;
use crate::series::extremes::{OFF_CHORD, off_chord};
use crate::series::taylor::evaluate;
use crate::structure::ground::{Footing, NONE_SETTLED, Settlements};
use crate::structure::mode::{Floor, MOST_MODES, Mode, Modes};
use crate::{Foundation, Structure};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use wide::f64x4;

/// Lateral coordinates in numbers of the kind `N`.
pub trait Lateral<N: Number>: Copy {
    /// The coordinates of a state of the same structures.
    type Of: Coordinates;

    /// The coordinate of mode `j`.
    fn of(&self, j: usize) -> N;

    /// The coordinates of the base on this `ground`.
    #[inline(always)]
    fn footing(&self, ground: &Foundation) -> Footing<N> {
        Footing::of(std::array::from_fn(|i| self.of(ground.place + i)))
    }

    /// The way of the base over this `ground`, m, if it may slide.
    #[inline(always)]
    fn slide(&self, ground: &Foundation) -> Option<N> {
        ground.slide().map(|place| self.of(place))
    }

    /// Of forces, what acts on mass that no mode carries, if there is such: the force, and its moment about the height of the pivots.
    #[inline(always)]
    fn rest(&self) -> Option<[N; 2]> {
        None
    }

    /// The sum of the coordinates times their `weights`.
    #[inline(always)]
    fn weighed(&self, weights: &Modes) -> N {
        if Self::Of::IS_ONE {
            return self.of(0) * weights.of[0];
        }
        let terms = weights.numbers().iter().enumerate().map(|(j, weight)| self.of(j) * *weight);
        terms.reduce(|sum, term| sum + term).unwrap_or(N::constant(0.0))
    }

    /// The modes of a structure, which has no more than there are coordinates.
    #[inline(always)]
    fn modes(structure: &Structure) -> &[Mode] {
        if Self::Of::IS_ONE { std::slice::from_ref(&structure.modes()[0]) } else { structure.modes() }
    }

    /// The ground that gives under a structure; never under one mass, whose engine is compiled without.
    #[inline(always)]
    fn foundation(structure: &Structure) -> Option<&Foundation> {
        if Self::Of::IS_ONE { None } else { structure.foundation() }
    }

    /// A sum over the modes of a structure.
    #[inline(always)]
    fn sum(structure: &Structure, term: impl Fn(usize, &Mode) -> N) -> N {
        let terms = Self::modes(structure).iter().enumerate().map(|(j, mode)| term(j, mode));
        terms.reduce(|sum, term| sum + term).unwrap_or(N::constant(0.0))
    }
}

/// Lateral coordinates of a state, or anything else that has a value for each mode.
pub trait Coordinates:
    Lateral<f64, Of = Self> + Debug + Default + PartialEq + Send + Serialize + DeserializeOwned + 'static
{
    /// Room for the settlements of contact points for good: none for one mass, which no ground gives under.
    type Settled: AsRef<[f64]>
        + AsMut<[f64]>
        + Copy
        + Debug
        + Default
        + PartialEq
        + Send
        + Sync
        + Serialize
        + DeserializeOwned;

    /// The settlements in this room; 0 if there is none.
    fn settlements(settled: &Self::Settled) -> &Settlements;

    /// All coordinates are 0.
    const ZERO: Self;

    /// Whether they are those of one mass.
    const IS_ONE: bool = false;

    /// Makes the coordinates of a structure, each from its number and its mode.
    fn each(structure: &Structure, coordinate: impl Fn(usize, &Mode) -> f64) -> Self;

    /// The generalized forces of horizontal `forces` (N) on the floors of a structure.
    fn of_forces(structure: &Structure, forces: impl Iterator<Item = f64>) -> Self;

    /// These coordinates beside what acts on mass that no mode carries among `forces`.
    #[inline(always)]
    fn beside(self, _forces: &Self) -> Self {
        self
    }

    /// The part that each mode takes in a `translation` of the base.
    #[inline]
    fn parts(structure: &Structure, translation: f64) -> Self {
        Self::each(structure, |_, mode| mode.part(translation))
    }

    /// Combines each coordinate with the one of `other`.
    fn with(self, other: &Self, combine: impl Fn(f64, f64) -> f64) -> Self;

    /// These coordinates plus `factor` times `other`.
    #[inline(always)]
    fn plus(self, other: Self, factor: f64) -> Self {
        self.with(&other, |own, other| own + other * factor)
    }

    /// These coordinates times `factor`.
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self.with(&Self::ZERO, |own, _| own * factor)
    }

    /// Writes the coordinate of mode `j`.
    fn set(&mut self, j: usize, number: f64);

    /// Writes the coordinates of the base on this `ground`.
    #[inline(always)]
    fn set_footing(&mut self, ground: &Foundation, footing: Footing) {
        footing.numbers().into_iter().enumerate().for_each(|(i, number)| self.set(ground.place + i, number));
    }

    /// The coordinates of four modes from `j` on; 0 of a mode that is none.
    fn four(&self, j: usize) -> f64x4;

    /// Writes the coordinates of four modes from `j` on.
    fn set_four(&mut self, j: usize, four: f64x4);

    /// Takes the number of modes of `other`; the coordinates of modes that are none must be 0.
    fn count_as(&mut self, other: &Self);

    /// Writes `factor` times `other` here.
    #[inline(always)]
    fn be(&mut self, other: &Self, factor: f64) {
        self.count_as(other);
        for j in (0..other.as_slice().len()).step_by(4) {
            self.set_four(j, other.four(j) * factor);
        }
    }

    /// The values at `sigma` of the polynomials with these coefficients.
    fn evaluate(coefficients: &[Self], sigma: f64) -> Self;

    /// How far the polynomials with these coefficients leave the chords between their ends, up to σ = `reach`.
    fn off_chord(coefficients: &[Self], reach: f64) -> Self;

    /// Bounds of the magnitudes of the polynomials with these coefficients, which end in `end`, up to σ = `reach`.
    fn most(coefficients: &[Self], end: &Self, reach: f64) -> Self;

    /// The coordinates in their order.
    fn as_slice(&self) -> &[f64];

    /// Whether no coordinate exceeds its limit in magnitude.
    #[inline(always)]
    fn is_within(&self, limits: &Self) -> bool {
        self.as_slice().iter().enumerate().all(|(j, own)| own.abs() <= limits.of(j)) && self.rest().is_none()
    }

    /// The sum of the coordinates: finite if all of them are.
    #[inline]
    fn total(&self) -> f64 {
        let [force, moment] = self.rest().unwrap_or_default();
        self.as_slice().iter().sum::<f64>() + force + moment
    }
}

/// Bounds of the magnitudes of coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mosts<Q>(pub Q);

impl<Q: Coordinates> Lateral<Most> for Mosts<Q> {
    type Of = Q;

    #[inline(always)]
    fn of(&self, j: usize) -> Most {
        Most(self.0.of(j))
    }
}

/// Coordinates and their rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Duals<Q> {
    pub value: Q,
    pub rate: Q,
}

impl<Q: Coordinates> Lateral<Dual<f64>> for Duals<Q> {
    type Of = Q;

    #[inline(always)]
    fn of(&self, j: usize) -> Dual<f64> {
        Dual { value: self.value.of(j), rate: self.rate.of(j) }
    }

    fn rest(&self) -> Option<[Dual<f64>; 2]> {
        let rests = [self.value.rest(), self.rate.rest()];
        let [value, rate] = rests.map(Option::unwrap_or_default);
        (rests != [None; 2]).then(|| [0, 1].map(|i| Dual { value: value[i], rate: rate[i] }))
    }
}

impl<N: Number> Lateral<N> for N {
    type Of = f64;

    #[inline(always)]
    fn of(&self, _: usize) -> N {
        *self
    }
}

impl Coordinates for f64 {
    type Settled = [f64; 0];

    #[inline(always)]
    fn settlements(_: &[f64; 0]) -> &Settlements {
        &NONE_SETTLED
    }

    const ZERO: f64 = 0.0;

    const IS_ONE: bool = true;

    #[inline(always)]
    fn each(structure: &Structure, coordinate: impl Fn(usize, &Mode) -> f64) -> f64 {
        coordinate(0, &structure.modes()[0])
    }

    #[inline(always)]
    fn of_forces(_: &Structure, forces: impl Iterator<Item = f64>) -> f64 {
        forces.reduce(|sum, force| sum + force).unwrap_or(0.0) // every floor moves as the mass does
    }

    #[inline(always)]
    fn parts(_: &Structure, translation: f64) -> f64 {
        translation
    }

    #[inline(always)]
    fn with(self, other: &f64, combine: impl Fn(f64, f64) -> f64) -> f64 {
        combine(self, *other)
    }

    #[inline(always)]
    fn set(&mut self, _: usize, number: f64) {
        *self = number;
    }

    #[inline(always)]
    fn four(&self, _: usize) -> f64x4 {
        f64x4::new([*self, 0.0, 0.0, 0.0])
    }

    #[inline(always)]
    fn set_four(&mut self, _: usize, four: f64x4) {
        *self = four.to_array()[0];
    }

    #[inline(always)]
    fn count_as(&mut self, _: &f64) {
        *self = 0.0;
    }

    #[inline(always)]
    fn evaluate(coefficients: &[f64], sigma: f64) -> f64 {
        evaluate(coefficients, sigma)
    }

    #[inline(always)]
    fn off_chord(coefficients: &[f64], reach: f64) -> f64 {
        off_chord(coefficients, reach)
    }

    #[inline(always)]
    fn most(coefficients: &[f64], end: &f64, reach: f64) -> f64 {
        coefficients[0].abs().max(end.abs()) + off_chord(coefficients, reach)
    }

    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        std::slice::from_ref(self)
    }
}

impl Lateral<f64> for Modes {
    type Of = Modes;

    #[inline(always)]
    fn of(&self, j: usize) -> f64 {
        self.of[j]
    }

    #[inline(always)]
    fn rest(&self) -> Option<[f64; 2]> {
        (self.rest != [0.0; 2]).then_some(self.rest)
    }

    /// In four sums side by side.
    #[inline(always)]
    fn weighed(&self, weights: &Modes) -> f64 {
        let mut sums = [0.0; 4];
        for (own, weights) in self.fours().zip(weights.fours()) {
            for i in 0..4 {
                sums[i] += own[i] * weights[i];
            }
        }
        sums.iter().sum()
    }
}

impl Coordinates for Modes {
    type Settled = Settlements;

    #[inline(always)]
    fn settlements(settled: &Settlements) -> &Settlements {
        settled
    }

    const ZERO: Modes = Modes { count: 0, of: [0.0; MOST_MODES], rest: [0.0; 2] };

    #[inline(always)]
    fn each(structure: &Structure, coordinate: impl Fn(usize, &Mode) -> f64) -> Modes {
        let mut modes = Modes { count: structure.coordinates().len(), ..Modes::ZERO };
        for (j, (of, mode)) in modes.of.iter_mut().zip(structure.coordinates()).enumerate() {
            *of = coordinate(j, mode);
        }
        modes
    }

    fn of_forces(structure: &Structure, forces: impl Iterator<Item = f64>) -> Modes {
        let mut on_modes = Modes::parts(structure, 0.0);
        let mut rest = [0.0; 2];
        for ((force, floor), gauge) in forces.zip(structure.floors()).zip(&structure.gauges().a) {
            on_modes = on_modes.plus(floor.shape, force);
            rest = [0, 1].map(|i| rest[i] + force * gauge.left[1 - i]);
        }
        Modes { rest, ..on_modes }
    }

    #[inline]
    fn beside(self, forces: &Modes) -> Modes {
        Modes { rest: forces.rest, ..self }
    }

    #[inline(always)]
    fn with(self, other: &Modes, combine: impl Fn(f64, f64) -> f64) -> Modes {
        Modes::with(self, other, combine)
    }

    #[inline]
    fn set(&mut self, j: usize, number: f64) {
        self.of[j] = number;
    }

    #[inline(always)]
    fn four(&self, j: usize) -> f64x4 {
        f64x4::new([self.of[j], self.of[j + 1], self.of[j + 2], self.of[j + 3]])
    }

    #[inline(always)]
    fn set_four(&mut self, j: usize, four: f64x4) {
        self.of[j..j + 4].copy_from_slice(&four.to_array());
    }

    #[inline(always)]
    fn count_as(&mut self, other: &Modes) {
        self.count = other.count;
    }

    fn evaluate(coefficients: &[Modes], sigma: f64) -> Modes {
        let mut value = Modes { count: coefficients[0].count, ..Modes::ZERO };
        for (four, value) in value.fours_mut().enumerate() {
            for c in coefficients.iter().rev() {
                let c = &c.of.as_chunks::<4>().0[four];
                *value = std::array::from_fn(|i| value[i] * sigma + c[i]);
            }
        }
        value
    }

    fn off_chord(coefficients: &[Modes], reach: f64) -> Modes {
        let mut off = Modes { count: coefficients[0].count, ..Modes::ZERO };
        for (four, off) in off.fours_mut().enumerate() {
            let mut power = reach;
            for (weight, c) in OFF_CHORD.iter().zip(coefficients).skip(2) {
                power *= reach;
                let c = &c.of.as_chunks::<4>().0[four];
                (0..4).for_each(|i| off[i] += weight * power * c[i].abs());
            }
        }
        off
    }

    #[inline(always)]
    fn most(coefficients: &[Modes], end: &Modes, reach: f64) -> Modes {
        let mut most = Modes::off_chord(coefficients, reach);
        for ((off, first), last) in most.fours_mut().zip(coefficients[0].fours()).zip(end.fours()) {
            (0..4).for_each(|i| off[i] += first[i].abs().max(last[i].abs()));
        }
        most
    }

    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        self.numbers()
    }
}

impl Floor {
    /// Elastic displacement of the floor at the coordinates `u`, m.
    pub fn displacement<Q: Coordinates>(&self, u: &Q) -> f64 {
        u.weighed(&self.shape)
    }
}
