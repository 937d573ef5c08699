//! Guards in which a switch is planted where a search that looks too far ahead would miss it: each
//! is a sum of fast and slow decays, an oscillation, a defective triple eigenvalue and a drift.

use super::{events, name, system};
use percuss::affine::{Solver, System};
use proptest::prelude::*;

/// The guard without its level: u e^(-fast t) + w e^(-slow t) + e^(-rho t) (p cos + q sin)(omega t)
/// + e^(-k t) (e0 + e1 t + e2 t^2/2) + drift t.
#[derive(Clone, Debug)]
struct Guard {
    fast: f64,
    u: f64,
    slow: f64,
    w: f64,
    rho: f64,
    omega: f64,
    p: f64,
    q: f64,
    k: f64,
    e: [f64; 3],
    drift: f64,
}

const TEXT: &str = "
[[mode]]
name = \"free\"
equations = [
    \"u' = -fast*u\", \"w' = -slow*w\", \"p' = -rho*p + omg*q\", \"q' = -rho*q - omg*p\",
    \"e0' = -k*e0 + e1\", \"e1' = -k*e1 + e2\", \"e2' = -k*e2\", \"d' = drift\"]
[[mode.until]]
name = \"reached\"
guard = \"u + w + p + e0 + d > level\"
";

impl Guard {
    fn value(&self, t: f64) -> f64 {
        let [e0, e1, e2] = self.e;
        let (sin, cos) = (self.omega * t).sin_cos();
        self.u * (-self.fast * t).exp()
            + self.w * (-self.slow * t).exp()
            + (-self.rho * t).exp() * (self.p * cos + self.q * sin)
            + (-self.k * t).exp() * (e0 + t * (e1 + 0.5 * t * e2))
            + self.drift * t
    }

    fn size(&self) -> f64 {
        let sizes = [self.u, self.w, self.p, self.q, self.e[0], self.e[1], self.e[2], self.drift];
        sizes.iter().map(|it| it.abs()).sum()
    }

    fn system(&self, level: f64) -> System {
        let Self { fast, u, slow, w, rho, omega, p, q, k, e: [e0, e1, e2], drift } = self;
        system(&format!(
            "schema = 1\nname = \"planted\"
states = [\"u\", \"w\", \"p\", \"q\", \"e0\", \"e1\", \"e2\", \"d\"]
[parameters]
fast = {fast:?}\nslow = {slow:?}\nrho = {rho:?}\nomg = {omega:?}\nk = {k:?}
drift = {drift:?}\nlevel = {level:?}{TEXT}
[start]\nmode = \"free\"
u = {u:?}\nw = {w:?}\np = {p:?}\nq = {q:?}\ne0 = {e0:?}\ne1 = {e1:?}\ne2 = {e2:?}\nd = 0\n"
        ))
    }

    /// Instants close enough to each other to see each oscillation and each decay.
    fn instants(&self, until: f64) -> Vec<f64> {
        let count = 2000.0 + 16.0 * self.omega * until;
        let even = (1..count as usize).map(|n| until * n as f64 / count);
        let early = (-90..0).map(|n| until * 10.0_f64.powf(f64::from(n) / 10.0));
        let mut all: Vec<f64> = even.chain(early).chain([until]).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The high places before a time, each refined between its neighbours, and the last instant.
    fn crests(&self, until: f64) -> Vec<(f64, f64)> {
        let all = self.instants(until);
        let values: Vec<f64> = all.iter().map(|t| self.value(*t)).collect();
        let tops = (1..all.len() - 1).filter(|n| values[*n] >= values[n - 1].max(values[n + 1]));
        let refined = tops.map(|n| self.refined(all[n - 1], all[n + 1]));
        refined.chain([self.refined(all[all.len() - 2], all[all.len() - 1])]).collect()
    }

    fn refined(&self, mut low: f64, mut high: f64) -> (f64, f64) {
        for _ in 0..100 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if self.value(a) < self.value(b) { low = a } else { high = b }
        }
        (low, self.value(low))
    }
}

/// The name of the first event, and its time.
fn first(system: &System, until: f64) -> (String, f64) {
    let all = events::<f64>(system, until);
    (name(system, &all[0]), all[0].time.value())
}

fn sized(size: f64) -> impl Strategy<Value = f64> {
    // Absent, tiny, small and large.
    let share = prop_oneof![Just(0.0), Just(1e-9), Just(1e-5), Just(1e-2), Just(1.0)];
    (share, -1.0..1.0_f64).prop_map(move |(share, it)| size * share * it)
}

fn guard() -> impl Strategy<Value = Guard> {
    let fast = prop_oneof![Just(1e6), Just(2e3), Just(50.0), 4.0..20.0_f64];
    let rho = prop_oneof![Just(0.0), Just(1e-3), 0.05..1.0_f64];
    let omega = prop_oneof![0.3..3.0_f64, 20.0..300.0_f64];
    let decays = (fast, sized(2.0), 0.2..2.0_f64, sized(1.0));
    let waves = (rho, omega, sized(1.0), sized(1.0));
    let triple = (0.3..3.0_f64, [sized(1.0), sized(1.0), sized(3.0)]);
    (decays, waves, triple, sized(0.5)).prop_map(|(decays, waves, (k, e), drift)| {
        let ((fast, u, slow, w), (rho, omega, p, q)) = (decays, waves);
        Guard { fast, u, slow, w, rho, omega, p, q, k, e, drift }
    })
}

/// Guards whose fastest part is one decay, which holds them down or lifts them for some time, and
/// whose rest is so slow that one polynomial follows it.
fn beside_a_decay() -> impl Strategy<Value = Guard> {
    let large = |size: f64| prop_oneof![sized(size), -size..size];
    let decays = (prop_oneof![2.0..8.0_f64, 8.0..60.0_f64], large(3.0), 0.05..0.5_f64, large(1.0));
    let waves = (0.0..0.3_f64, 0.1..1.0_f64, large(1.0), large(2.0));
    (decays, waves, sized(0.5), large(1.0)).prop_map(|(decays, waves, e, drift)| {
        let ((fast, u, slow, w), (rho, omega, p, q)) = (decays, waves);
        Guard { fast, u, slow, w, rho, omega, p, q, k: 0.3, e: [e, 0.0, 0.0], drift }
    })
}

const HORIZON: f64 = 10.0;

proptest! {
    #![proptest_config(ProptestConfig {
        max_global_rejects: 8192,
        ..ProptestConfig::with_cases(1000)
    })]

    /// Up to the event the guard is below its level wherever it is looked at, and most closely just
    /// before it; at the event it is at its level.
    #[test]
    fn no_crossing_comes_before_the_first_event(guard in guard(), above in above()) {
        none_before_the_first(&guard, above)?;
    }

    /// A guard whose fastest part is one decay is below its level up to the event as well.
    #[test]
    fn no_crossing_beside_a_decay_comes_before_the_first_event(
        guard in beside_a_decay(), above in above(),
    ) {
        none_before_the_first(&guard, above)?;
    }

    /// A crest is crossed where it is 1e-11 above the level, and not where it is that much below.
    #[test]
    fn a_crest_decides_by_its_last_digits(guard in guard()) {
        highest_crest_decides(&guard)?;
    }

    /// A crest beside a decay is crossed where it is 1e-11 above the level, and not where it is
    /// that much below.
    #[test]
    fn a_crest_beside_a_decay_decides_by_its_last_digits(guard in beside_a_decay()) {
        highest_crest_decides(&guard)?;
    }
}

/// The height of a guard's level above its beginning, as a share of its size.
fn above() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1e-9), Just(1e-6), Just(1e-3), 0.01..2.0_f64]
}

fn none_before_the_first(guard: &Guard, above: f64) -> Result<(), TestCaseError> {
    let room = 1e-13 * (1.0 + guard.size());
    let level = guard.value(0.0) + above * (1e-3 + guard.size());
    let (name, time) = first(&guard.system(level), HORIZON);
    let near = (1..400).map(|n| time - f64::from(n) * 0.02 / guard.omega);
    let near = near.filter(|it| *it > 0.0);
    for t in guard.instants(HORIZON).into_iter().filter(|it| *it < time).chain(near) {
        prop_assert!(guard.value(t) < level + room, "{t} before {time}");
    }
    let steepest = guard.fast * guard.u.abs() * (-guard.fast * time).exp()
        + guard.size() * (guard.omega + 10.0);
    let room = room + 1e-15 * time * steepest;
    prop_assert!(name == "end" || (guard.value(time) - level).abs() < room, "{time}");
    Ok(())
}

fn highest_crest_decides(guard: &Guard) -> Result<(), TestCaseError> {
    let crests = guard.crests(HORIZON);
    let highest = |best: (f64, f64), it: &(f64, f64)| if it.1 > best.1 { *it } else { best };
    let (at, value) = crests.iter().fold(crests[crests.len() - 1], highest);
    let margin = 1e-11 * (1e-2 + guard.size());
    prop_assume!(at > 1e-9 && at < 0.999 * HORIZON);
    prop_assume!(guard.value(0.0) < value - 2.0 * margin);
    // Rounding decides at a crest that is as near to the level as a hundred times what it may
    // do to the guard, and there are several hundred crests.
    let room = 1e-13 * (1.0 + guard.size());
    prop_assume!(crests.iter().all(|it| (it.1 - (value - margin)).abs() > room));
    let (missed, time) = first(&guard.system(value + margin), HORIZON);
    prop_assert!(missed == "end", "{missed} at {time}, {at}");
    let (hit, time) = first(&guard.system(value - margin), HORIZON);
    prop_assert!(hit == "reached" && time <= at * (1.0 + 1e-9), "{hit} at {time}, {at}");
    Ok(())
}

/// Motions that come to rest without an event, each in its own way, cost a bounded number of
/// pieces however long they are looked at.
#[test]
fn what_never_ends_is_passed_in_few_pieces() {
    let still = Guard {
        fast: 1e6,
        u: 0.5,
        slow: 0.2,
        w: 0.3,
        rho: 0.0,
        omega: 300.0,
        p: 0.1,
        q: 0.1,
        k: 0.5,
        e: [0.1, -0.2, 0.3],
        drift: 0.0,
    };
    let slowly = Guard { rho: 1e-4, omega: 1.0, p: 0.0, q: -1.0, ..still.clone() };
    let sinking = Guard { drift: -1e-3, ..slowly.clone() };
    for (guard, level) in [(still, 1.5), (slowly, 1.5), (sinking, 1.4)] {
        let system = guard.system(level);
        let solver = Solver::<f64>::new(&system).unwrap();
        let mut run = solver.run(system.start.as_ref().unwrap(), 1e9).unwrap();
        let all: Vec<_> = run.by_ref().map(|event| name(&system, &event)).collect();
        assert_eq!(all, ["end"]);
        assert!(run.work().pieces < 100, "{guard:?}: {:?}", run.work());
    }
}

/// The rate of a decay whose factor in a guard is 1e300 overflows where it is computed from two
/// norms. The other guard crosses later, and must not be taken for the first.
#[test]
fn a_rate_that_overflows_is_none() {
    let text = r#"
        schema = 1
        name = "large"
        states = ["u", "a", "d"]
        [parameters]
        r = 1e9
        c = 1e300
        s = 1.2
        level = 1.001
        other = 2.48
        fall = 3e8
        [[mode]]
        name = "free"
        equations = ["u' = -r*u", "a' = -fall*a", "d' = r"]
        [[mode.until]]
        name = "later"
        guard = "4*d + a > other"
        [[mode.until]]
        name = "first"
        guard = "c*u + s*d > level"
        [start]
        mode = "free"
        u = 1e-300
        a = 1
        d = 0
    "#;
    let system = System::parse("large.system.toml", text).unwrap();
    let (name, time) = first(&system, 1e-7);
    assert!(name != "later", "{name} at {time:e}");
}
