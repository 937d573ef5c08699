//! Branches of orbits in a parameter, held against closed forms, against roots that are found
//! another way, and against those of the percussive oscillator.

use percuss::affine::{NoOrbit, Orbit, Place, SectionMap, Solver, System, SystemError};
use percuss::dynamics::continuation::{BifurcationKind, Branch, BranchEnding, Family};
use percuss::dynamics::orbit::scan;
use percuss::system::{ReturnBifurcation, ReturnBranch, ReturnFamily, Section, SystemFile};
use percuss::{Instant, Parameter, Parameters};

macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../validation/systems/", $name, ".system.toml"))
    };
}

/// A mass that meets a spring with clearance.
pub const BILINEAR: &str = r#"
schema = 1
name = "bilinear"
states = ["x", "v"]
forcing = { omega = "frequency", phi = 0 }
[parameters]
frequency = 0.8
zeta = 0.05
k = 5.0
gap = 0.5
A = 0.6
[[mode]]
name = "free"
equations = ["x' = v", "v' = A*cos - 2*zeta*v - x"]
[[mode.until]]
name = "touch"
guard = "x > gap"
next = [{ mode = "contact" }]
[[mode]]
name = "contact"
equations = ["x' = v", "v' = A*cos - 2*zeta*v - x - k*(x - gap)"]
[[mode.until]]
name = "leave"
guard = "x < gap"
next = [{ mode = "free" }]
[start]
mode = "free"
x = 0
v = 0
"#;

const DRY_RIG: &str = include_str!("dry_rig.system.toml");

/// A system at the values of a parameter, with others set.
pub struct Varied {
    file: SystemFile,
    parameter: &'static str,
    section: Section,
}

impl Varied {
    pub fn new(text: &str, section: Section, parameter: &'static str, set: &[(&str, f64)]) -> Self {
        let mut file = SystemFile::read("test.system.toml", text).unwrap();
        for (name, value) in set {
            file.set(name, *value, "here").unwrap();
        }
        Self { file, parameter, section }
    }

    fn at(&self, value: f64) -> Result<System, SystemError> {
        let mut file = self.file.clone();
        file.set(self.parameter, value, "here")?;
        file.system()
    }

    /// What the return map at a value has.
    pub fn map<R>(&self, value: f64, then: impl FnOnce(&SectionMap<'_, f64>) -> R) -> R {
        let solver = Solver::new(&self.at(value).unwrap()).unwrap();
        then(&SectionMap::new(&solver, &self.section).unwrap())
    }

    /// The return after so many others.
    pub fn settled_return(&self, value: f64, transient: usize) -> Place<f64> {
        self.map(value, |map| {
            let mut returns = map.returns(map.system().start().unwrap()).unwrap();
            returns.by_ref().take(transient + 1).for_each(|it| drop(it.unwrap()));
            returns.place().unwrap()
        })
    }

    pub fn follow(&self, guess: &Place<f64>, period: u32, ends: [f64; 2]) -> ReturnBranch {
        let at = |value: f64| self.at(value);
        let family = ReturnFamily::new(self.section.clone(), None, &at);
        ReturnBranch::follow(&family, guess, period, ends, &mut |_| {}).unwrap()
    }
}

pub fn only_bifurcation(branch: &ReturnBranch, kind: BifurcationKind) -> &ReturnBifurcation {
    let mut found = branch.bifurcations.iter().filter(|it| it.kind == kind);
    let first = found.next().unwrap_or_else(|| panic!("{:?}", bifurcation_rows(branch)));
    assert!(found.next().is_none(), "{:?}", bifurcation_rows(branch));
    first
}

fn bifurcation_rows(branch: &ReturnBranch) -> Vec<(BifurcationKind, f64, f64, bool)> {
    branch.bifurcations.iter().map(|it| (it.kind, it.value, it.error, it.turns)).collect()
}

/// Ten digits are asked for; the error that is stated has to hold, with the roundings of the value
/// it is held to.
pub fn assert_value(found: &ReturnBifurcation, value: f64) {
    let off = (found.value - value).abs();
    assert!(found.error <= 1e-10 * value.abs(), "{} +- {}", found.value, found.error);
    assert!(off <= found.error + 4.0 * f64::EPSILON * value.abs(), "{} {value}", found.value);
}

/// The amplitude of the forced motion x'' + 2 zeta x' + x = cos omega t.
fn amplitude(frequency: f64, zeta: f64) -> f64 {
    1.0 / (1.0 - frequency * frequency).hypot(2.0 * zeta * frequency)
}

#[test]
fn a_spring_is_touched_where_the_free_motion_is_as_large_as_the_gap() {
    let varied = Varied::new(BILINEAR, Section::strobe(0.0), "gap", &[]);
    let branch = varied.follow(&varied.settled_return(2.0, 300), 1, [2.0, 1.56]);
    assert!(branch.is_complete(), "{}", branch.ending);
    let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
    assert_value(graze, 0.6 * amplitude(0.8, 0.05));
    assert_eq!(graze.event.unwrap().name(&varied.at(2.0).unwrap()), "touch@free");
    assert!(!graze.turns);
    let [first, last] = [&branch.points[0].1, &branch.points[branch.points.len() - 1].1];
    assert_eq!((first.events.len(), last.events.len()), (0, 2));
    // Back again the same graze is met.
    let back = varied.follow(&varied.settled_return(1.56, 300), 1, [1.56, 2.0]);
    assert_value(only_bifurcation(&back, BifurcationKind::Grazing), 0.6 * amplitude(0.8, 0.05));
}

/// The orbit that strikes a rigid stop has a derivative that grows as one over the speed of its
/// impact: the touch is that of the free motion, on the way there and on the way back, at a strobe
/// where the touch itself lies, too.
#[test]
fn a_rigid_stop_is_touched_where_the_free_motion_is() {
    let touch = 1.2 * amplitude(2.75, 0.05);
    for angle in [0.0, 1.0, 3.0] {
        let section = Section::strobe(angle);
        let varied = Varied::new(system!("rigid-impact-oscillator"), section, "d", &[("A", 1.2)]);
        for [from, to] in [[0.1, 0.3], [0.3, 0.1]] {
            let branch = varied.follow(&varied.settled_return(from, 501), 1, [from, to]);
            assert!(branch.is_complete(), "{angle} {from}: {}", branch.ending);
            let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
            assert_value(graze, touch);
            assert!(!graze.turns, "{angle} {from}");
            assert_eq!(branch.bifurcations.len(), 1, "{:?}", bifurcation_rows(&branch));
            let ends = [&branch.points[0], &branch.points[branch.points.len() - 1]];
            let impacts = ends.map(|(value, orbit)| (*value < touch, orbit.events.len()));
            assert!(impacts.iter().all(|(strikes, count)| *count == usize::from(*strikes)));
        }
    }
}

/// Next to a strobe at which the graze lies the map has two corners more. A multiplier of 4 becomes
/// one below 1 within 1e-4 of the graze, so that a fold lies between.
#[test]
fn a_graze_at_the_strobe_is_that_of_other_strobes() {
    let text = include_str!("../../benches/bilinear.system.toml");
    for angle in [0.0, 2.9, 3.0] {
        let varied = Varied::new(text, Section::strobe(angle), "frequency", &[]);
        let branch = varied.follow(&varied.settled_return(1.1, 500), 1, [1.1, 2.5]);
        assert!(branch.is_complete(), "{angle}: {}", branch.ending);
        assert_eq!(branch.bifurcations.len(), 3, "{:?}", bifurcation_rows(&branch));
        assert_value(only_bifurcation(&branch, BifurcationKind::Grazing), 1.252_884_567_093_854_4);
        let folds = branch.bifurcations.iter().filter(|it| it.kind == BifurcationKind::Fold);
        let folds: Vec<_> = folds.map(|it| it.value).collect();
        assert!((folds[0] - 1.548_088_891_779_077).abs() < 1e-13, "{angle}: {folds:?}");
        assert!((folds[1] - 1.252_842_589_956_201).abs() < 1e-13, "{angle}: {folds:?}");
        // The points are those of the strobe that was asked for.
        let (value, orbit) = &branch.points[branch.points.len() - 1];
        let shown = varied.map(*value, |map| {
            let mut returns = map.returns(map.system().start().unwrap()).unwrap();
            returns.by_ref().take(600).for_each(|it| drop(it.unwrap()));
            map.orbit(&returns.place().unwrap(), 1).unwrap()
        });
        let pairs = shown.points[0].state.iter().zip(&orbit.points[0].state);
        assert!(
            pairs.clone().all(|(a, b)| (a - b).abs() < 1e-10),
            "{:?}",
            pairs.collect::<Vec<_>>()
        );
    }
}

/// The touch passes the strobe at a gap of 1.5506, where the orbit's point changes its mode.
#[test]
fn an_event_that_passes_the_strobe_is_no_bifurcation() {
    let varied = Varied::new(BILINEAR, Section::strobe(0.0), "gap", &[]);
    let branch = varied.follow(&varied.settled_return(1.58, 300), 1, [1.58, 1.545]);
    assert!(branch.is_complete(), "{}", branch.ending);
    assert!(branch.bifurcations.is_empty(), "{:?}", bifurcation_rows(&branch));
    let modes: Vec<usize> = branch.points.iter().map(|it| it.1.points[0].mode).collect();
    assert_eq!((modes[0], modes[modes.len() - 1]), (0, 1));
}

/// A mass with dry friction that stops before the wall, or strikes it: the orbit that strikes next
/// to the touch is unstable with a multiplier beyond all bounds, and a fold makes it stable.
#[test]
fn a_stop_before_the_wall_becomes_a_strike_and_turns_back_at_a_fold() {
    let varied = Varied::new(DRY_RIG, Section::strobe(0.0), "P", &[]);
    let branch = varied.follow(&varied.settled_return(0.2575, 300), 1, [0.2575, 0.259]);
    assert!(branch.is_complete(), "{}", branch.ending);
    let grazing = only_bifurcation(&branch, BifurcationKind::Grazing);
    let fold = only_bifurcation(&branch, BifurcationKind::Fold);
    assert_eq!(branch.bifurcations.len(), 2, "{:?}", bifurcation_rows(&branch));
    assert_eq!(grazing.event.unwrap().name(&varied.at(0.258).unwrap()), "impact@right");
    assert!(grazing.turns && fold.turns);
    // The other end of the interval finds both as they are found from here.
    let back = varied.follow(&varied.settled_return(0.259, 300), 1, [0.259, 0.2575]);
    assert_value(only_bifurcation(&back, BifurcationKind::Grazing), grazing.value);
    assert_value(only_bifurcation(&back, BifurcationKind::Fold), fold.value);
}

/// The strobe comes among impacts that accumulate, of which the word of the orbit has the first:
/// where one of them passes it the word is another one, and nothing happens to the orbit.
#[test]
fn an_impact_that_passes_the_strobe_amid_chatter_is_no_bifurcation() {
    let varied = Varied::new(DRY_RIG, Section::strobe(0.0), "P", &[]);
    let branch = varied.follow(&varied.settled_return(0.5, 300), 1, [0.5, 0.47]);
    assert!(branch.is_complete(), "{}", branch.ending);
    assert!(branch.bifurcations.is_empty(), "{:?}", bifurcation_rows(&branch));
    let words: Vec<usize> = branch.points.iter().map(|it| it.1.events.len()).collect();
    assert_ne!(words[0], words[words.len() - 1]);
}

/// Beyond a graze at which the motion jumps another orbit may lie near: it is not the branch's. The
/// stick-slip of a drill string ends at 1.61504, and its steady cycle goes on to 1.60426.
#[test]
fn an_orbit_beyond_a_discontinuity_is_another_branchs() {
    let text = include_str!("drill_string.system.toml");
    let varied = Varied::new(text, Section::event("slow"), "w0", &[]);
    let branch = varied.follow(&varied.settled_return(1.5, 60), 1, [1.5, 2.0]);
    let BranchEnding::Lost { value } = branch.ending else { panic!("{}", branch.ending) };
    let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
    assert_value(graze, 1.615_041_302_772);
    assert_eq!(value, graze.value);
    assert_eq!(graze.event.unwrap().name(&varied.at(1.6).unwrap()), "stop@slip");
}

/// A neuron's current: the branch turns at a fold, and ends where its potential touches the
/// threshold before the spike, so that the spike comes earlier and the same events follow.
#[test]
fn a_branch_ends_where_an_event_comes_earlier() {
    let text = "schema = 1\nname = \"neuron\"\nstates = [\"v\", \"w\"]\n\
                forcing = { omega = 3, phi = 0 }\n[parameters]\nI = 1.6\n[[mode]]\n\
                name = \"leak\"\nequations = [\"v' = -v + I - w + cos/2\", \"w' = -w/4\"]\n\
                until = [{ name = \"spike\", guard = \"v > 1\", \
                reset = [\"v = 0\", \"w = w + 1/5\"] }]\n\
                [start]\nmode = \"leak\"\nv = 0\nw = 0\n";
    let varied = Varied::new(text, Section::strobe(0.0), "I", &[]);
    let branch = varied.follow(&varied.settled_return(1.9, 100), 2, [1.9, 2.6]);
    let fold = only_bifurcation(&branch, BifurcationKind::Fold);
    assert!((fold.value - 1.932_197_705_708_688).abs() <= 1e-13, "{}", fold.value);
    let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
    assert_value(graze, 1.932_079_053_990_55);
    assert_eq!(branch.ending, BranchEnding::Lost { value: graze.value });
    assert_eq!(graze.event.unwrap().name(&varied.at(1.9).unwrap()), "spike@leak");
}

/// A neuron of one state: the branch ends where a spike's threshold is touched from the side of
/// the spike, and a multiplier grows without bound. The value is that of two equations for the two
/// spikes and one for the touch, solved in 30 digits by another program from the closed form.
#[test]
fn a_branch_ends_where_a_spike_becomes_a_touch() {
    let text = "schema = 1\nname = \"neuron\"\nstates = [\"u\"]\n\
                forcing = { omega = 2.2, phi = 0 }\n[parameters]\nI = 1\n[[mode]]\n\
                name = \"rest\"\nequations = [\"u' = -u/2 + I + cos/2\"]\n\
                until = [{ name = \"spike\", guard = \"u > 1\", reset = [\"u = 0\"] }]\n\
                [start]\nmode = \"rest\"\nu = 0.2\n";
    let ends = [0.94, 0.9, 0.5].map(|to| (0.0, to));
    let angles = [0.0, 1.0, 2.0, 3.0, 5.0].map(|angle| (angle, 0.3));
    for (angle, to) in ends.into_iter().chain(angles) {
        let varied = Varied::new(text, Section::strobe(angle), "I", &[]);
        let branch = varied.follow(&varied.settled_return(1.0, 300), 1, [1.0, to]);
        only_bifurcation(&branch, BifurcationKind::Fold);
        let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
        let apart = (graze.value - 0.975_507_101_985_535).abs();
        // For 54 sections and ranges the stated error was at most 2.0e-9, and the true one at most
        // 1 % of that.
        assert!(apart <= graze.error && graze.error <= 4e-9, "{apart:e}, {:e}", graze.error);
        assert_eq!(branch.ending, BranchEnding::Lost { value: graze.value });
        assert_eq!(graze.event.unwrap().name(&varied.at(1.0).unwrap()), "spike@rest");
    }
}

/// A mass between two stops: its orbit with an impact at each is lost where the free motion is as
/// large as the gap, and both impacts become touches at once. A multiplier grows beyond 1e8 on the
/// way, so that the orbits are hard to find; the free motion takes over, and ends at rest.
#[test]
fn an_orbit_between_two_stops_becomes_the_free_motion() {
    let text = "schema = 1\nname = \"two\"\nstates = [\"x\", \"v\"]\n\
                forcing = { omega = 1.3, phi = 0 }\n[parameters]\nA = 1\n[[mode]]\n\
                name = \"free\"\nequations = [\"x' = v\", \"v' = -x - v/10 + A*cos\"]\n\
                [[mode.until]]\nname = \"right\"\nguard = \"x > 1\"\nreset = [\"v = -4/5*v\"]\n\
                [[mode.until]]\nname = \"left\"\nguard = \"x < -1\"\nreset = [\"v = -4/5*v\"]\n\
                [start]\nmode = \"free\"\nx = 0.1\nv = 0\n";
    let varied = Varied::new(text, Section::strobe(0.0), "A", &[]);
    let branch = varied.follow(&varied.settled_return(1.0, 300), 1, [1.0, 0.0]);
    assert!(branch.is_complete(), "{}", branch.ending);
    only_bifurcation(&branch, BifurcationKind::Fold);
    let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
    assert_value(graze, 1.0 / amplitude(1.3, 0.05));
    assert_eq!(branch.bifurcations.len(), 2, "{:?}", bifurcation_rows(&branch));
}

/// A mass that strikes another one: of the four multipliers a pair leaves and enters the unit
/// circle while the others become real, and one grows without bound where the stop is touched: at
/// the value at which the free motion is as wide as the gap, from either side. The circle's values
/// were computed in 25 digits by another program, from the closed form.
#[test]
fn a_pair_passes_the_circle_where_another_one_becomes_real() {
    let text = "schema = 1\nname = \"two-dof\"\nstates = [\"x\", \"v\", \"y\", \"u\"]\n\
                forcing = { omega = \"w\", phi = 0 }\n[parameters]\nw = 2.6\n[let]\n\
                spring = \"(x - y)/2\"\nmean = \"(2*v + u)/3\"\napart = \"v - u\"\n[[mode]]\n\
                name = \"free\"\nequations = [\"x' = v\", \"v' = cos - x - v/10 - spring\", \
                \"y' = u\", \"u' = 2*(spring - y - u/10)\"]\nuntil = [{ name = \"hit\", \
                guard = \"x - y > 1/2\", reset = [\"v = mean - 4/15*apart\", \
                \"u = mean + 8/15*apart\"] }]\n\
                [start]\nmode = \"free\"\nx = 0\nv = 0\ny = 0\nu = 0\n";
    let varied = Varied::new(text, Section::strobe(0.0), "w", &[]);
    for ends in [[4.0, 1.7], [1.7, 4.0]] {
        let branch = varied.follow(&varied.settled_return(ends[0], 2000), 1, ends);
        assert!(branch.is_complete() && branch.unnamed_changes().is_empty(), "{}", branch.ending);
        let on_circle = |it: &&ReturnBifurcation| it.kind == BifurcationKind::NeimarkSacker;
        let mut found: Vec<f64> =
            branch.bifurcations.iter().filter(on_circle).map(|it| it.value).collect();
        found.sort_by(f64::total_cmp);
        let known = [1.724_488_362_142_647, 1.822_928_825_764_8];
        let pairs = found.iter().zip(known);
        assert!(
            found.len() == 2 && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12),
            "{found:?}"
        );
        let graze = only_bifurcation(&branch, BifurcationKind::Grazing);
        assert_value(graze, 2.192_080_576_123_025);
    }
}

/// Unstable orbits are followed past it, too, and orbits that a reset changes there.
#[test]
fn no_angle_of_the_strobe_changes_a_branch() {
    let along = |angle: f64| {
        let set = [("k", 30.0), ("gap", 1.2), ("A", 0.7)];
        let varied = Varied::new(BILINEAR, Section::strobe(angle), "frequency", &set);
        varied.follow(&varied.settled_return(1.0, 300), 1, [1.0, 2.5])
    };
    let expected = along(0.0);
    assert!(expected.is_complete() && expected.bifurcations.len() >= 2, "{}", expected.ending);
    for angle in [1.0, 2.0, 4.0, 5.0] {
        let found = along(angle);
        assert!(found.is_complete(), "{angle}: {}", found.ending);
        assert_eq!(found.bifurcations.len(), expected.bifurcations.len(), "{angle}");
        for (own, known) in found.bifurcations.iter().zip(&expected.bifurcations) {
            assert_eq!((own.kind, own.turns), (known.kind, known.turns), "{angle}");
            let rounding = 8.0 * f64::EPSILON * known.value;
            let off = (own.value - known.value).abs();
            assert!(off <= own.error + known.error + rounding, "{angle}: {} {}", own.value, off);
        }
    }
    let impacts = "schema = 1\nname = \"hammer\"\nstates = [\"x\", \"v\"]\n\
                   forcing = { omega = 2.6, phi = 0 }\n\
                   [parameters]\nm = 1\nz = 0.04\nF = 1\nd = 0.25\nr = 0.7\n[[mode]]\n\
                   name = \"fly\"\nequations = [\"x' = v\", \"v' = (F*cos - 2*z*v - x)/m\"]\n\
                   until = [{ name = \"hit\", guard = \"x > d\", \
                   reset = [\"x = d\", \"v = -r*v\"] }]\n\
                   [start]\nmode = \"fly\"\nx = 0\nv = 0\n";
    for angle in [0.0, 1.0] {
        let varied = Varied::new(impacts, Section::strobe(angle), "m", &[]);
        let branch = varied.follow(&varied.settled_return(0.6, 500), 1, [0.6, 0.3]);
        assert!(branch.is_complete(), "{angle}: {}", branch.ending);
        assert!(branch.bifurcations.is_empty(), "{:?}", bifurcation_rows(&branch));
    }
}

#[test]
fn a_rigid_stop_is_touched_where_the_free_motion_is_as_large_as_the_gap() {
    let varied = Varied::new(system!("rigid-impact-oscillator"), Section::strobe(0.0), "A", &[]);
    let branch = varied.follow(&varied.settled_return(0.5, 300), 1, [0.5, 1.2]);
    let graze = &branch.bifurcations[0];
    assert_eq!(graze.kind, BifurcationKind::Grazing);
    assert_value(graze, 0.125 / amplitude(2.75, 0.05));
    assert_eq!(graze.event.unwrap().name(&varied.at(0.5).unwrap()), "impact@free");
}

/// The value at which a test of the orbit vanishes, by secants, each orbit by Newton's method.
fn root(varied: &Varied, near: &ReturnBifurcation, step: f64, test: impl Fn(&Orbit) -> f64) -> f64 {
    let orbit = |value: f64| -> Result<Orbit, NoOrbit> {
        let point = &near.orbit.points[0];
        varied.map(value, |map| {
            let start = map.system().start().unwrap();
            let place = {
                let mut returns = map.returns(start).unwrap();
                returns.next().unwrap().unwrap();
                returns.place().unwrap()
            };
            let place = place.moved_to(place.time, point.state.clone());
            map.orbit(&place, near.orbit.period() as u32)
        })
    };
    let (mut a, mut b) = (near.value - step, near.value + step);
    let (mut at_a, mut at_b) = (test(&orbit(a).unwrap()), test(&orbit(b).unwrap()));
    for _ in 0..20 {
        let next = b - at_b * (b - a) / (at_b - at_a);
        if !next.is_finite() || next == b {
            break;
        }
        (a, at_a, b) = (b, at_b, next);
        at_b = test(&orbit(b).unwrap());
    }
    b
}

#[test]
fn a_buck_converter_doubles_where_a_multiplier_is_minus_one() {
    let varied = Varied::new(system!("buck-converter"), Section::event("clock"), "Vin", &[]);
    let branch = varied.follow(&varied.settled_return(22.0, 200), 1, [22.0, 26.0]);
    assert!(branch.is_complete(), "{}", branch.ending);
    let flip = only_bifurcation(&branch, BifurcationKind::Flip);
    let value = root(&varied, flip, 0.01, |it| it.multipliers[0][0] + 1.0);
    assert!((flip.value - value).abs() <= 1e-10 * value, "{} {value}", flip.value);
    // Fossas and Olivar have it at 24.516.
    assert!((flip.value - 24.516).abs() < 1e-3, "{}", flip.value);
    for (value, orbit) in &branch.points {
        assert_eq!(orbit.is_stable(), *value < flip.value, "{value}");
    }
}

/// At A = 3 the mass no longer sticks, as it stops where the force comes to hold it no more, and a
/// multiplier comes to 1 there: what rounding leaves uncertain of the orbit decides where the last
/// sticking is found, and whether that is told as the event or as the corner of the two.
#[test]
fn a_last_sticking_at_which_a_multiplier_is_one_is_within_its_error() {
    let text = system!("dry-friction-oscillator");
    let slipping = text.replace("mode = \"stick\"\nt = 2.0", "mode = \"right\"\nt = 0");
    assert_ne!(slipping, text);
    let varied = Varied::new(&slipping, Section::strobe(0.0), "A", &[]);
    for from in [2.95, 2.9, 2.8, 2.5, 2.0, 1.2] {
        let branch = varied.follow(&varied.settled_return(from, 50), 1, [from, 3.0]);
        let [lost] = &branch.bifurcations[..] else {
            panic!("{from}: {:?}", bifurcation_rows(&branch))
        };
        // The rate of the force is zero at the last stop, which is a graze if it is seen so near.
        let kinds = [BifurcationKind::EventLost, BifurcationKind::Corner, BifurcationKind::Grazing];
        assert!(kinds.contains(&lost.kind), "{from}: {:?}", bifurcation_rows(&branch));
        let (value, error) = (lost.value, lost.error);
        assert!((value - 3.0).abs() <= error, "{from}: {value} +- {error}");
        // A rounding of the orbit over 1 less a multiplier is as large there as 3 - A, 1e-7. From
        // beyond, the end is seen as far away as a step is longer than that.
        assert!(error < 1e-6, "{from}: {error}");
    }
}

/// The oscillator's own branch, and that of its system: the points at the same values, and the
/// bifurcations.
fn beside_the_oscillators(period: u32, ends: [f64; 2], text: &[(&str, f64)]) {
    let parameters = Parameters { xi: 0.1, ..Parameters::default() };
    let family = Family::new(parameters, Parameter::Omega, Instant::at(1.0, 0.0, 0));
    let found = scan(&family.map(ends[0]).unwrap(), period, &mut |_| {}).remove(0);
    let own =
        Branch::follow(&family, found.points[0], period, ends[0], ends[1], &mut |_| {}).unwrap();
    let varied =
        Varied::new(system!("percussive-oscillator"), Section::strobe(0.0), "frequency", text);
    let mut start = varied.settled_return(ends[0], 0);
    let [p, y, q] = found.points[0];
    start = start.moved_to(start.time, vec![p, y, q, 0.0]);
    let branch = varied.follow(&start, period, ends);
    assert_eq!(branch.ending == BranchEnding::Reached, own.is_complete());
    assert_eq!(
        branch.bifurcations.len(),
        own.bifurcations.len(),
        "{:?}",
        bifurcation_rows(&branch)
    );
    for (a, b) in branch.bifurcations.iter().zip(&own.bifurcations) {
        let is_smooth = b.kind != BifurcationKind::Grazing;
        assert!(!is_smooth || a.kind.as_str() == b.kind.as_str(), "{:?} {:?}", a.kind, b.kind);
        let within = a.error + b.error;
        assert!((a.value - b.value).abs() <= within, "{} {} {within}", a.value, b.value);
        assert_eq!(a.turns, b.turns);
    }
    for (value, orbit) in &branch.points {
        let at: [f64; 3] = std::array::from_fn(|n| orbit.points[0].state[n]);
        let there = percuss::dynamics::orbit::Orbit::find(&family.map(*value).unwrap(), at, period);
        let there = there.unwrap().points[0];
        let apart = at.iter().zip(there).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart <= 1e-9, "{value} {at:?} {there:?}");
    }
}

#[test]
fn the_percussive_oscillators_branches_are_those_of_its_system() {
    beside_the_oscillators(5, [1.6, 1.7], &[("xi", 0.1)]);
    beside_the_oscillators(4, [1.56, 1.6], &[("xi", 0.1)]);
    beside_the_oscillators(2, [1.4, 1.2], &[("xi", 0.1)]);
}

/// A linear oscillator whose passages of a level are watched: the level is the section and the
/// parameter, so that the points of one orbit lie short of the next section, or beyond it.
const LEVEL: &str = r#"
schema = 1
name = "level"
states = ["x", "v"]
forcing = { omega = 1.25, phi = 0 }
[parameters]
z = 0.25
th = 0.5
[[mode]]
name = "m"
equations = ["x' = v", "v' = cos - x - 2*z*v"]
watch = [{ name = "level", guard = "x > th", direction = "DIRECTION" }]
[start]
mode = "m"
x = 0
v = 0
"#;

#[test]
fn a_watched_section_moves_with_the_parameter() {
    let omega: f64 = 1.25;
    let amplitude = (1.0 - omega.powi(2)).hypot(2.0 * 0.25 * omega).recip();
    for (direction, sign) in [("rising", 1.0), ("falling", -1.0)] {
        let text = LEVEL.replace("DIRECTION", direction);
        let varied = Varied::new(&text, Section::event("level"), "th", &[]);
        for ends in [[1.1, 0.3], [0.3, 1.1], [0.5, 0.51], [0.7, -0.7]] {
            let guess = varied.settled_return(ends[0], 40);
            let branch = varied.follow(&guess, 1, ends);
            assert_eq!(branch.ending, BranchEnding::Reached, "{direction} {ends:?}");
            assert!(branch.bifurcations.is_empty(), "{:?}", bifurcation_rows(&branch));
            for (value, orbit) in &branch.points {
                let [x, v] = orbit.points[0].state[..] else { panic!("two states") };
                let speed = sign * omega * (amplitude.powi(2) - value.powi(2)).sqrt();
                assert!((x - value).abs() < 1e-12, "{x} at {}", value);
                assert!((v - speed).abs() < 1e-10, "{v} is not {speed} at {}", value);
                let period = std::f64::consts::TAU / omega;
                assert!((orbit.time - period).abs() < 1e-12, "{}", orbit.time);
                assert_eq!(orbit.events.len(), 1);
            }
        }
    }
}

#[test]
fn an_event_of_the_section_is_lost_where_its_guard_is_touched() {
    let omega: f64 = 1.25;
    let amplitude = (1.0 - omega.powi(2)).hypot(2.0 * 0.25 * omega).recip();
    for (direction, period) in [("rising", 1), ("falling", 1), ("both", 2)] {
        let text = LEVEL.replace("DIRECTION", direction);
        let varied = Varied::new(&text, Section::event("level"), "th", &[]);
        for ends in [[0.3, 2.0], [-0.5, 1.5], [0.5, -1.5]] {
            let guess = varied.settled_return(ends[0], 40);
            let branch = varied.follow(&guess, period, ends);
            // Beyond the touch there is no return; of both directions the same orbits may go on,
            // begun at the other crossing.
            let is_ended = match branch.ending {
                BranchEnding::Lost { .. } => true,
                BranchEnding::Left => period == 2,
                _ => false,
            };
            assert!(is_ended, "{direction} {ends:?} {}", branch.ending);
            let found = only_bifurcation(&branch, BifurcationKind::EventLost);
            assert_eq!(branch.bifurcations.len(), 1, "{:?}", bifurcation_rows(&branch));
            assert_eq!(found.event.unwrap().name(&varied.at(0.5).unwrap()), "level@m");
            assert!(found.turns);
            assert_value(found, amplitude.copysign(ends[1]));
        }
    }
}
