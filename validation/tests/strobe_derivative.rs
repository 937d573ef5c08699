//! The strobe map's derivative, held against differences in 106 bits: over several periods, for
//! both targets of an impact, and on both sides of the corner at a graze.

use percuss::TwoWord;
use percuss::dynamics::linear::norm;
use percuss::dynamics::strobe::{Jacobian, StrobeMap, StrobePoint};
use percuss::number::Number;
use percuss::variation::{IDENTITY, Matrix, P, Q, Y, product};
use percuss::{Entry, Exit, Instant, Model, Parameters, Phase, Segment};
use percuss_validation::truth::{DoubleDouble, Replay};

/// Half the width of a difference: its square times a third derivative is far below the products'
/// rounding, and its quotient leaves 106 bits fifteen digits. Next to a graze, at a distance of
/// 1e-10, the third derivative is 1e-10^(-3/2).
const STEP: f64 = 1e-15;
/// Allowed error, as a share of the derivative's largest entry: products of matrices in f64 along a
/// run that is itself rounded, 1e-14 at most. A distance d from a graze is known to eps, and the
/// derivative there to eps/sqrt(d): 2e-11 at 1e-10.
const DERIVATIVE_TOLERANCE: f64 = 1e-11;

fn map_of(xi: f64, omega: f64, a: f64, b: f64, g: f64) -> StrobeMap {
    let model = Model::new(Parameters { a, b, xi, omega, g, ..Parameters::default() }).unwrap();
    StrobeMap::new(model, Instant::at(omega, 0.0, 0))
}

/// p, y and q of the run in 106 bits that begins beside `entry`.
fn image(
    parameters: &Parameters,
    entry: &Entry,
    column: usize,
    step: f64,
    end: Instant,
) -> [DoubleDouble; 3] {
    let mut state = entry.point().map(DoubleDouble::exact);
    state[column] = state[column] + DoubleDouble::exact(step);
    let last = Replay::from_two_words(parameters, entry, state, end).last().unwrap().unwrap();
    let [p, y, q, _] = last.at(&end);
    [p, y, q]
}

fn differences(model: &Model, entry: &Entry, end: Instant) -> Jacobian {
    let columns = [0, 1, 2].map(|column| {
        let [plus, minus] =
            [STEP, -STEP].map(|step| image(model.parameters(), entry, column, step, end));
        let width = DoubleDouble::exact(2.0 * STEP);
        [0, 1, 2].map(|row| ((plus[row] - minus[row]) / width).to_f64())
    });
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row]))
}

fn difference(a: &Jacobian, b: &Jacobian) -> Jacobian {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] - b[i][j]))
}

#[test]
fn over_several_periods_for_both_targets_of_an_impact() {
    let maps = [
        map_of(0.01, 1.4, 0.3, 0.1, 0.02),
        map_of(0.1, 1.6, 0.3, 0.1, 0.02),
        map_of(0.3, 0.21, 0.3, 0.1, 0.07),
        map_of(0.05, 0.5, 1.2, 0.2, 0.3),
        map_of(0.5, 0.9, 2.0, 0.6, 0.02),
    ];
    let (mut into_contact, mut into_progression, mut worst) = (0, 0, 0.0_f64);
    for map in maps {
        let rest = map.entry([0.0; 3]).unwrap();
        // In mid-flight, where every direction of the state is free.
        let omega = map.model().parameters().omega;
        let segments = map.model().trajectory(rest).skip(60);
        let flights =
            segments.filter(|segment| segment.phase() == Phase::NoContact).map(|segment| {
                let half = TwoWord::new(0.5 * segment.duration());
                segment.entry_at(&segment.entry().instant.after(half, omega))
            });
        let flights: Vec<_> = flights.take(6).collect();
        for entry in &flights {
            for periods in [1, 2, 4] {
                let passage = map.passage(entry, periods);
                let end = entry.instant.after_periods(periods, 1);
                let found = passage.jacobian();
                let wanted = differences(map.model(), entry, end);
                let apart = norm(&difference(&found, &wanted)) / norm(&found).max(1.0);
                assert!(
                    apart <= DERIVATIVE_TOLERANCE,
                    "{entry:?} {periods}: {apart:e}\n{found:?}\n{wanted:?}"
                );
                worst = worst.max(apart);
                for pair in passage.phases.windows(2) {
                    into_contact += u32::from(pair == [Phase::NoContact, Phase::Contact]);
                    into_progression += u32::from(pair == [Phase::NoContact, Phase::Progression]);
                }
            }
        }
    }
    assert!(into_contact > 50 && into_progression > 20, "{into_contact} {into_progression}");
    println!("{into_contact} into contact, {into_progression} into progression: {worst:.1e}");
}

/// A flight that just touches the slider if it begins at `y`, and one that hits it a little above.
struct GrazingStart {
    model: Model,
    start: Instant,
    p: f64,
    y: f64,
}

impl GrazingStart {
    fn entry(&self, distance: f64) -> Entry {
        let map = StrobeMap::new(self.model, self.start);
        map.entry([self.p, self.y + distance, 0.01]).unwrap()
    }

    fn first(&self, distance: f64) -> Segment {
        self.model.trajectory(self.entry(distance)).next().unwrap()
    }

    /// Finds where the flight's end leaps from its first approach to a later one.
    fn found() -> Self {
        let model = Model::new(Parameters { xi: 0.1, ..Parameters::default() }).unwrap();
        let start = Instant::at(model.parameters().omega, 0.0, 0);
        let mut graze = Self { model, start, p: -0.05, y: 0.0 };
        let (mut low, mut high) = (0.0, 0.19);
        // Until then the force drives the mass away, after its beginning; later approaches are no
        // grazes.
        const DEPARTURE_TIME: f64 = 2.0;
        assert!(
            graze.first(high).duration() < DEPARTURE_TIME
                && graze.first(low).duration() > 1.2 * DEPARTURE_TIME
        );
        while high - low > 2.0 * f64::EPSILON {
            let middle = 0.5 * (low + high);
            // Impacts come later and later down to the graze, and then leap.
            if graze.first(middle).duration() < DEPARTURE_TIME {
                high = middle
            } else {
                low = middle
            }
        }
        graze.y = high;
        graze
    }
}

fn derivative_between(model: &Model, entry: Entry, end: Instant) -> Matrix {
    let mut derivative = IDENTITY;
    for segment in model.trajectory(entry).until(end) {
        let step = match segment.exit() {
            Exit::Switch(_) => {
                product(&segment.saltation(), &segment.variation(segment.duration()))
            }
            _ => segment.variation(segment.elapsed_at(&end)),
        };
        derivative = product(&step, &derivative);
    }
    derivative
}

fn without_growth(matrix: &Matrix) -> Jacobian {
    [P, Y, Q].map(|row| [P, Y, Q].map(|column| matrix[row][column]))
}

#[test]
fn the_map_has_a_corner_at_a_graze_and_no_square_root() {
    let graze = GrazingStart::found();
    let model = graze.model;
    let end = graze.start.after_periods(2, 1);
    let mut last: Option<(f64, f64)> = None;
    for distance in [1e-6, 1e-8, 1e-10] {
        let [touching, missing] = [distance, -distance].map(|distance| {
            let entry = graze.entry(distance);
            let found = without_growth(&derivative_between(&model, entry, end));
            let wanted = differences(&model, &entry, end);
            let apart = norm(&difference(&found, &wanted)) / norm(&found);
            assert!(
                apart <= DERIVATIVE_TOLERANCE,
                "{distance:e}: {apart:e}\n{found:?}\n{wanted:?}"
            );
            found
        });
        // What the saltation of the impact that is only just missed would change.
        let impact = graze.first(distance);
        let at =
            impact.entry().instant.after(TwoWord::new(impact.duration()), model.parameters().omega);
        let flight = graze.first(-distance);
        let before = flight.variation(flight.elapsed_at(&at));
        let after = derivative_between(&model, flight.entry_at(&at), end);
        let mut swallowed = [[0.0; 5]; 5];
        let two_xi = 2.0 * model.parameters().xi;
        for (row, change) in [(Y, -two_xi), (Q, 1.0)] {
            swallowed[row][P] = change;
            swallowed[row][Q] = -change;
        }
        let predicted = without_growth(&product(&after, &product(&swallowed, &before)));
        let jump = difference(&touching, &missing);
        let rest = norm(&difference(&jump, &predicted)) / norm(&predicted);
        assert!(norm(&jump) > 0.1, "{jump:?}");
        let slope = impact.switch_derivative().unwrap().time[P].abs();
        if let Some((rest_before, slope_before)) = last {
            // A hundred times closer: what is left of the contact shrinks tenfold, as the impact's
            // speed does, and the event time's derivative grows as much.
            assert!((7.0..14.0).contains(&(rest_before / rest)), "{rest_before:e} {rest:e}");
            assert!((7.0..14.0).contains(&(slope / slope_before)), "{slope_before:e} {slope:e}");
        }
        println!(
            "{distance:e}: jump {:.3} as predicted to {rest:.1e}, dtau/dp {slope:.1e}",
            norm(&jump)
        );
        last = Some((rest, slope));
    }
    let (rest, slope) = last.unwrap();
    assert!(rest < 1e-3 && slope > 1e3, "{rest:e} {slope:e}");
}

/// One-sided differences of the image itself, in f64: the corner is the map's and not the
/// derivative's.
#[test]
fn one_sided_differences_at_the_graze_are_the_two_derivatives() {
    let graze = GrazingStart::found();
    let end = graze.start.after_periods(2, 1);
    let at = |distance: f64| -> StrobePoint {
        let column = image(graze.model.parameters(), &graze.entry(distance), 1, 0.0, end);
        column.map(DoubleDouble::to_f64)
    };
    for (side, width) in [(1.0, 1e-7), (-1.0, 1e-7)] {
        let (near, far) = (at(side * 1e-9), at(side * width));
        let quotient: StrobePoint =
            std::array::from_fn(|i| (far[i] - near[i]) / (side * (width - 1e-9)));
        let exact =
            without_growth(&derivative_between(&graze.model, graze.entry(side * 0.5 * width), end));
        for (row, quotient) in exact.iter().zip(quotient) {
            // The square root of the width, from what the short contact adds.
            assert!((row[1] - quotient).abs() <= 10.0 * width.sqrt(), "{side}: {row:?} {quotient}");
        }
    }
}
