use super::*;
use proptest::prelude::*;

type Small = Wide<4, 212>;
type Large = Wide<14, 848>;

fn f64s() -> impl Strategy<Value = f64> {
    let size = prop_oneof![Just(1.0), Just(1e-9), Just(1e30), Just(1e-200)];
    (size, -2.0..2.0_f64).prop_map(|(size, it)| size * it)
}

/// A number with all of its words in use.
fn number() -> impl Strategy<Value = Small> {
    (f64s(), f64s()).prop_filter_map("a divisor", |(a, b)| {
        (b != 0.0).then(|| Small::exact(a) / Small::exact(b) + Small::exact(a))
    })
}

/// Whether two numbers agree to the bits that the arithmetic declares, relative to a size.
fn agree<const W: usize, const B: usize>(a: Wide<W, B>, b: Wide<W, B>, size: Wide<W, B>) -> bool {
    (a - b).bound().abs() <= size.bound().abs() * Wide::<W, B>::unit()
}

proptest! {
    #[test]
    fn f64s_come_back(a in f64s()) {
        prop_assert_eq!(Small::exact(a).to_f64(), a);
        prop_assert_eq!(Large::exact(a).to_f64(), a);
    }

    /// Sums and products of f64s are exact in 212 bits where the exponents are near, and those of
    /// f64 are their roundings.
    #[test]
    fn sums_and_products_round_to_those_of_f64(a in -2.0..2.0_f64, b in -2.0..2.0_f64) {
        let (x, y) = (Small::exact(a), Small::exact(b));
        prop_assert_eq!((x + y).to_f64(), a + b);
        prop_assert_eq!((x - y).to_f64(), a - b);
        prop_assert_eq!((x * y).to_f64(), a * b);
        prop_assert_eq!((x + y) - y, x);
        prop_assert_eq!(x < y, a < b);
    }

    #[test]
    fn quotients_and_roots_are_inverse(a in number(), b in number()) {
        prop_assume!(b != Small::zero());
        prop_assert!(agree(a / b * b, a, a));
        let root = a.abs().sqrt();
        prop_assert!(agree(root * root, a.abs(), a));
    }

    #[test]
    fn products_are_distributive(a in number(), b in number(), c in number()) {
        let size = (a * b).abs() + (a * c).abs();
        prop_assert!(agree(a * (b + c), a * b + a * c, size));
        prop_assert!(agree((a * b) * c, a * (b * c), a * b * c));
    }

    /// exp(x + y) = exp(x) exp(y) in 212 bits, and exp(x) agrees with that of f64 and that in 848
    /// bits.
    #[test]
    fn the_exponential_turns_sums_into_products(a in -700.0..700.0_f64, b in -1.0..1.0_f64) {
        let (x, y) = (Small::exact(a), Small::exact(b));
        let product = x.exp() * y.exp();
        let size = product * Small::exact(1.0 + a.abs());
        prop_assert!(agree((x + y).exp(), product, size));
        let close = (x.exp().to_f64() / a.exp() - 1.0).abs() < 1e-12;
        prop_assert!(close);
        let wide = Large::exact(a).exp().to_f64();
        prop_assert!((wide - x.exp().to_f64()).abs() <= 1e-15 * wide);
    }

    #[test]
    fn sine_and_cosine_are_of_sums(a in -1e6..1e6_f64, b in -4.0..4.0_f64) {
        let (x, y) = (Small::exact(a), Small::exact(b));
        let ((sin, cos), (sin_y, cos_y)) = (x.sin_cos(), y.sin_cos());
        let one = Small::one();
        prop_assert!(agree(sin * sin + cos * cos, one, one));
        let (sum, _) = (x + y).sin_cos();
        // The rounding of an argument of 1e6 counts.
        prop_assert!(agree(sum, sin * cos_y + cos * sin_y, Small::exact(8.0 + a.abs())));
        prop_assert!((sin.to_f64() - libm::sin(a)).abs() < 1e-15);
        prop_assert!((cos.to_f64() - libm::cos(a)).abs() < 1e-15);
        let wide = Large::exact(a).sin_cos();
        prop_assert!((wide.0.to_f64() - sin.to_f64()).abs() < 1e-16);
    }
}

/// The number between 0 and 1 with these decimals.
fn parsed(decimals: &str) -> Small {
    let ten = Small::exact(10.0);
    let digit = |it: u8| Small::exact(f64::from(it - b'0'));
    let whole = decimals.bytes().fold(Small::zero(), |sum, it| sum * ten + digit(it));
    decimals.bytes().fold(whole, |it, _| it / ten)
}

fn near(a: Small, b: Small) -> bool {
    (a - b).bound().abs() < ScaledF64::from_f64(1e-59)
}

/// Sine and cosine of 1e22 and of 2^120, by mpmath 1.3.0.
#[test]
fn angles_of_many_turns_keep_sixty_digits() {
    let (sin, cos) = Small::exact(1e22).sin_cos();
    assert!(near(-sin, parsed("852200849767188801772705893753029368261762150410043656256509")));
    assert!(near(cos, parsed("523214785395138945497594473384709492140919972439387953527211")));
    let (sin, cos) = Small::one().scaled(120).sin_cos();
    assert!(near(sin, parsed("377820109360752022655548470056922991960586697651230664225799")));
    assert!(near(-cos, parsed("925879022854837867303861764107414946730833209928656460236049")));
    // More turns than there are bits leave none.
    assert!(Small::one().scaled(140).sin_cos().0.to_f64().is_nan());
    for power in [200, 400, 750] {
        let (large, widest) = (Large::one().scaled(power), Wide::<54, 3392>::one().scaled(power));
        let [large, widest] = [large.sin_cos().0.to_f64(), widest.sin_cos().0.to_f64()];
        assert_eq!(large, widest, "{power}");
    }
}

/// sin(1), cos(1) and exp(1) to 60 digits, by mpmath 1.3.0.
#[test]
fn known_values_hold_to_sixty_digits() {
    let (sin, cos) = Small::one().sin_cos();
    assert!(near(sin, parsed("841470984807896506652502321630298999622563060798371065672752")));
    assert!(near(cos, parsed("540302305868139717400936607442976603732310420617922227670097")));
    let e = parsed("718281828459045235360287471352662497757247093699959574966968");
    assert!(near(Small::one().exp(), Small::exact(2.0) + e));
}

#[test]
fn what_is_no_number_tells_nothing() {
    let nan = Small::exact(f64::INFINITY);
    assert!(nan.partial_cmp(&Small::one()).is_none() && nan.partial_cmp(&nan).is_none());
    assert!((Small::one() / Small::zero()).to_f64().is_nan());
    assert!((-Small::one()).sqrt().to_f64().is_nan());
    assert_eq!(Small::exact(-1e300).exp(), Small::zero());
    assert_eq!(Small::exact(-1e6).exp().bound().parts().1, -1_442_696);
    assert!(Small::exact(1e300).sin_cos().0.to_f64().is_nan());
}

/// The last bits of a wider arithmetic agree with a narrower one's, and the largest is exact.
#[test]
fn every_width_agrees_with_the_next() {
    type Widest = Wide<54, 3392>;
    let third = Widest::one() / Widest::exact(3.0);
    assert!(agree(third * Widest::exact(3.0), Widest::one(), Widest::one()));
    let (sin, cos) = third.sin_cos();
    assert!(agree(sin * sin + cos * cos, Widest::one(), Widest::one()));
    let (e, inverse) = (third.exp(), (-third).exp());
    assert!(agree(e * inverse, Widest::one(), Widest::one()));
    assert_eq!(Widest::TERMS, terms(3392));
    assert_eq!(terms(53), 9);
}
