//! Units of acceleration, and how files write them.

use serde::Deserialize;
use std::{fmt, iter};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Unit {
    #[serde(rename = "g")]
    G,
    #[serde(rename = "m/s2")]
    MetrePerSecondSquared,
    #[serde(rename = "cm/s2", alias = "gal")]
    CentimetrePerSecondSquared,
    #[serde(rename = "mm/s2")]
    MillimetrePerSecondSquared,
    #[serde(rename = "in/s2")]
    InchPerSecondSquared,
    #[serde(rename = "ft/s2")]
    FootPerSecondSquared,
    #[serde(rename = "mg")]
    MilliG,
    #[serde(rename = "%g")]
    PercentG,
}

impl Unit {
    /// Every name by which a unit can be asked for.
    pub const NAMES: [(&str, Unit); 9] = [
        ("g", Unit::G),
        ("m/s2", Unit::MetrePerSecondSquared),
        ("cm/s2", Unit::CentimetrePerSecondSquared),
        ("gal", Unit::CentimetrePerSecondSquared),
        ("mm/s2", Unit::MillimetrePerSecondSquared),
        ("in/s2", Unit::InchPerSecondSquared),
        ("ft/s2", Unit::FootPerSecondSquared),
        ("mg", Unit::MilliG),
        ("%g", Unit::PercentG),
    ];

    /// The unit in m/s². A record's g means `g` (m/s²).
    pub fn in_m_s2(self, g: f64) -> f64 {
        match self {
            Unit::G => g,
            Unit::MetrePerSecondSquared => 1.0,
            Unit::CentimetrePerSecondSquared => 1e-2,
            Unit::MillimetrePerSecondSquared => 1e-3,
            Unit::InchPerSecondSquared => 0.0254,
            Unit::FootPerSecondSquared => 0.3048,
            Unit::MilliG => g / 1e3,
            Unit::PercentG => g / 1e2,
        }
    }

    /// The unit that `text` is, as files write it: `cm/s^2`, `cm/sec/sec`, `CM S-2`, `gal`, `gal (cm/s/s`, `g`.
    pub(super) fn named(text: &str) -> Option<Unit> {
        let unit = |name: &str| Unit::NAMES.iter().find_map(|(of, unit)| (*of == name).then_some(*unit));
        let text = plain(text).replace("sec", "s").replace("galcm", "cm").replace("s2gal", "s2");
        let length = text.strip_suffix("/s2").or(text.strip_suffix("/s/s")).or(text.strip_suffix("/ss"));
        let length = length.or(text.strip_suffix("s-2")).or(text.strip_suffix("ps2")).or(text.strip_suffix("s2"));
        match (length, text.as_str()) {
            (Some("inch"), _) => Some(Unit::InchPerSecondSquared),
            (Some("feet"), _) => Some(Unit::FootPerSecondSquared),
            (Some(length), _) => unit(&format!("{length}/s2")),
            (None, "g's") => Some(Unit::G),
            (None, "gals") => Some(Unit::CentimetrePerSecondSquared),
            (None, "milli-g" | "millig") => Some(Unit::MilliG),
            (None, text) => unit(text),
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let name = Unit::NAMES.iter().find(|(_, unit)| unit == self).map(|(name, _)| *name);
        out.write_str(name.unwrap_or_default())
    }
}

/// Unit of times that the heading of a column states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum TimeUnit {
    Unstated,
    Second,
    Millisecond,
}

impl TimeUnit {
    /// The unit that the `heading` of a column of times states: of `time`, `t`, these with a unit, and of a heading that is a
    /// unit or ends with one in brackets. None of any other heading, of a period, and of a heading with anything but letters.
    pub(super) fn of(heading: &str) -> Option<TimeUnit> {
        let heading = heading.to_lowercase();
        let is_plain = |letter: char| letter.is_alphabetic() || letter.is_whitespace() || "()[],.:/_".contains(letter);
        let words = heading.split(|letter: char| !letter.is_alphabetic());
        let words: Vec<_> = words.filter(|word| !word.is_empty() && *word != "in").collect();
        match words.as_slice() {
            _ if heading.contains("period") || !heading.chars().all(is_plain) => None,
            ["t" | "time" | "times" | "zeit"] => Some(TimeUnit::Unstated),
            [unit] | ["t" | "time" | "times" | "zeit", unit] => TimeUnit::named(unit),
            [.., unit] if heading.ends_with(&format!("({unit})")) || heading.ends_with(&format!("[{unit}]")) => {
                TimeUnit::named(unit)
            }
            _ => None,
        }
    }

    pub(super) fn named(text: &str) -> Option<TimeUnit> {
        match text {
            "s" | "sec" | "secs" | "second" | "seconds" => Some(TimeUnit::Second),
            "ms" | "msec" | "msecs" | "millisecond" | "milliseconds" => Some(TimeUnit::Millisecond),
            _ => None,
        }
    }

    /// The unit in seconds; an unstated unit is the second.
    pub(super) fn in_seconds(self) -> f64 {
        if self == TimeUnit::Millisecond { 1e-3 } else { 1.0 }
    }
}

/// Small letters, with powers as plain digits and without what units may have between them.
fn plain(text: &str) -> String {
    let plain =
        text.chars().filter(|letter| !letter.is_whitespace() && !"^*.()[_\u{b7}\u{22c5}\u{d7}".contains(*letter));
    let plain = plain.map(|letter| match letter {
        '\u{b2}' => '2',
        '\u{207b}' | '\u{2212}' => '-',
        letter => letter,
    });
    plain.flat_map(char::to_lowercase).collect()
}

/// Whether `line` has a unit of accelerations as a word anywhere.
pub(super) fn mentions_unit(line: &str) -> bool {
    let words = line.split(|letter: char| letter.is_whitespace() || ",;:=()[]{}\"".contains(letter));
    words.filter(|word| !word.is_empty()).any(|word| {
        let unit = word.trim_start_matches(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
        Unit::named(unit).is_some() || word.rsplit('/').next().is_some_and(|last| Unit::named(last).is_some())
    })
}

/// Words beside the unit in a heading: what has the unit, in which direction, and where.
const WORDS: &str = " a ac raw pga acc accel acceleration accelerations accelerogram aceleracion aceleraci\u{f3}n accelerazione \
    acc\u{e9}l\u{e9}ration beschleunigung ivme ag av ax ay az value values data series time times history record ground \
    floor base motion horizontal vertical longitudinal transverse radial north south east west up down component comp \
    channel chan ch no corrected uncorrected filtered scaled multiplied factor by unit units amplitudeunit unidades in of de los datos the dcoffset corr deg along across n \
    s e w u d z v h l t r x y ns ew ud sn we du ne nw se sw en hne hnn hnz hn1 hn2 ";

fn words(text: &str) -> Vec<String> {
    let text = text.to_lowercase().replace("a_g", "ag");
    text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// Whether `word` is one of [`WORDS`], with a number or without, or a bearing such as n90e.
pub(super) fn is_known(word: &str) -> bool {
    let is_digit = |letter: char| letter.is_ascii_digit();
    let bearing = word.strip_prefix(['n', 's']).and_then(|rest| rest.strip_suffix(['e', 'w']));
    let name = word.trim_end_matches(is_digit);
    bearing.is_some_and(|angle| !angle.is_empty() && angle.len() <= 2 && angle.chars().all(is_digit))
        || (name == word || !matches!(name, "" | "x" | "e" | "by")) && WORDS.contains(&format!(" {name} "))
}

/// Whether `text` has other words than [`WORDS`] and numbers, as titles have.
pub(super) fn is_prose(text: &str) -> bool {
    words(text).iter().any(|word| word.contains(char::is_alphabetic) && !is_known(word))
}

/// Whether `text` has no words but [`WORDS`], no numbers but those of channels and angles, and no sign of a product or before
/// a word.
fn is_understood(text: &str) -> bool {
    let (words, is_sign) = (words(text), |(at, _): (usize, &str)| !text[..at].ends_with(char::is_alphanumeric));
    let is_plain =
        |letter: char| letter.is_alphanumeric() || letter.is_whitespace() || ",:;=()[]{}/_.-#\"'".contains(letter);
    let is_word = |(index, word): (usize, &String)| match index.checked_sub(1).map(|before| words[before].as_str()) {
        Some("ch" | "chan" | "channel" | "no") if word.len() <= 2 => true,
        _ => is_known(word) || words.get(index + 1).is_some_and(|next| next == "deg"),
    };
    words.iter().enumerate().all(is_word) && text.chars().all(is_plain) && !text.match_indices('-').any(is_sign)
}

/// Unit of a column, as the heading states it.
#[derive(Debug, PartialEq)]
pub(super) enum HeadingUnit {
    Nothing,
    Unit(Unit),
    /// The unit is not clear: all of this heading, or a unit that is not known here.
    Unclear(String),
}

impl HeadingUnit {
    /// The unit that `heading` states, the heading of a column of accelerations or a line before samples alone:
    /// [words](is_understood), then the unit in brackets or after a blank, a slash, an underscore or the like, then words or a
    /// filter. `a_g` is the ground acceleration, whatever its unit. Words alone state nothing; all else is unclear.
    pub(super) fn of(heading: &str) -> HeadingUnit {
        const DIVIDERS: &[char] = &[' ', '\t', ',', ':', '=', '/', '_', '(', '[', '{', '#'];
        const LONGEST: usize = 200;
        if heading.len() > LONGEST {
            return HeadingUnit::Nothing;
        }
        let until = |start: usize, mark: &str| {
            let found = heading[start..].find(|letter| mark.contains(letter));
            (start, found.map_or(heading.len(), |length| start + length))
        };
        let starts = iter::once(0).chain(heading.match_indices(DIVIDERS).map(|(index, _)| index + 1));
        let named = |(start, end): (usize, usize)| {
            let is_a_g = || heading[..start].to_lowercase().ends_with("a_");
            let unit = Unit::named(&heading[start..end]).filter(|unit| *unit != Unit::G || !is_a_g())?;
            let after = heading[end..].to_lowercase();
            let after = after.split("filter").next().unwrap_or_default();
            (is_understood(&heading[..start]) && is_understood(after)).then_some(unit)
        };
        match starts.flat_map(|start| [until(start, ")]}"), until(start, ".")]).find_map(named) {
            Some(unit) => HeadingUnit::Unit(unit),
            None if is_understood(heading) => HeadingUnit::Nothing,
            None => HeadingUnit::Unclear(heading.to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_decides_its_unit() {
        let [g, m, cm, mm] =
            [Unit::G, Unit::MetrePerSecondSquared, Unit::CentimetrePerSecondSquared, Unit::MillimetrePerSecondSquared];
        for (headings, unit) in [
            (&["a_g[g]", "acc (G)", "acceleration g", "acc_g", "Acceleration, g", "a/g"][..], g),
            (&["CH 2, 090 deg, acc (g)", "acc x [g]"], g),
            (&["ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=30.0 Hz"], g),
            (&["a_g[m/s2]", "ACC (m/s^2)", "a [m s\u{207b}\u{b2}]", "a (m/sec/sec)", "acc_m_s2"], m),
            (&["Acc. / (m/s\u{b2})", "S90E m*s^-2"], m),
            (&["acc (cm/s2)", "gal", "N-S(gal)", "acc, cm/sec^2", "acc_cms2", "{cm/s\u{b2}}"], cm),
            (&["a (filtered) [mm/s2]", "a mm/s/s"], mm),
            (&["a [in/sec^2]"], Unit::InchPerSecondSquared),
            (&["acc_ft/s2"], Unit::FootPerSecondSquared),
            (&["ACC (mg)"], Unit::MilliG),
            (&["acc, %g"], Unit::PercentG),
        ] {
            headings
                .iter()
                .for_each(|heading| assert_eq!(HeadingUnit::of(heading), HeadingUnit::Unit(unit), "{heading}"));
        }
        for nothing in ["a_g", "acc", "acceleration", "ground motion", "", "a_G", "ag", "EW", "# a_g", "a (north)"] {
            assert_eq!(HeadingUnit::of(nothing), HeadingUnit::Nothing, "{nothing}");
        }
        let unclear = "acc (10^-3 g);acc (10-3 g);a [10\u{207b}\u{b3} g];acc (x0.1 g);acc (1000 x g);acc*1000 (g);acc x 1000 [m/s^2];\
            acc (g/1000);acc (g\u{b7}10^-3);acc (g) x 10;acc (g x10);acc (1/1000 g);acc (1e-3 g);acc*1000;acc [% of g];\
            acc (percent of g);acc per mille g;acc (thousandths of g);acc (g) scaled by 1000;minus acc (g);-acc (g);acc (-g);\
            acc (gal, not g);acc (m/s^2)*g;acc (cm/s/s) g;acc (kN);acc (foo);acc (cm/seg2);acc (cm/s);acc cm/s;acc (counts);\
            acc counts;acc (km/s2);acc (nm/s^2);peak 0.3 g;in g: 0.3;acc x10 (g);x 1000;acc 1000 (g);response";
        for unclear in unclear.split(';') {
            assert_eq!(HeadingUnit::of(unclear), HeadingUnit::Unclear(unclear.into()));
        }
    }

    #[test]
    fn every_name_is_read_back() {
        for (name, unit) in Unit::NAMES {
            assert_eq!(Unit::named(name), Some(unit));
            assert_eq!(Unit::named(&unit.to_string()), Some(unit));
        }
        let in_m_s2 = Unit::NAMES.map(|(_, unit)| unit.in_m_s2(9.81));
        assert_eq!(in_m_s2, [9.81, 1.0, 0.01, 0.01, 0.001, 12.0_f64.recip() * 0.3048, 0.3048, 9.81 / 1e3, 0.0981]);
    }

    #[test]
    fn a_heading_of_times_states_their_unit() {
        for (headings, unit) in [
            (&["t", "Time", "Zeit"][..], TimeUnit::Unstated),
            (&["t/s", "Zeit [s]", "time, sec"], TimeUnit::Second),
            (&["t/ms", "time_ms", "(ms)", "time in ms"], TimeUnit::Millisecond),
        ] {
            headings.iter().for_each(|heading| assert_eq!(TimeUnit::of(heading).as_ref(), Some(&unit), "{heading}"));
        }
        let others =
            "time*1000 (s);t (x10 s);t/10 (s);time history;trigger;theta;a (m/s2);acc;;T1;Period (s);t (min);f (Hz)";
        for other in others.split(';') {
            assert_eq!(TimeUnit::of(other), None, "{other}");
        }
    }
}
