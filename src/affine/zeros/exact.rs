//! Exactly rational motion: what follows from entries of a state that are known as rationals.
//!
//! A guard whose derivatives end is a polynomial of the time. Where it is a parabola with rational
//! coefficients, its touches, and its crossings at rational times, are known exactly. A guard that
//! is a constant and one oscillation never crosses where the amplitude is at most the constant, and
//! it may cross where the cosine is rational. Without this no number of bits would tell a touch
//! from a crossing, or which of two guards that cross at one instant is the first.

use super::circle::root;
use super::parabola;
use super::touch::Touch;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{Row, row_times};

/// The rows w, w M, w M^2, ... of a guard, as far as they are needed.
#[derive(Clone, Debug)]
pub struct Chain {
    rows: Vec<Row>,
    kind: Kind,
    /// The entries of z that the rows need.
    needed: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// The row after the last is zero: a polynomial of the time.
    Polynomial,
    /// w M^3 = -s w M, with this positive s: a constant and an oscillation.
    Oscillation(Rational),
    Other,
}

/// The future of a guard on a segment, as far as exact arithmetic tells it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fate {
    /// The number of the guard's orders that are zero at the entry, and whether the first of the
    /// others is positive; none if all are zero.
    pub begin: Option<(usize, bool)>,
    /// Whether the sign that the guard has after the entry is the one that it keeps.
    pub keeps_sign: bool,
    /// Where a guard that keeps its sign touches zero, if it does so after the entry.
    pub touch: Option<Touch>,
}

/// An instant after an entry that is known exactly.
#[derive(Clone, Debug, PartialEq)]
pub enum Instant {
    /// A rational time after the entry.
    Time(Rational),
    /// A time t at which cos(w t) and sin(w t)/w are rational, for the square of a frequency w.
    Turn { square: Rational, cos: Rational, sin: Rational },
}

/// Entries of z, of which some are known exactly.
pub type Entries = Vec<Option<Rational>>;

impl Chain {
    /// The chain of a row in a mode's motion.
    pub fn new(row: &Row, matrix: &[Row]) -> Self {
        let is_zero = |row: &Row| row.iter().all(Rational::is_zero);
        let mut rows = vec![row.clone()];
        let kind = loop {
            let next = row_times(&rows[rows.len() - 1], matrix);
            if is_zero(&next) {
                break Kind::Polynomial;
            }
            if let Some(square) = oscillation(&rows, &next) {
                break Kind::Oscillation(square);
            }
            if rows.len() == matrix.len() {
                break Kind::Other;
            }
            rows.push(next);
        };
        let is_needed = |n: &usize| rows.iter().any(|row| !row[*n].is_zero());
        let needed = (0..row.len()).filter(is_needed).collect();
        Self { rows, kind, needed }
    }

    fn is_known(&self, entries: &Entries) -> bool {
        self.needed.iter().all(|n| entries[*n].is_some())
    }

    /// The values of the row and its derivatives, if all entries that they need are known.
    fn values(&self, entries: &Entries) -> Option<Vec<Rational>> {
        if !self.is_known(entries) {
            return None;
        }
        self.rows.iter().map(|row| product(row, entries)).collect()
    }

    /// The row's value, if all entries that it needs are known.
    pub fn value(&self, entries: &Entries) -> Option<Rational> {
        product(&self.rows[0], entries)
    }

    /// The row's value on the whole segment, if it is known that it stands still.
    pub fn constant_value(&self, entries: &Entries) -> Option<Rational> {
        let is_zero = |row: &Row| product(row, entries).is_some_and(|it| it.is_zero());
        let is_still = self.is_known(entries) && self.rows[1..].iter().all(is_zero);
        if is_still { self.value(entries) } else { None }
    }

    /// The order and the sign of the first derivative that is not zero, the value included: none
    /// if an entry is not known, and none inside if all are zero.
    pub fn begin(&self, entries: &Entries) -> Option<Option<(usize, bool)>> {
        let values = self.values(entries)?;
        Some(first_sign(&values))
    }

    /// The guard's future after an entry, if all entries that it needs are known.
    pub fn fate(&self, entries: &Entries) -> Option<Fate> {
        let values = self.values(entries)?;
        let begin = first_sign(&values);
        let (keeps_sign, touch) = match (&self.kind, begin) {
            (_, None) => (true, None),
            (Kind::Polynomial, Some((_, rises))) if values.len() <= 3 => {
                (parabola::keeps_sign(&values, rises), parabola::touch(&values, rises))
            }
            (Kind::Oscillation(square), _) => {
                let own = Oscillation::new(&values, square);
                own.map_or((false, None), |it| (it.keeps_sign(), it.touch()))
            }
            _ => (false, None),
        };
        Some(Fate { begin, keeps_sign, touch: touch.filter(|_| keeps_sign) })
    }

    /// The instant of the guard's zero that is about a time after the entry, which has at most
    /// this error, if it is known exactly.
    pub fn zero_near(&self, entries: &Entries, [time, error]: [f64; 2]) -> Option<Instant> {
        let values = self.values(entries)?;
        match &self.kind {
            Kind::Polynomial => {
                let away = |it: &Rational| (it.to_f64() - time).abs() / time.abs();
                let error = error / time.abs() + 2.0 * f64::EPSILON;
                nearest(parabola::roots(&values), away, error).map(Instant::Time)
            }
            Kind::Oscillation(square) => {
                Oscillation::new(&values, square)?.zero_near([time, error])
            }
            Kind::Other => None,
        }
    }

    /// The row's value at an instant after the entry, where all that it needs is known: of what
    /// stands still no instant is needed.
    pub fn at(&self, entries: &Entries, instant: Option<&Instant>) -> Option<Rational> {
        if let Some(value) = self.constant_value(entries) {
            return Some(value);
        }
        let values = instant.and_then(|_| self.values(entries))?;
        match (&self.kind, instant) {
            (Kind::Polynomial, Some(Instant::Time(time))) => {
                let orders = values.iter().enumerate().rev();
                let step = |sum: Rational, (k, value): (usize, &Rational)| {
                    value + sum * time / Rational::from(k + 1)
                };
                Some(orders.fold(Rational::ZERO, step))
            }
            (Kind::Oscillation(own), Some(Instant::Turn { square, cos, sin })) if own == square => {
                Some(Oscillation::new(&values, own)?.at(cos, sin))
            }
            _ => None,
        }
    }
}

/// The product of a row with the entries, if all that it needs are known.
pub(super) fn product(row: &Row, entries: &Entries) -> Option<Rational> {
    let needed = row.iter().zip(entries).filter(|(factor, _)| !factor.is_zero());
    if needed.clone().any(|(_, entry)| entry.is_none()) {
        return None;
    }
    let mut terms = needed.map(|(factor, entry)| Some(factor * entry.as_ref()?));
    terms.try_fold(Rational::ZERO, |sum, term| Some(sum + term?))
}

/// The square s of a frequency for which the next row is -s times the last but one, which is the
/// second.
fn oscillation(rows: &[Row], next: &Row) -> Option<Rational> {
    let [_, rate, _] = rows else { return None };
    let at = rate.iter().position(|it| !it.is_zero())?;
    let square = -(&next[at] / &rate[at]);
    let is_so = rate.iter().zip(next).all(|(a, b)| a * &square + b == Rational::ZERO);
    (is_so && square > Rational::ZERO).then_some(square)
}

fn first_sign(values: &[Rational]) -> Option<(usize, bool)> {
    let first = values.iter().position(|it| !it.is_zero())?;
    Some((first, values[first] > Rational::ZERO))
}

/// The exact zero of which a rounded one is known, by how far each is away, which has at most this
/// error: the next one is much farther.
fn nearest<Z: PartialEq>(mut zeros: Vec<Z>, away: impl Fn(&Z) -> f64, error: f64) -> Option<Z> {
    /// The largest distance of a zero found in f64, whose rounding is smaller.
    const ZERO_TOLERANCE: f64 = 1e-9;
    /// The least distance of the next zero, in distances of this one and its error.
    const MIN_ISOLATION_RATIO: f64 = 1e3;
    zeros.dedup();
    zeros.sort_by(|a, b| away(a).total_cmp(&away(b)));
    let distance = away(zeros.first()?);
    let is_alone =
        zeros.get(1).is_none_or(|it| away(it) > MIN_ISOLATION_RATIO * (distance + error));
    (distance < ZERO_TOLERANCE && is_alone).then(|| zeros.swap_remove(0))
}

/// A constant and an oscillation: c + a cos(w t) + b sin(w t)/w.
struct Oscillation<'a> {
    square: &'a Rational,
    constant: Rational,
    cos: Rational,
    sin: &'a Rational,
    /// The square of the amplitude, a^2 + b^2/w^2.
    amplitude: Rational,
}

impl<'a> Oscillation<'a> {
    /// The oscillation with these derivatives, by the square of its frequency.
    fn new(values: &'a [Rational], square: &'a Rational) -> Option<Self> {
        let [value, sin, bend] = values else { return None };
        let cos = -(bend / square);
        let amplitude = &cos * &cos + sin * sin / square;
        Some(Self { square, constant: value - &cos, cos, sin, amplitude })
    }

    /// Whether the constant outweighs the oscillation, which may touch zero.
    fn keeps_sign(&self) -> bool {
        !self.constant.is_zero() && self.amplitude <= &self.constant * &self.constant
    }

    /// The touches of zero, where the amplitude is the constant.
    fn touch(&self) -> Option<Touch> {
        let Self { square, constant, cos, sin, amplitude } = self;
        if constant.is_zero() || *amplitude != constant * constant {
            return None;
        }
        let frequency = square.to_f64().sqrt();
        // The oscillation has its top at this angle, and its bottom half a turn from it.
        let top = libm::atan2(sin.to_f64() / frequency, cos.to_f64());
        let is_above = *constant > Rational::ZERO;
        let angle = if is_above { top + std::f64::consts::PI } else { top };
        let is_at_origin = (constant + cos).is_zero();
        Some(Touch::of_angle(angle, frequency, is_at_origin))
    }

    fn at(&self, cos: &Rational, sin: &Rational) -> Rational {
        &self.constant + &self.cos * cos + self.sin * sin
    }

    /// The zero that is about a time, if cosine and sine over the frequency are rational there.
    fn zero_near(&self, [time, error]: [f64; 2]) -> Option<Instant> {
        let Self { square, constant, cos, sin, amplitude } = self;
        if amplitude.is_zero() {
            return None;
        }
        let root = root(&((amplitude - constant * constant) / *square))?;
        let frequency = square.to_f64().sqrt();
        let (sin_now, cos_now) = libm::sincos(frequency * time);
        // Of the angle; sine and cosine follow it.
        let error = 2.0 * frequency * (error + 2.0 * f64::EPSILON * time.abs()) + f64::EPSILON;
        let zero = |root: &Rational| {
            let own = [-cos * constant - *sin * root, -*sin * constant / *square + cos * root];
            own.map(|it| it / amplitude)
        };
        let away = |[cos, sin]: &[Rational; 2]| {
            let sin = frequency * sin.to_f64() - sin_now;
            (cos.to_f64() - cos_now).abs() + sin.abs()
        };
        let [cos, sin] = nearest(vec![zero(&root), zero(&-&root)], away, error)?;
        Some(Instant::Turn { square: (*square).clone(), cos, sin })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    fn rows(entries: &[&[i32]]) -> Vec<Row> {
        entries.iter().map(|row| row.iter().map(|it| Rational::from(*it)).collect()).collect()
    }

    fn known(entries: &[i32]) -> Entries {
        entries.iter().map(|it| Some(Rational::from(*it))).collect()
    }

    /// x' = v, v' = -8 from x = 0 at v = 2: the crest is 1/4, at 1/4.
    #[test]
    fn a_throw_touches_its_crest_and_crosses_below_it() {
        let matrix = rows(&[&[0, 1, 0], &[0, 0, -8], &[0, 0, 0]]);
        let level = |above: i32, parts: i32| {
            vec![Rational::ONE, Rational::ZERO, -Rational::from(above) / Rational::from(parts)]
        };
        let start = known(&[0, 2, 1]);
        let fate = |level| Chain::new(&level, &matrix).fate(&start).unwrap();
        assert!(fate(level(1, 4)).keeps_sign);
        assert!(fate(level(1, 3)).keeps_sign);
        let touches = [level(1, 4), level(1, 3)].map(|it| fate(it).touch);
        assert_eq!(touches, [Some(Touch::Once(0.25)), None]);
        assert!(!fate(level(3, 16)).keeps_sign && !fate(level(1, 8)).keeps_sign);
        assert_eq!(fate(level(0, 1)).begin, Some((1, true)));
        let zero = |level, time| Chain::new(&level, &matrix).zero_near(&start, [time, 0.0]);
        let eighth = |n: i32| Some(Instant::Time(Rational::from(n) / Rational::from(8)));
        assert_eq!(zero(level(3, 16), 0.125), eighth(1));
        assert_eq!(zero(level(3, 16), 0.375), eighth(3));
        assert_eq!(zero(level(3, 16), 0.25), None);
        assert_eq!(zero(level(1, 8), 0.25 - 0.125_f64.sqrt() / 2.0), None);
        // A time of too large an error tells no zero from another.
        let eighth_of =
            |error| Chain::new(&level(3, 16), &matrix).zero_near(&start, [0.125, error]);
        assert_eq!([eighth_of(1e-6), eighth_of(1e-3)], [eighth(1), None]);
    }

    /// x'' = -4 x from x = 3, v = 8: the amplitude is 5.
    #[test]
    fn an_oscillation_touches_its_amplitude() {
        let matrix = rows(&[&[0, 1, 0], &[-4, 0, 0], &[0, 0, 0]]);
        let start = known(&[3, 8, 1]);
        let fate = |level: i32| {
            let guard = vec![Rational::ONE, Rational::ZERO, -Rational::from(level)];
            Chain::new(&guard, &matrix).fate(&start).unwrap()
        };
        assert!(fate(5).keeps_sign && fate(6).keeps_sign && fate(-5).keeps_sign);
        assert!(!fate(4).keeps_sign);
        // tan(2 t) = 4/3 at the top, and the bottom is half a period from it.
        let top = 0.5 * libm::asin(0.8);
        let touches = |level: i32, time: f64| {
            let lies_in = |span| fate(level).touch.is_some_and(|it| it.may_lie_in(span));
            lies_in([time - 1e-6, time + 1e-6]) && !lies_in([time + 1e-6, time + 1.0])
        };
        let half = 0.5 * std::f64::consts::PI;
        assert!(touches(5, top) && touches(5, top + 2.0 * half) && !touches(5, top + half));
        assert!(touches(-5, top + half) && !touches(-5, top));
        assert_eq!([4, 6].map(|it| fate(it).touch), [None, None]);
    }

    /// x'' = -4 x from x = 5 at rest: at x = 3 the rate is -8, and at no rational time.
    #[test]
    fn two_guards_of_an_oscillation_meet_at_a_rational_cosine() {
        let matrix = rows(&[&[0, 1, 0], &[-4, 0, 0], &[0, 0, 0]]);
        let start = known(&[5, 0, 1]);
        let chain = |row: [i32; 3]| Chain::new(&row.map(Rational::from).to_vec(), &matrix);
        let instant = chain([1, 0, -3]).zero_near(&start, [0.5 * 0.6_f64.acos(), 0.0]).unwrap();
        let fifth = |n: i32| Rational::from(n) / Rational::from(5);
        let (square, cos) = (Rational::from(4), fifth(3));
        assert_eq!(instant, Instant::Turn { square, cos, sin: fifth(2) });
        assert_eq!(chain([0, 1, 8]).at(&start, Some(&instant)), Some(Rational::ZERO));
        assert_eq!(chain([0, 1, 7]).at(&start, Some(&instant)), Some(-Rational::ONE));
    }

    #[test]
    fn what_is_not_known_tells_nothing() {
        let matrix = rows(&[&[0, 1, 0], &[0, 0, -8], &[0, 0, 0]]);
        let guard = vec![Rational::ONE, Rational::ZERO, Rational::ZERO];
        let start = vec![Some(Rational::ZERO), None, Some(Rational::ONE)];
        assert!(Chain::new(&guard, &matrix).fate(&start).is_none());
    }
}
