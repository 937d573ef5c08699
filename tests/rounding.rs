//! The results of the proofs in interval arithmetic (docs/ROUNDING.md).

use percuss::insides::Motion;
use percuss::{Model, Parameters, Start};

fn start(p: f64, y: f64, q: f64, tau: f64) -> Start {
    Start { tau, p, y, q: Some(q), ..Start::default() }
}

/// Flights whose gap misses the surface by 0.2 to 0.6 of what rounding may hide, by intervals.
/// Newton's method settled there, and a contact was reported which was not counted as undecidable.
#[test]
fn a_touch_within_rounding_is_counted_and_no_switch() {
    let cases = [
        (
            [7.059_680_266_152_331, 0.592_328_180_043_569_1, 70.690_198_446_110_43],
            [0.063_422_019_404_274_58, 0.196_571_138_219_162_1, 2.191_040_024_123_206],
            start(
                0.784_893_508_006_637_8,
                0.472_532_739_555_344_36,
                0.607_211_004_333_963_4,
                9.308_736_910_893_94,
            ),
            0.079_198_966,
        ),
        (
            [5.152_546_994_048_355, 0.689_104_010_437_978_4, 1.972_466_193_286_157],
            [0.010_052_937_873_380_687, 0.183_648_843_280_510_93, 2.349_088_288_389_932],
            start(
                0.891_214_522_909_011_9,
                0.115_535_295_325_155_55,
                0.720_974_650_688_755_8,
                9.778_264_155_034_41,
            ),
            0.089_895_292,
        ),
        (
            [0.387_456_304_180_038_96, 0.086_749_705_803_279_63, 2.864_521_292_271_604],
            [0.143_981_142_497_012_33, 0.182_771_328_994_312_1, 1.518_492_508_922_860_7],
            start(
                1.095_941_549_249_879_6,
                -0.036_502_085_298_865_24,
                0.952_063_333_641_876_2,
                5.645_072_434_933_017,
            ),
            0.590_838_601,
        ),
    ];
    for ([a, b, xi], [omega, g, phi], start, touch) in cases {
        let model = Model::new(Parameters { a, b, xi, omega, g, phi }).unwrap();
        let mut run = model.trajectory(model.start(&start).unwrap());
        let flight = run.next().unwrap();
        let counted = run.counters().undecidable;
        assert!(flight.duration() > 1.1 * touch && counted > 0, "{} {counted}", flight.duration());
    }
}

/// The closed form of a progression goes by its drift velocity at first and by y later. After an
/// impact the one was taken from f, whose rounding 1/(2 xi) multiplies: the guard jumped by
/// hundreds of its rounding rooms.
#[test]
fn a_slip_after_an_impact_begins_with_the_drift_velocity_of_its_state() {
    let parameters = Parameters {
        a: 4.411_738_647_313_63,
        b: 0.047_924_801_412_974_366,
        xi: 0.000_618_647_492_285_334_3,
        omega: 5.069_729_454_494_511_8,
        g: 0.007_966_084_826_652_496,
        phi: 5.672_606_981_378_466_5,
    };
    let start = start(
        1.007_911_793_518_706_7,
        0.058_841_390_057_488_13,
        0.999_965_585_331_411_4,
        7.997_921_304_284_754,
    );
    let model = Model::new(parameters).unwrap();
    let slip = model.trajectory(model.start(&start).unwrap()).nth(1).unwrap();
    let Motion::Progression(slip) = slip.motion() else { panic!("{:?}", slip.phase()) };
    let parted = slip.drift_rate - (slip.entry.y - slip.closing);
    // A rounding of the difference.
    assert!(parted.abs() <= f64::EPSILON * slip.entry.y, "{parted:e}");
}
