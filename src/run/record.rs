//! A ground motion record: its samples, between which the ground accelerations are linear.

use std::sync::Arc;

/// Most samples that a record has.
pub const MAX_SAMPLES: usize = 10_000_000;

/// A ground motion: at least two samples, finite, at strictly increasing times.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Shared with the copies of the record, as the samples are until they are scaled.
    title: Arc<str>,
    times: Arc<[f64]>,
    /// At the first of the times, as the others: a component of fewer samples than times is 0 after its last sample.
    acceleration: Arc<[f64]>,
    /// None where the ground moves horizontally alone.
    vertical: Option<Arc<[f64]>>,
    /// On the top floor, N; none without a force.
    force: Option<Arc<[f64]>>,
}

/// Why samples, or their scales, are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages name the fields
pub enum SamplesError {
    /// Scales that leave no ground motion.
    #[error(
        "time_scale = {time_scale:?} and scale = {scale:?} leave no ground motion of {title:?}: a finite time_scale greater \
         than 0 is needed, and finite accelerations and slopes"
    )]
    BadScales { title: String, time_scale: f64, scale: f64 },
    /// Samples in memory are no ground motion.
    #[error("{title:?}: {problem}")]
    BadSamples { title: String, problem: String },
    /// The components of a ground motion, or a force, do not begin together.
    #[error("{other} begins at {begins:?} s and {title:?} at {start:?} s: shift the times of one of them")]
    Apart { title: String, start: f64, other: String, begins: f64 },
    /// One component is given twice.
    #[error("the vertical component of {title:?} has the samples of the horizontal one: use another file for it")]
    Twice { title: String },
}

impl Record {
    /// The record called `title` whose ground acceleration is `acceleration[i]` (m/s²) at `times[i]` (s): two or more
    /// samples, finite, at strictly increasing times.
    pub fn from_samples(
        title: impl Into<String>,
        times: Vec<f64>,
        acceleration: Vec<f64>,
    ) -> Result<Record, SamplesError> {
        let title = title.into();
        check_samples(&title, &times, ("acceleration", "m/s²", &acceleration))?;
        let (times, acceleration) = (times.into(), acceleration.into());
        Ok(Record { title: title.into(), times, acceleration, vertical: None, force: None })
    }

    /// Ground at rest for `duration` (s), greater than 0: free vibration.
    pub fn at_rest(duration: f64) -> Record {
        let (times, acceleration) = ([0.0, duration].into(), [0.0, 0.0].into());
        Record { title: "free vibration".into(), times, acceleration, vertical: None, force: None }
    }

    /// This ground motion with the vertical component `vertical`, positive upwards, whose first sample comes with its own. The
    /// samples are then at the times of both. After the last sample of the shorter component the ground rests in that
    /// direction: its acceleration jumps to 0. A component of zeros is no vertical motion: the ground motion stays as it is.
    pub fn with_vertical(self, vertical: &Record) -> Result<Record, SamplesError> {
        self.check_start(vertical.start(), || format!("the vertical component {:?}", vertical.title))?;
        if vertical.acceleration.iter().all(|a_v| *a_v == 0.0) {
            return Ok(self);
        }
        if vertical.acceleration == self.acceleration {
            return Err(SamplesError::Twice { title: self.title.to_string() });
        }
        let (record, vertical) = self.beside(&vertical.times, &vertical.acceleration);
        Ok(Record { vertical: Some(vertical), ..record })
    }

    /// This ground motion with the horizontal force `force[i]` (N, to the right) on the top floor at `times[i]` (s), linear between
    /// them: two samples or more, the first of which comes with the first of the ground motion. The samples are then at the times of
    /// both, as by [`Record::with_vertical`]. After its last sample the force is 0. A force of zeros is none. No scale changes the force.
    pub fn with_force(self, times: &[f64], force: &[f64]) -> Result<Record, SamplesError> {
        check_samples("force", times, ("F_t", "N", force))?;
        self.check_start(times[0], || "the force".into())?;
        if force.iter().all(|F_t| *F_t == 0.0) {
            return Ok(self);
        }
        let (record, force) = self.beside(times, force);
        Ok(Record { force: Some(force), ..record })
    }

    /// Refuses an `other` component that does not begin with the record, at `begins` (s).
    fn check_start(&self, begins: f64, other: impl FnOnce() -> String) -> Result<(), SamplesError> {
        let (title, start) = (self.title.to_string(), self.start());
        if begins == start { Ok(()) } else { Err(SamplesError::Apart { title, start, other: other(), begins }) }
    }

    /// This ground motion, and `other` at `times` (s), all at the times of both.
    fn beside(self, times: &[f64], other: &[f64]) -> (Record, Arc<[f64]>) {
        let mut all = [&self.times, times].concat();
        all.sort_by(f64::total_cmp);
        all.dedup();
        let at_all = |times: &[f64], values: &[f64]| -> Arc<[f64]> {
            let last = times[values.len() - 1];
            all.iter().take_while(|time| **time <= last).map(|time| at(times, values, *time)).collect()
        };
        let own = |of: Arc<[f64]>| at_all(&self.times, &of);
        let (acceleration, vertical, force) = (own(self.acceleration), self.vertical.map(own), self.force.map(own));
        let other = at_all(times, other);
        (Record { title: self.title, times: all.into(), acceleration, vertical, force }, other)
    }

    /// This ground motion without its vertical component, at the same times.
    pub fn without_vertical(self) -> Record {
        Record { vertical: None, ..self }
    }

    /// This ground motion with every time, also of the force, multiplied by `time_scale`, greater than 0, and every acceleration by
    /// `scale`; an error where that leaves no motion whose accelerations and slopes are finite.
    pub fn scaled(mut self, time_scale: f64, scale: f64) -> Result<Record, SamplesError> {
        self.times = self.times.iter().map(|time| time * time_scale).collect();
        let record = self.multiplied(scale);
        let is_motion = |(t, a): (&[f64], &[f64])| t[1] > t[0] && ((a[1] - a[0]) / (t[1] - t[0])).is_finite();
        let is_record = |of: &Arc<[f64]>| record.times.windows(2).zip(of.windows(2)).all(is_motion);
        let is_whole = is_record(&record.acceleration) && record.vertical.iter().chain(&record.force).all(is_record);
        match is_whole && record.end().is_finite() {
            true => Ok(record),
            false => Err(SamplesError::BadScales { title: record.title.to_string(), time_scale, scale }),
        }
    }

    /// This ground motion with every acceleration multiplied by a finite `scale`.
    pub fn multiplied(self, scale: f64) -> Record {
        self.multiplied_each(scale, scale)
    }

    /// This ground motion with every horizontal acceleration multiplied by `scale` and every vertical one by `vertical`.
    pub fn multiplied_each(self, scale: f64, vertical: f64) -> Record {
        let times = |of: Arc<[f64]>, scale: f64| if scale == 1.0 { of } else { of.iter().map(|a| a * scale).collect() };
        let (acceleration, vertical) = (times(self.acceleration, scale), self.vertical.map(|of| times(of, vertical)));
        Record { acceleration, vertical, ..self }
    }

    /// This ground motion under another title.
    pub fn titled(self, title: impl Into<String>) -> Record {
        Record { title: title.into().into(), ..self }
    }

    /// Title of the record.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Times of the samples, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Ground accelerations of the samples, m/s²: fewer than times if another component or the force lasts longer, and then 0.
    pub fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }

    /// Vertical ground accelerations of the samples, m/s², positive upwards, if there are any; 0 after the last.
    pub fn vertical(&self) -> Option<&[f64]> {
        self.vertical.as_deref()
    }

    /// Forces on the top floor at the samples, N, positive to the right, if there are any; 0 after the last.
    pub fn force(&self) -> Option<&[f64]> {
        self.force.as_deref()
    }

    /// Instant of the first sample, s.
    pub fn start(&self) -> f64 {
        self.times[0]
    }

    /// Instant of the last sample, s.
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Peak ground acceleration, m/s²; exact, because a straight line is largest at one of its ends.
    pub fn pga(&self) -> f64 {
        self.acceleration.iter().fold(0.0, |peak, a_g| peak.max(a_g.abs()))
    }

    /// Largest magnitude of the vertical ground acceleration, m/s²; 0 without a vertical component.
    pub fn vertical_peak(&self) -> f64 {
        self.vertical().into_iter().flatten().fold(0.0, |peak, a_v| peak.max(a_v.abs()))
    }

    /// Velocity (m/s) and displacement (m) of the ground at each sample, at rest before the first one: exact, as the
    /// acceleration is linear between samples.
    pub fn velocities_and_displacements(&self) -> impl Iterator<Item = [f64; 2]> {
        let steps = self.times.windows(2).zip(self.acceleration.windows(2).chain(std::iter::repeat(&[0.0; 2][..])));
        let after = |[velocity, displacement]: &mut [f64; 2], (times, a): (&[f64], &[f64])| {
            let step = times[1] - times[0];
            *displacement += step * (*velocity + step * (2.0 * a[0] + a[1]) / 6.0);
            *velocity += 0.5 * step * (a[0] + a[1]);
            Some([*velocity, *displacement])
        };
        [[0.0; 2]].into_iter().chain(steps.scan([0.0; 2], after))
    }
}

/// The acceleration at `time` (s), which is not after the last of `times`.
fn at(times: &[f64], acceleration: &[f64], time: f64) -> f64 {
    let next = times.partition_point(|of| *of < time);
    if times[next] == time {
        return acceleration[next];
    }
    let part = (time - times[next - 1]) / (times[next] - times[next - 1]);
    acceleration[next - 1] + part * (acceleration[next] - acceleration[next - 1])
}

/// Refuses `samples`, which have a name, a unit and values, where they are none of a record or a force of this `title`.
fn check_samples(title: &str, times: &[f64], samples: (&str, &str, &[f64])) -> Result<(), SamplesError> {
    let refused = |problem| Err(SamplesError::BadSamples { title: title.into(), problem });
    let (name, counts) = (samples.0, (times.len(), samples.2.len()));
    if counts.0 != counts.1 || counts.0 < 2 {
        let needed = "instead of two or more of each, equally many";
        return refused(format!("{} time(s) and {} {name}(s) {needed}", counts.0, counts.1));
    }
    for (name, unit, values) in [("times", "s", times), samples] {
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            return refused(format!("{name}[{i}] = {} {unit} is not finite", values[i]));
        }
    }
    let late = times.windows(2).position(|pair| pair[1] <= pair[0]);
    late.map_or(Ok(()), |i| {
        refused(format!("times[{}] = {} s does not come after times[{i}] = {} s", i + 1, times[i + 1], times[i]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a_g = 6 t over 1 s: t² · 3 and t³; then of 6 - 12 (t - 1), by hand.
    #[test]
    fn integrals_are_exact() {
        let record = Record::from_samples("", vec![2.0, 3.0, 4.0], vec![0.0, 6.0, -6.0]).unwrap();
        let integrals: Vec<_> = record.velocities_and_displacements().collect();
        assert_eq!(integrals, [[0.0, 0.0], [3.0, 1.0], [3.0, 5.0]]);
    }

    /// By hand: two steps, 1 s and 0.5 s, the horizontal component ends first and has not come to rest.
    #[test]
    fn components_with_other_steps_are_samples_at_the_times_of_both() {
        let own = Record::from_samples("own", vec![0.0, 1.0], vec![2.0, 4.0]).unwrap();
        let vertical = Record::from_samples("up", vec![0.0, 0.5, 1.0, 1.5], vec![0.0, -8.0, 1.0, 3.0]).unwrap();
        let both = own.clone().with_vertical(&vertical).unwrap();
        assert_eq!(both.times(), [0.0, 0.5, 1.0, 1.5]);
        assert_eq!(both.acceleration(), [2.0, 3.0, 4.0]);
        assert_eq!(both.vertical().unwrap(), [0.0, -8.0, 1.0, 3.0]);
        assert_eq!(both.velocities_and_displacements().last().unwrap(), [3.0, 17.0 / 6.0]);
        let scaled = both.scaled(0.5, 10.0).unwrap();
        assert_eq!((scaled.end(), scaled.acceleration()[1], scaled.vertical().unwrap()[1]), (0.75, 30.0, -80.0));
        let late = Record::from_samples("late", vec![0.1, 1.0], vec![0.0, 1.0]).unwrap();
        let refused = own.with_vertical(&late).unwrap_err().to_string();
        let expected = "the vertical component \"late\" begins at 0.1 s and \"own\" at 0.0 s";
        assert!(refused.starts_with(expected), "{refused}");
    }

    /// By hand: the force has a sample between those of the ground, and ends first.
    #[test]
    fn a_force_is_at_the_times_of_both_and_keeps_its_size() {
        let own = Record::from_samples("own", vec![0.0, 1.0, 2.0], vec![2.0, 4.0, -2.0]).unwrap();
        let pushed = |times: &[f64], F_t: &[f64]| own.clone().with_force(times, F_t);
        let both = pushed(&[0.0, 0.5], &[3.0, 5.0]).unwrap().with_vertical(&own.clone().multiplied(2.0)).unwrap();
        assert_eq!((both.times(), both.acceleration()[1]), (&[0.0, 0.5, 1.0, 2.0][..], 3.0));
        assert_eq!(both.force().unwrap(), [3.0, 5.0]);
        let scaled = both.scaled(0.5, 10.0).unwrap();
        assert_eq!((scaled.times()[1], scaled.acceleration()[1], scaled.force().unwrap()[1]), (0.25, 30.0, 5.0));
        assert_eq!(pushed(&[0.0, 9.0], &[0.0; 2]), Ok(own.clone()));
        for (times, F_t, refused) in [
            (&[0.5, 1.0][..], &[1.0; 2][..], "the force begins at 0.5 s and \"own\" at 0.0 s: shift"),
            (&[0.0, 1.0], &[1.0; 3], "\"force\": 2 time(s) and 3 F_t(s) instead of two or more of each"),
            (&[0.0, 1.0], &[1.0, f64::NAN], "\"force\": F_t[1] = NaN N is not finite"),
        ] {
            let error = pushed(times, F_t).unwrap_err().to_string();
            assert!(error.starts_with(refused), "{error}");
        }
    }

    #[test]
    fn refused_samples_are_named_by_index_and_value() {
        let refused = |times: &[f64], acceleration: &[f64], problem: &str| {
            let error = Record::from_samples("pulse", times.into(), acceleration.into()).unwrap_err();
            assert_eq!(error.to_string(), format!("\"pulse\": {problem}"));
        };
        refused(&[], &[], "0 time(s) and 0 acceleration(s) instead of two or more of each, equally many");
        refused(&[0.0], &[1.0], "1 time(s) and 1 acceleration(s) instead of two or more of each, equally many");
        refused(&[0.0, 1.0], &[1.0; 3], "2 time(s) and 3 acceleration(s) instead of two or more of each, equally many");
        refused(&[0.0, f64::NAN], &[1.0; 2], "times[1] = NaN s is not finite");
        refused(&[0.0, 1.0], &[f64::NEG_INFINITY, 1.0], "acceleration[0] = -inf m/s² is not finite");
        refused(&[0.0, 0.5, 0.5], &[1.0; 3], "times[2] = 0.5 s does not come after times[1] = 0.5 s");
        refused(&[0.0, -0.5, 1.0], &[1.0; 3], "times[1] = -0.5 s does not come after times[0] = 0 s");
    }

    #[test]
    fn scales_that_leave_no_ground_motion_are_refused() {
        let record = || Record::from_samples("pulse", vec![1.0, 2.0, 4.0], vec![2.0, 4.0, 0.0]).unwrap();
        let times = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-320].map(|time_scale| (time_scale, 1.0));
        for (time_scale, scale) in times.into_iter().chain([f64::NAN, 1e308].map(|scale| (1.0, scale))) {
            let refused = record().scaled(time_scale, scale).unwrap_err().to_string();
            let expected = format!("time_scale = {time_scale:?} and scale = {scale:?} leave no ground motion");
            assert!(refused.starts_with(&expected), "{refused}");
        }
        assert_eq!(record().scaled(2.0, -1.0).unwrap().acceleration(), [-2.0, -4.0, 0.0]);
    }
}
