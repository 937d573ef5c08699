//! Inputs that the fuzz target `solver` found to hang, to cost far too much or to lose digits.

#![allow(clippy::approx_constant, reason = "a fuzzer draws such numbers, digit by digit")]

use percuss::{Exit, Model, Parameters, Phase, Segment, Start};
use std::f64::consts::FRAC_PI_2;

const ROUNDING_TOLERANCE: f64 = 64.0 * f64::EPSILON;

fn case(
    [a, b, xi, omega, g, phi]: [f64; 6],
    [tau, p, y, q]: [f64; 4],
    phase: Option<Phase>,
) -> (Parameters, Start) {
    let parameters = Parameters { a, b, xi, omega, g, phi };
    (parameters, Start { tau, p, y, q: Some(q), phase, ..Start::default() })
}

/// The phases of the first 20 segments within `horizon`, none of which may take 3000 evaluations.
fn segments((parameters, start): (Parameters, Start), horizon: f64) -> Vec<Segment> {
    let model = Model::new(parameters).expect("the parameters are in range");
    let entry = model.start(&start).expect("the start is in range");
    let periods = horizon / model.period();
    let end = entry.instant.after_periods((periods * 1e6) as u64, 1_000_000);
    let mut trajectory = model.trajectory(entry).until(end);
    let segments: Vec<Segment> = trajectory.by_ref().take(20).collect();
    assert!(trajectory.counters().evaluations < 3000, "{:?}", trajectory.counters());
    for segment in &segments {
        if let Exit::Switch(next) = segment.exit() {
            assert_ne!(segment.phase(), next.phase(), "a phase follows itself");
        }
    }
    segments
}

/// The trial force of a contact stays in [0, 1], from its samples.
fn force_stays(segments: &[Segment], xi: f64, horizon: f64) {
    for segment in segments.iter().filter(|segment| segment.phase() == Phase::Contact) {
        for eighth in 0..=8 {
            let state = segment.at(segment.duration().min(horizon) * f64::from(eighth) / 8.0).state;
            let (damper, spring) = (2.0 * xi * state.y, state.q);
            let room = ROUNDING_TOLERANCE
                * (1.0 + damper.abs() + spring.abs() + segment.entry().state.q.abs());
            let force = damper + spring;
            assert!((-room..=1.0 + room).contains(&force), "f = {force:e}, room {room:e}");
        }
    }
}

/// A contact stated at f = 0 although f falls there: the derivatives decide.
#[test]
fn a_phase_stated_against_the_derivatives() {
    let parameters =
        [1.905_023_314_967_989_8, 0.0, 5.245_737_834_662_222, 1e6, 0.578_591_170_389_808_6, 3.1];
    let q = -0.063_181_667_137_700_51;
    let start = [2.624_159_050_362_819_4, 0.515_409_503_252_108, 0.006_022_190_693_577_507, q];
    for phase in [Phase::Contact, Phase::NoContact] {
        segments(case(parameters, start, Some(phase)), 2.4e-7);
    }
}

/// A flight of 2e-317: its guard underflows long before its slope does.
#[test]
fn a_flight_that_underflows() {
    let b = 1.872_442_957_227_988_4e-241;
    let parameters = [1e9, b, 1.000_000_481_959_808, 1e-6, 0.853_496_877_675_293_3, 0.0];
    let y = -1.112_536_393_055_774e-308;
    let start = [2.787_131_936_795_641, 0.853_496_877_675_293_3, y, -0.0];
    segments(case(parameters, start, None), 194.778_744_522_567_2);
}

/// The only way out is far on the other side of the corridor from the threshold just left.
#[test]
fn a_contact_that_starts_next_to_the_other_threshold() {
    let parameters = [
        787_365_217.770_228,
        -1.000_000_000_000_000_2,
        2.904_886_314_599_258_5,
        0.203_518_235_640_238_47,
        0.001_193_737_162_390_641_4,
        -1.570_796_326_794_896_6,
    ];
    let (p, q) = (-0.598_800_422_746_573_2, -0.599_994_159_908_963_9);
    segments(case(parameters, [0.0, p, 0.103_273_260_085_867_33, q], None), 0.0787);
}

/// Free oscillation of 2e7 against a forced one of the same size: the guesses must not point at
/// the place where they are made.
#[test]
fn guesses_in_strong_resonance() {
    let parameters = [1.851_695_129_613_321, 1.0, 4.4e-8, 1.000_000_000_000_000_9, 0.0, -1.57];
    let start = [3.141_592_653_589_793, 1.1e-14, 6.086e-7, 1.1e-14];
    segments(case(parameters, start, None), 12.0);
}

/// Contact decays to rest so slowly and so near to a threshold that only relative bounds decide.
#[test]
fn an_overdamped_contact_near_its_threshold() {
    let parameters = [2.5e-84, 2.2e-308, 701.837_137_566_102_8, 1.0, 1.464_010_283_691_811, 3.14];
    let start = [2.232_737, 1.464_010_283_691_811, 2.2e-308, -0.0];
    segments(case(parameters, start, None), 8.0);
    let parameters = [0.0, 2.2e-308, 1.319_139_296_656_565_2, 0.0167, 0.5, 0.0];
    let start = [1.57, -0.5, 0.379_035_027_814_782_77, -1.0];
    segments(case(parameters, start, None), 200.0);
}

/// a = 1e9: a contact takes 1e-7 to 1e-4, in which the response to the force is d^2/2 of it.
#[test]
fn short_contacts_under_a_large_force_keep_their_digits() {
    for (xi, omega, phi) in [
        (1e-8, 1.292_598_608_755_899_2, 1.3),
        (0.002_463_5, 0.999_999_999_999_995_3, 0.7),
        (1e4, 1e-6, 0.5),
        (0.0556, 1.0, -0.5),
    ] {
        for q in [0.003, 0.5, 0.999] {
            let start = [0.0, q, 0.0, q];
            let run = segments(case([1e9, 0.5, xi, omega, 0.0, phi], start, None), 1e-3);
            force_stays(&run, xi, 1e-3);
        }
    }
}

/// q falls from 1e9 to 1 within a progression and stays above it: late it is 1, not 1 + eps 1e9.
#[test]
fn a_progression_forgets_a_large_start() {
    let xi = 1e-8;
    let b = -809_901.721_459_904_9;
    let phi = 6.164_659_551_244_219;
    let parameters = [4.884_387_047_523_054e-5, b, xi, 4.898_253_260_902_872, 0.0, phi];
    let start = [1.570_796_326_794_896_6, 1e9, 0.667_097_934_211_394_3, 1e9];
    let run = segments(case(parameters, start, None), 1.9);
    let slip = &run[0];
    assert_eq!(slip.phase(), Phase::Progression);
    let mut last = f64::INFINITY;
    for eighth in 0..=8 {
        let q = slip.at(slip.duration() * f64::from(eighth) / 8.0).state.q;
        assert!((1.0..=last).contains(&q), "q = {q:e} after {last:e}");
        last = q;
    }
}

/// Separation with three zeros at p = 1e9: the envelopes must not be made from p - g.
#[test]
fn a_slow_separation_far_out() {
    let parameters = [1.0, -1.0, 1e-8, 0.999_999_704_107_353_1, 1e9, 0.0];
    segments(case(parameters, [0.0, 1e9, 0.0, 0.0], Some(Phase::NoContact)), 0.0063);
}

/// at rest on a threshold the derivatives of f, from f' = 2 xi (F - f) + y and so on, are
/// rounding noise times powers of 2 xi, and no piece longer than 1/(2 xi) is certified.
#[test]
fn strong_damping_at_rest_on_a_threshold() {
    let parameters = [0.0, 1.0, 1e4, 1.000_000_000_000_002_7, 1.000_000_000_000_000_2, 0.0];
    let start =
        [0.0, 2.000_000_000_000_000_4, -1.110_223_024_625_156_6e-20, 1.000_000_000_000_000_2];
    segments(case(parameters, start, None), 200.0);
}

/// F = a cos(pi) + b is zero but for the rounding of pi; what the derivatives decide is not
/// what the guard does next.
#[test]
fn a_force_that_is_zero_to_rounding() {
    let parameters = [1.0, 1.0, 0.999_999_999_999_996_9, 1.0, 0.0, -3.536_210_690_048_745_7e-12];
    segments(case(parameters, [3.141_592_653_589_793, 0.0, 0.0, 0.0], None), 0.0063);
}

/// Strong damping: the derivatives of f were rounding noise long after the fast part had died out,
/// so that near a threshold no piece was certified.
#[test]
fn strong_damping_next_to_a_threshold() {
    let parameters =
        [8.686e-171, -4.431e-202, 1e4, 0.000_506_368_118_112_349_7, 0.084_564_703_784_519_01, 2.26];
    let start =
        [0.0, -0.915_608_454_065_904_6, 0.188_017_110_384_073_37, -1.731_578_503_742_369e-4];
    segments(case(parameters, start, None), 200.0);
}

/// What q was at the start drowned the guard long after it had died out: g was taken off last, or
/// the piece's other end gave the rounding room.
#[test]
fn a_slider_that_returns_from_far() {
    let parameters = [0.5, 4.696_163_814_168_331e-5, 1e-8, 1e-6, 0.5, -1.570_796_326_794_896_6];
    let run = segments(case(parameters, [0.0, 0.5, 0.0, 1.0], None), 200.0);
    // q = b d^2/2 after 37 decay times: 1.5e-17.
    let state = run[0].at(run[0].duration()).state;
    assert!((7e-7..8e-7).contains(&run[0].duration()), "{:e}", run[0].duration());
    assert!((1e-18..1e-16).contains(&state.q), "{state:?}");

    let g = 0.001_547_336_113_068_120_7;
    let start = [0.0, 0.001_547_336_578_369_140_6, -5.777_937_187_090_381_5e-6, 1e9];
    let run = segments(case([0.0, 0.0, 1e-8, 1e6, g, 0.0], start, None), 1e-3);
    let force = 2e-8 * start[2] + run[0].at(run[0].duration()).state.q;
    assert!(force > 0.0, "the impact before the graze: {:?}", run[0]);
}

/// The drift velocity of a slider pushed in by 1e9 lost the digits of y.
#[test]
fn a_progression_that_begins_at_1e15() {
    let xi = 1.074_929_975_991_823_3e-7;
    let parameters = [0.0, -1.999_999_960_884_451_9, xi, 305.825_457_991_631_9, 0.0, 0.0];
    let y = 0.464_246_323_440_281_27;
    let run = segments(case(parameters, [0.0, 999_999_999.0, y, 1e9], None), 1.0);
    let slip = run.iter().find(|segment| segment.phase() == Phase::Progression).expect("it slips");
    // y' = b - 1 and 1 - q has died out: w = y.
    let expected = y / 2.999_999_960_884_451_9;
    assert!((slip.duration() - expected).abs() < 1e-14, "{}", slip.duration() - expected);
}

/// A root at 1e-102 in a bracket from zero: its exponent is halved, not its value.
#[test]
fn a_root_smaller_by_orders_of_magnitude() {
    let parameters = [1e9, 0.888_841_689_305_575_9, 1.0, 0.999_999_942_969_940_4, 0.125, -7.89e-8];
    let start = [1.570_796_326_794_896_6, 0.125, 0.0, -1.112e-100];
    let (parameters, start) = case(parameters, start, None);
    let model = Model::new(parameters).expect("in range");
    let entry = model.start(&start).expect("in range");
    let mut trajectory = model.trajectory(entry).until(entry.instant.after_periods(1, 100));
    let segment = trajectory.next().expect("a first phase");
    // h = f d/(2 xi) + F d^2/2
    let force = 1e9 * (0.999_999_942_969_940_4 * start.tau + parameters.phi).cos() + parameters.b;
    let expected = 1.112e-100 / force;
    assert!((segment.duration() / expected - 1.0).abs() < 1e-6, "{:e}", segment.duration());
    assert!(trajectory.counters().evaluations < 200, "{:?}", trajectory.counters());
}

/// The envelope of a slow, large forcing stays open by its rounding for a while: it advised to go
/// on by less and less.
#[test]
fn an_envelope_that_rounding_keeps_open() {
    let omega = 1.000_108_697_328_897_7e-6;
    let parameters = [0.343_672_121_955_005_46, -1.0, 1e-8, omega, 0.0, std::f64::consts::PI];
    let start = [0.0, 0.0, -5.002_662_570_924_352_5e-11, 0.0];
    let run = segments(case(parameters, start, None), 200.0);
    assert!(matches!(run[0].exit(), Exit::Endless(_)), "{:?}", run[0]);
}

/// p0 = q0 + g beside g = 1e9 has lost q0, of which a bound of the gap's envelope was made: it
/// proved the flight to be clear until after its end.
#[test]
fn a_flight_far_up_returns_before_the_horizon() {
    let parameters = [
        1.0,
        2.346_301_138_990_674e-6,
        2_853.950_301_969_395,
        29_494.100_226_629_93,
        1e9,
        -14.922_917_012_182_877,
    ];
    let (parameters, start) = case(parameters, [0.0, 1e9, 0.0, 0.0], None);
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let free: Vec<Segment> = model.trajectory(entry).take(6).collect();
    assert!(free.iter().filter(|segment| segment.phase() == Phase::NoContact).count() >= 2);
    // Every flight ends where it does without a horizon.
    for periods in 1..=12 {
        let horizon = entry.instant.after_periods(periods, 1);
        let cut = model.trajectory(entry).until(horizon).take(6);
        for (segment, whole) in
            cut.zip(&free).filter(|(segment, _)| matches!(segment.exit(), Exit::Switch(_)))
        {
            assert_eq!(segment.duration().to_bits(), whole.duration().to_bits(), "{periods}");
        }
        let ends = |segment: &&Segment| matches!(segment.exit(), Exit::Switch(next) if next.instant <= horizon);
        let expected = free.iter().take_while(ends).count();
        let found = model.trajectory(entry).until(horizon).take(6);
        let switches = found.filter(|segment| matches!(segment.exit(), Exit::Switch(_))).count();
        assert_eq!(switches, expected, "{periods}");
    }
}

/// The squares of its derivatives underflow, so that the bound of the eighth was zero and proved a
/// crossing away. The model is the one with forces 1e200 times larger, as long as both are far from
/// 1.
#[test]
fn a_contact_whose_squares_underflow() {
    let durations = [-276, -76].map(|exponent: i32| {
        let unit = 10.0_f64.powi(exponent);
        let (a, b) = (2.100_865_526_582_815_6 * unit, -0.877_014_839_738_917_9 * unit);
        let parameters = [a, b, 1e-8, 0.001_032_237_949_543_611_8, 0.0, 0.0];
        segments(case(parameters, [0.0; 4], None), 30.0)[0].duration()
    });
    let [tiny, small] = durations;
    assert!((tiny - small).abs() <= ROUNDING_TOLERANCE * small, "{tiny} {small}");
    assert!((small - 6.274_706_586_767_35).abs() < 1e-9, "{small}");
}

/// Just after its imposed zero the guard underflows to zero, which counted as a crossing.
#[test]
fn a_guard_that_underflows_next_to_its_imposed_zero() {
    let parameters = [
        8.305_269_339_752_404e-279,
        -9.686_670_527_496_58e-280,
        0.000_391_144_498_038_023_54,
        1e6,
        0.0,
        5.817_167_878_477_489,
    ];
    let segments = segments(case(parameters, [0.0; 4], None), 1e-3);
    // The force pushes for most of the first period.
    let period = std::f64::consts::TAU / 1e6;
    assert_eq!(segments[0].phase(), Phase::Contact);
    assert!(segments[0].duration() > 0.2 * period, "{:e}", segments[0].duration());
}

/// Newton's method crept through a bracket of 1e30 radians: 12,640 evaluations.
#[test]
fn a_bracket_with_many_oscillations() {
    let parameters = [
        1e9,
        -1.022_693_731_793_508_5e-52,
        3.316_876_626_330_518_7,
        1.0,
        4.293_820_966_316_33,
        -1.190_442_054_700_874_6e-5,
    ];
    let at = [-FRAC_PI_2, 2.326_226_989_369_825_3, 0.0, -0.027_847_814_572_060_016];
    let (parameters, start) = case(parameters, at, None);
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    // Next to a horizon a switch is looked for without it as well.
    let horizon = entry.instant.after_periods(1765, 1_000_000);
    let mut run = model.trajectory(entry).until(horizon);
    assert!(run.next().is_some());
    assert!(run.counters().evaluations < 100, "{:?}", run.counters());
}

/// A harmonic force of 1e-64 beside a static one of 1 was read off their sum. The root is from the
/// closed form in 60 digits.
#[test]
fn a_small_harmonic_force_on_a_threshold() {
    let parameters = [2.552_365_740_751_081_6e-64, 1.0, 1.0, 0.177_372_697_593_197_1, 0.02, 0.0];
    let (tau, y) =
        (1.567_510_069_900_758_7 / 0.177_372_697_593_197_1, -4.970_896_296_344_797_5e-65);
    let segments = segments(case(parameters, [tau, 1.02, y, 1.0], Some(Phase::Contact)), 40.0);
    let lasts = segments[0].duration();
    // tau is rounded, and the root moves with it: d(lasts) = -d(tau).
    let model = Model::new(Parameters { omega: 0.177_372_697_593_197_1, ..Parameters::default() });
    let angle = segments[0].entry().instant.angle();
    let moved = (angle - 1.567_510_069_900_758_7) / model.unwrap().parameters().omega;
    let expected = 17.787_837_386_337_64 - moved;
    assert!((lasts - expected).abs() <= ROUNDING_TOLERANCE * expected, "{lasts:?} {expected:?}");
}

/// Its gap closes after 4.5e-16, which a bound of the gap's envelope denied: it had been added up
/// from parts of 24, whose rounding nothing allowed for.
#[test]
fn a_hop_under_a_far_slider() {
    let phi = -132_601_311_228_378.03;
    let parameters = [1.000_000_000_000_000_2, 0.0, 1e4, 1e6, 0.0, phi];
    let (q, y) = (-24.313_010_378_579_69, 0.001_215_650_518_928_977_2);
    let (parameters, start) = case(parameters, [3.311_970_349_310_081_4, q, y, q], None);
    let start = Start { cycle: 1 << 53, ..start };
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let first = |segment: Option<Segment>| segment.unwrap().duration();
    let free = first(model.trajectory(entry).next());
    for parts in [1, 10, 1000] {
        let horizon = entry.instant.after_periods(parts, 1000);
        let cut = first(model.trajectory(entry).until(horizon).next());
        assert_eq!(cut.to_bits(), free.to_bits(), "{parts}");
    }
    assert!(free < 1e-8, "{free:e}");
}

/// Value times bend underflows, so that the gap was proved never to close.
#[test]
fn a_gap_that_closes_by_forces_whose_products_underflow() {
    let (b, g) = (3.328_260_325_600_571_7e-139, 1.592_901_072_926_197e-228);
    let parameters = [0.0, b, 5.563_688_936_356_673, 8.117_229_193_932_584e-6, g, 0.0];
    let at = [0.0, -2.225_073_858_507_201_4e-308, 0.0, 0.0];
    let segments = segments(case(parameters, at, None), 1.0);
    let expected = (2.0 * g / b).sqrt();
    assert_eq!(segments[0].phase(), Phase::NoContact);
    assert!(
        (segments[0].duration() - expected).abs() <= ROUNDING_TOLERANCE * expected,
        "{segments:?}"
    );
}

/// A progression next to b = 1 stops at once. Its mean velocity is zero, and pieces of a period's
/// length hid the stop in what their parts rounded.
#[test]
fn a_short_slip_under_a_force_of_one() {
    let parameters = [
        3.392_152_322_883_994e-14,
        1.0,
        9.861_280_855_546_347e-7,
        2.273_764_538_792_842e-6,
        1.839_281_023_908_239,
        4.695_069_182_735_851,
    ];
    let start = [0.0, 3.597_171_320_951_778, 0.0, 1.757_890_297_043_577_5];
    let (parameters, start) = case(parameters, start, None);
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let slip = model.trajectory(entry).nth(3).unwrap();
    assert_eq!(slip.phase(), Phase::Progression);
    assert!((slip.duration() - 0.040_489_540_977).abs() < 1e-9, "{slip:?}");
}

/// Over one forcing period its terms grow to 1e21, whose rounding hid that the gap closes after
/// 2.8.
#[test]
fn a_gap_that_closes_before_its_terms_grow() {
    let g = 1.733_552_996_007_155_8;
    let parameters = [1e9, -1e9, 1e-8, 1e-6, g, -4.655_148_308_255_369_4e-6];
    let start = [3.141_592_653_589_793, 0.0, 0.627_829_466_626_939_7, 0.0];
    let (parameters, start) = case(parameters, start, None);
    let model = Model::new(parameters).unwrap();
    let segment = model.trajectory(model.start(&start).unwrap()).next().unwrap();
    assert!(matches!(segment.exit(), Exit::Switch(_)), "{segment:?}");
    assert!((segment.at(segment.duration()).state.p - g).abs() < 1e-6, "{segment:?}");
    assert!((2.7..2.8).contains(&segment.duration()), "{segment:?}");
}
