//! The lag between two logs that do not begin together, of all frames and of parts, by cross-correlation of the readings' sum
//! with the load.

use std::ops::Range;

use crate::numbers::{correlation, sorted};

/// A lag is used only if it explains this share of the variance.
const EXPLAINS: f64 = 0.7;
/// Lags that leave half of the variance are none that could be meant.
const HALF: f64 = 0.5;
/// A share of the variance that rounding alone leaves.
const ROUNDING: f64 = 1e-6;
/// Fewer frames tell no lag.
pub(super) const FRAMES: usize = 40;
/// Lags of more than this share of the frames are not looked at.
const SHARE: usize = 4;
/// Products at most.
const WORK: usize = 20_000_000;

/// Places that are tried for what one log lacks,
const PLACES: usize = 64;
/// and the share of the variance that it leaves of what its ends do.
const CLEARLY: f64 = 0.25;

/// Parts of a recording that are looked at for missing frames.
const PARTS: usize = 8;
/// A lag is worse than the best of a part from so many times its variance on: creep and curves let a wrong one look better.
const APART_IN_PART: [f64; 2] = [4.0; 2];
/// A part counts if its loads range over this share of the range of all.
const VARIES: f64 = 0.5;
/// Parts on either side of missing frames that agree, at least,
const AGREE: usize = 2;
/// or the first or the last part alone, if its loads cross the middle so often: what ends within a touch looks late.
const CROSSINGS: usize = 3;

/// What each lag leaves unexplained of the readings' variance.
pub(super) struct Lags {
    /// From the farthest lag before to the farthest behind, those of the other sign as 1.
    left: Vec<f64>,
    /// The sign that counts; without one, both.
    pub(super) sign: Option<f64>,
    /// A lag that fits nearly as well with the other sign: 0, or else the best.
    turned: Option<isize>,
    /// A lag that leaves more is worse than the best.
    alike: f64,
    /// One that leaves more is clearly worse.
    near: f64,
}

/// Two lags of which neither is clearly better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Unclear {
    pub(super) best: isize,
    pub(super) other: isize,
    /// Whether the other fits with the sign turned.
    pub(super) is_turned: bool,
}

impl Lags {
    /// Of readings and loads. `apart` says how many times the best one's variance a worse lag leaves, and a clearly worse one.
    /// Of a `sign` that is expected of their correlation the other counts only where no lag of this one fits nearly as well.
    /// Nothing where no lag explains the readings.
    pub(super) fn of(readings: &[f64], loads: &[Option<f64>], apart: [f64; 2], sign: Option<f64>) -> Option<Self> {
        let count = readings.len().min(loads.len());
        if count < FRAMES {
            return None;
        }
        let farthest = (count / SHARE).min(WORK / count) as isize;
        let found: Vec<f64> = (-farthest..=farthest).map(|lag| correlate(readings, loads, lag)).collect();
        let left = |sign: Option<f64>| -> Vec<f64> { found.iter().map(|found| unexplained(*found, sign)).collect() };
        let least = |left: &[f64]| left.iter().copied().fold(f64::INFINITY, f64::min);
        let both = Self { left: left(None), sign: None, turned: None, alike: 0.0, near: 0.0 };
        let best = least(&both.left);
        let alike = apart[0] * best.max(ROUNDING);
        let both = Self { alike, near: (apart[1] * best).min(HALF).max(alike), ..both };
        if best > 1.0 - EXPLAINS {
            return None;
        }
        let Some(sign) = sign else { return Some(both) };
        let [right, other] = [sign, -sign].map(|sign| Self { left: left(Some(sign)), sign: Some(sign), ..both });
        if least(&right.left) > both.near {
            return Some(other);
        }
        let is_near = |lag: &isize| other.left[other.zero().saturating_add_signed(*lag)] <= both.near;
        let turned = [Some(0), other.best_of(0..found.len())].into_iter().flatten().find(is_near);
        Some(Self { turned, ..right })
    }

    fn zero(&self) -> usize {
        self.left.len() / 2
    }

    /// Whether this lag is as good as the best.
    pub(super) fn allow(&self, lag: isize) -> bool {
        let place = self.zero().checked_add_signed(lag);
        place.and_then(|place| self.left.get(place)).is_some_and(|left| *left <= self.alike)
    }

    /// The lags around one that are not clearly worse than the best: those of the same edges.
    fn around(&self, place: usize) -> Range<usize> {
        let is_worse = |place: &usize| self.left[*place] > self.near;
        let first = (0..=place).rfind(is_worse).map_or(0, |before| before + 1);
        first..(place..self.left.len()).find(is_worse).unwrap_or(self.left.len())
    }

    /// The best lag of some.
    fn best_of(&self, places: Range<usize>) -> Option<isize> {
        let best = places.min_by(|&a, &b| self.left[a].total_cmp(&self.left[b]))?;
        Some(best as isize - self.zero() as isize)
    }

    /// The best lag around 0, if one there is not clearly worse than the best of all.
    pub(super) fn best_around_zero(&self) -> Option<isize> {
        self.best_of(self.around(self.zero()))
    }

    /// The best lag, where none leaves more than half unexplained.
    pub(super) fn far_better(&self) -> Option<isize> {
        self.best().ok().filter(|lag| *lag != 0 && self.left[self.zero()] > HALF)
    }

    /// By how many frames the loads come late, 0 where that is as good as any.
    ///
    /// # Errors
    ///
    /// The best lag and another of which it is not clearly better, unless the best is around 0.
    pub(super) fn best(&self) -> Result<isize, Unclear> {
        let zero = self.zero();
        let best = self.best_of(0..self.left.len()).filter(|_| !self.allow(0)).unwrap_or(0);
        let around = self.around(zero.saturating_add_signed(best));
        let turned = self.turned.filter(|_| !around.contains(&zero));
        let turned = turned.map(|other| Unclear { best, other, is_turned: true });
        let mut others = std::iter::once(zero).chain(0..around.start).chain(around.end..self.left.len());
        let other = others.find(|&place| self.left[place] <= self.near).filter(|other| !around.contains(other));
        let other = other.map(|other| Unclear { best, other: other as isize - zero as isize, is_turned: false });
        // That the sign may be what differs is said first where lag 0 has it.
        turned.filter(|turned| turned.other == 0).or(other).or(turned).map_or(Ok(best), Err)
    }
}

/// Parts of a recording whose loads vary.
pub(super) struct Parts<'a> {
    loads: &'a [Option<f64>],
    length: usize,
    /// Where each begins, and its lags.
    all: Vec<(usize, Lags)>,
}

impl<'a> Parts<'a> {
    pub(super) fn of(readings: &[f64], loads: &'a [Option<f64>], sign: Option<f64>) -> Self {
        let range = |loads: &[Option<f64>]| {
            let sorted = sorted(loads.iter().flatten().copied());
            sorted.last().zip(sorted.first()).map_or(0.0, |(most, least)| most - least)
        };
        let (length, least) = (readings.len() / PARTS, VARIES * range(loads));
        let part = |begin: usize| {
            let loads = &loads[begin..][..length];
            let readings = &readings[begin..][..length];
            let lags = (range(loads) >= least).then(|| Lags::of(readings, loads, APART_IN_PART, sign));
            Some((begin, lags??))
        };
        Self { loads, length, all: (0..PARTS).filter_map(|number| part(number * length)).collect() }
    }

    /// Whether most fit another lag than 0.
    pub(super) fn most_differ(&self) -> bool {
        2 * self.all.iter().filter(|(_, lags)| !lags.allow(0)).count() > self.all.len()
    }

    /// About where frames are missing, and how many; of lines of forces the negative number. What is missing shifts all parts
    /// that follow.
    pub(super) fn missing(&self) -> Option<(usize, isize)> {
        let Self { loads, length, all } = self;
        let begins = |lag: isize, other: isize| -> Vec<usize> {
            all.iter().filter(|(_, lags)| lags.allow(lag) && !lags.allow(other)).map(|(begin, _)| *begin).collect()
        };
        let is_end = |begin: usize| {
            let loads: Vec<f64> = loads[begin..][..*length].iter().flatten().copied().collect();
            let [least, most] = [f64::min, f64::max].map(|pick| loads.iter().copied().reduce(pick).unwrap_or(0.0));
            let is_above = |load: f64| load > f64::midpoint(least, most);
            let crossings = loads.windows(2).filter(|pair| is_above(pair[0]) != is_above(pair[1])).count();
            (begin == 0 || begin == (PARTS - 1) * length) && crossings >= CROSSINGS
        };
        let agree = |begins: &[usize]| begins.len() >= AGREE || begins.iter().any(|&begin| is_end(begin));
        let lags: Vec<isize> = all.iter().filter_map(|(_, lags)| lags.best().ok()).collect();
        let mut pairs = lags.iter().flat_map(|&before| lags.iter().map(move |&after| (before, after)));
        pairs.find_map(|(before, after)| {
            let [earlier, later] = [begins(before, after), begins(after, before)];
            let enough = agree(&earlier) && agree(&later) && earlier.len().max(later.len()) >= AGREE;
            let (end, begin) = (earlier.last()? + length, *later.first()?);
            // Lags to either side are those of loads that repeat.
            (enough && before * after >= 0 && end <= begin).then_some((usize::midpoint(end, begin), after - before))
        })
    }
}

/// The share of a variance that a straight line leaves, whose slope may have one sign only.
fn unexplained(correlation: f64, sign: Option<f64>) -> f64 {
    1.0 - sign.map_or(correlation, |sign| (sign * correlation).max(0.0)).powi(2)
}

/// The correlation of the readings with the loads, if these come `lag` frames late.
fn correlate(readings: &[f64], loads: &[Option<f64>], lag: isize) -> f64 {
    let skip = |late: isize| usize::try_from(late).unwrap_or(0);
    let lines = loads.iter().skip(skip(lag));
    let pairs = readings.iter().skip(skip(-lag)).zip(lines).filter_map(|(&reading, load)| Some((reading, (*load)?)));
    correlation(pairs)
}

/// About where one of two logs of other lengths lacks entries: which place explains clearly more than its ends.
pub(super) fn lost(readings: &[f64], loads: &[Option<f64>]) -> Option<usize> {
    let (count, lines) = (readings.len(), loads.len());
    let (both, lost) = (count.min(lines), count.abs_diff(lines));
    let left = |place: usize| {
        let later = |at: usize, is_whole: bool| if at < place || !is_whole { at } else { at + lost };
        let pair = move |at: usize| Some((readings[later(at, count > lines)], loads[later(at, lines > count)]?));
        unexplained(correlation((0..both).filter_map(pair)), None)
    };
    let places = (1..PLACES).map(|place| place * both / PLACES);
    let best = places.min_by(|&a, &b| left(a).total_cmp(&left(b)))?;
    (left(best) <= (1.0 - EXPLAINS).min(CLEARLY * left(both).min(left(0)))).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without noise every period fits up to rounding, on either side of zero.
    #[test]
    fn periodic_loads_without_noise_are_paired_as_they_are() {
        let load = |n: usize| [0.0, 0.1, 0.7, 0.3, 2.3, 1.1, 4.7, 0.9, 0.2, 0.6][n % 10];
        for factor in [0.1, 0.3, 0.7, 1.0, 3.3, 10.0, 17.9] {
            let loads: Vec<_> = (0..100).map(|n| Some(-load(n))).collect();
            let readings: Vec<_> = (0..100).map(|n| 5.0 + factor * load(n)).collect();
            assert_eq!(Lags::of(&readings, &loads, [4.0; 2], None).unwrap().best(), Ok(0), "{factor}");
        }
    }
}
