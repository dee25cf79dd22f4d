//! The instant at which a guard closes within a step: secants within a bracket.

/// The search ends when it moves by less than this part of the bracket; what is left is smaller by orders of magnitude.
const CONVERGED: f64 = 1e-12;

/// Halvings of the bracket that reach rounding from anywhere.
const MAX_ITERATIONS: usize = 100;

/// The root of a guard that is `open` (> 0) at 0 and ≤ 0 at `end`. `guard` yields its value and whatever belongs to it.
pub fn first_root<T, E>(open: f64, end: f64, mut guard: impl FnMut(f64) -> Result<(f64, T), E>) -> Result<(f64, T), E> {
    let (mut low, mut high) = (0.0, end);
    let (mut last, mut last_value) = (0.0, open);
    let (mut tau, (mut value, mut found)) = (end, guard(end)?);
    for _ in 0..MAX_ITERATIONS {
        if value == 0.0 {
            break;
        }
        let mut next = tau - value * (tau - last) / (value - last_value);
        if !(next > low && next < high) {
            next = low + 0.5 * (high - low);
        }
        (last, last_value) = (tau, value);
        tau = next;
        (value, found) = guard(tau)?;
        if (tau - last).abs() <= CONVERGED * end {
            break;
        }
        *(if value > 0.0 { &mut low } else { &mut high }) = tau;
    }
    Ok((tau, found))
}
