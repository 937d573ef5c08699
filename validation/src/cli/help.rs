//! What `--help` of each verb says below its flags: examples, and what the verb's words
//! mean. A test parses every example, and runs one of each verb as docs/COMMAND_LINE.md shows it.

pub(super) const PROGRAM: &str = "\
Examples:
  percuss validate
      which ODE solvers miss events, on every case
  percuss events bouncing-ball --events 4
      the events of a system, every digit proved
  percuss simulate --periods 40 --output motion.png
      the impact oscillator, as a picture

`percuss VERB --help` says what a verb answers, with examples, and what
its words mean.";

pub(super) const VALIDATE: &str = "\
Examples:
  percuss validate
      every engine on every case
  percuss validate -e '^exact$' -e dopri5 -c '^small-b$'
      chosen engines on one case, row by row
  percuss validate -e '^exact$' -e dopri5 -c '^small-b$' --out report
      with a report, and close-ups of the first wrong events
  percuss validate --details
      with what the first screen leaves out
  percuss validate --power
      with engines that are wrong on purpose, which must fail

Words:
  engine       a method of a library, with the way in which its events
               are located
  case         a system with its parameters, a start, a horizon, and
               what is known of its events
  truth        tables of events with proved digits, or the exact
               solver's run in 106 bits
  event        an instant at which a guard becomes true
  guard        a condition on state and forcing, such as x < 0, that
               ends a mode or is only counted
  segment      the motion between two events, in one mode
  record       an event of an engine, which is judged by the exact
               continuation of the record before it
  missed       an event of an exact continuation that the engine went
               past
  spurious     a record of an event that the exact continuation does not
               have
  judged       records of an engine and events that it missed, each held
               against the exact continuation of the record before
  right        a case at a setting that passes or is undecidable, with
               its sampled states judged; what was not run is not right
  rank         one more than the number of engines that are better: by
               no unexpected failure (!), then by the cases right, as a
               bootstrap over the cases tells at 95 %
  rhs          right-hand sides, with Jacobians as their columns and
               linear solves, over the cases that all engines ran
  known        verdict of a row that fails as shortcomings.toml
               expects, with the reason there
  undecidable  verdict of a row at a graze that the method's own error
               hides: either answer is right
  not-scored   verdict of a row with too little to judge";

pub(super) const SCORE: &str = "\
Examples:
  percuss score --name by-hand --tolerance 1e-9 --answers answers \\
      -c '^ball-geometric$'
      the answers to one case
  percuss score --name by-hand --library pencil --version 2 \\
      --tolerance 1e-6 --answers answers --out report
      the answers to all cases, with a report

Words:
  answer       CASE.events.csv and CASE.samples.csv in the folder of
               --answers
  before       columns before.<state> of an event: the state that its
               reset has not touched
  record       an event of an answer, which is judged by the exact
               continuation of the record before it
  missed       an event of an exact continuation that the answer lacks
  spurious     a record of an event that the exact continuation does not
               have
  unavailable  verdict of a case that was not answered, which is not
               right";

pub(super) const EXPORT: &str = "\
Examples:
  percuss export --out asked -c '^ball-geometric$' -c '^small-b$'
      two cases
  percuss export --out asked
      all cases, those of derivatives through events too

Words:
  case    a system with its parameters, a start, a horizon, and what is
          known of its events
  mode    a set of affine equations that holds between two events
  guard   a condition on state and forcing, such as x < 0, that ends a
          mode or is only counted
  reset   the change of the state at an event
  sample  a time between events at which the state is asked";

pub(super) const ENGINES: &str = "\
Example:
  percuss engines
      as CSV

Words:
  engine  a method of a library, with the way in which its events are
          located
  events  who locates events: proved (the exact solver), library, or
          harness (percuss, on the library's dense output)";

pub(super) const CASES: &str = "\
Examples:
  percuss cases
      as CSV
  percuss cases --cases mine
      the cases of a folder of your own

Words:
  case     a system with its parameters, a start, a horizon, and what
           is known of its events
  trouble  the difficulty that a system's case makes, such as
           accumulation or chatter
  table    the reference table of its events; empty where the truth is
           a run in 106 bits";

pub(super) const SYSTEMS: &str = "\
Example:
  percuss systems
      as CSV

Words:
  mode     a set of affine equations that holds between two events
  event    an instant at which a guard becomes true
  trouble  the difficulty for integrators for which the system was
           chosen";

pub(super) const CHECK: &str = "\
Examples:
  percuss check bouncing-ball
      a system inside the program
  percuss check my-rig.system.toml --set gap=0.5
      a file of your own, with another parameter

Words:
  mode   a set of affine equations that holds between two events
  until  a guard that ends its mode where it becomes true
  watch  a guard whose crossings are events and end nothing
  zero   by the model: whatever rounded numbers say; after an event,
         by this event alone";

pub(super) const NEW: &str = "\
Examples:
  percuss new my-rig
      writes my-rig.system.toml
  percuss new second-rig
      writes second-rig.system.toml";

pub(super) const EVENTS: &str = "\
Examples:
  percuss events bouncing-ball --events 3
      the first three impacts
  percuss events relay-feedback --until 4 --digits 25
      with 25 digits
  percuss events plastic-ball-on-table --until 30 --output flights.png
      a picture of the run

Words:
  mode          a set of affine equations that holds between two events
  guard         a condition on state and forcing, such as x < 0, that
                ends a mode or is only counted
  event         an instant at which a guard becomes true
  segment       the motion between two events, in one mode
  proved digit  a digit that holds for the exact solution of the
                system; a cell holds no others
  accumulation  infinitely many events before a finite time, where a
                run ends
  no-progress   a run that ends because events follow each other
                without time passing
  undecided     a run that ends because even the last bits do not tell
                which event comes first";

pub(super) const GRADIENT: &str = "\
Examples:
  percuss gradient bouncing-ball --events 2 --wrt g,e,start.v
      the first two impacts by gravity, restitution and speed
  percuss gradient relay-feedback --until 4 --wrt delta --digits 25
      with 25 digits, and the state at the end

Words:
  event           an instant at which a guard becomes true
  derivative      of a row of `percuss events` by a name: of the event's
                  time, and of the state just after it at that time,
                  which moves with the name
  side            `-` below and `+` above the name's value, where the
                  derivatives differ
  to first order  what is zero stays so for a small change of the name,
                  but for terms of its square
  proved digit    a digit that holds for the exact derivative; a cell
                  holds no others";

pub(super) const SIMULATE: &str = "\
Examples:
  percuss simulate --omega 0.1 --events 5
      five events from rest
  percuss simulate --periods 1 --samples 4
      four samples a forcing period
  percuss simulate --periods 40 --output motion.png
      a picture of forty forcing periods
  percuss simulate rigid-impact-oscillator --transient 500 --events 4
      any system, after 500 forcing periods
  percuss simulate relay-feedback --section switch-up \\
      --transient 50 --returns 1
      one turn of an oscillation without forcing, event to event
  percuss simulate rigid-impact-oscillator --transient 500 \\
      --returns 30 --show x-d,v --size 80x60 --output plane.png \\
      --output plane.npz
      its phase plane from the stop, for a column of a paper, and the
      run's arrays

Words:
  phase           no-contact (the mass flies), contact (it presses the
                  slider), progression (the slider slips)
  event           the instant at which a phase ends and the next begins,
                  and a crossing that a SYSTEM watches
  return          of a SYSTEM: the motion's next instant at --section;
                  without one a forcing period on, where the forcing has
                  the angle that it has at the start
  forcing period  2 pi/omega, the unit of all periods in flags and
                  results
  drift           v, by which the slider has gone forward; per period,
                  its mean rate";

pub(super) const POINCARE: &str = "\
Examples:
  percuss poincare --transient 500 --periods 4
      four points
  percuss poincare --transient 500 --periods 3000 --output section.png
      a picture
  percuss poincare relay-feedback --section switch-up --transient 5 \\
      --returns 3
      a system's states just after an event
  percuss poincare rigid-impact-oscillator --transient 500 \\
      --returns 2000 --show x-d,v --output stop.svg \\
      --output stop.csv
      a picture and its data, of one run

Words:
  strobe          the state once a forcing period, where the forcing
                  angle has one value
  section         of a SYSTEM: strobes, or the states just after an
                  event; a motion returns to it
  forcing period  2 pi/omega, the unit of all periods in flags and
                  results
  transient       forcing periods at the beginning that are left out
  drift           v, by which the slider has gone forward; per period,
                  its mean rate";

pub(super) const LYAPUNOV: &str = "\
Examples:
  percuss lyapunov --transient 100 --periods 1000
      a chaotic motion
  percuss lyapunov --xi 0.5 --omega 1.4 --transient 500 --periods 100
      a periodic one
  percuss lyapunov relay-feedback --section switch-up --transient 20 \\
      --returns 100
      of a system, from event to event

Words:
  exponent        mean rate, per forcing period, at which a small
                  difference between two motions grows; positive: chaos
  null            minus infinity: an impact, or motion on the slider
                  throughout, forgets one direction at once
  standard error  that of a mean over the run, from the scatter of at
                  most 32 equal batches
  saltation       the jump of a small difference at an event, which the
                  exponents take in
  stationary      false where the means of the batches change on the
                  way: leave more out by --transient; null below 128
                  periods
  contraction     the sum of the exponents that are not minus infinity
  drift           v, by which the slider has gone forward; per period,
                  its mean rate
  forcing period  2 pi/omega, the unit of all periods in flags and
                  results";

pub(super) const BIFURCATION: &str = "\
Examples:
  percuss bifurcation --xi 0.1 --parameter omega --from 1.6 \\
      --to 1.7 --steps 3 --transient 300 --periods 2
      three values as CSV
  percuss bifurcation --xi 0.1 --parameter omega --from 1.5 \\
      --to 1.8 --steps 40 --transient 100 --periods 20 --reset \\
      --output diagram.svg
      a picture, each value from rest
  percuss bifurcation rigid-impact-oscillator --parameter d \\
      --from 0.2 --to 0.3 --steps 100 --transient 200 --returns 20 \\
      --output stops.png
      of a system, over any of its parameters
  percuss bifurcation rigid-impact-oscillator --parameter d \\
      --from 0.2 --to 0.3 --steps 100 --transient 200 --returns 20 \\
      --show x-d --size 80x60 --output gap.png --output gap.csv
      the distance from the stop, as a picture for a paper and as data

Words:
  strobe          the state once a forcing period, where the forcing
                  angle has one value
  section         of a SYSTEM: strobes, or the states just after an
                  event; a motion returns to it
  carry           each value starts where the last one ended, so
                  coexisting motions show as hysteresis
  reset           each value starts from the start given
  escape          a state that passes 1e9, or is proved to: the value
                  is left out and counted, as one of a SYSTEM is whose
                  motion does not return as often
  drift           v, by which the slider has gone forward; per period,
                  its mean rate
  forcing period  2 pi/omega, the unit of all periods in flags and
                  results";

pub(super) const ATTRACTORS: &str = "\
Examples:
  percuss attractors --xi 0.1 --omega 1.6 --grid 20x20 \\
      --window -3,1.2,-1.5,1.5 --transient 60 --format table
      a table for reading
  percuss attractors rigid-impact-oscillator --set zeta=0.1 \\
      --grid 12x12 --window -1,0.4,-1,1 --transient 60 \\
      --format table
      of a system, in its first two states

Words:
  attractor   a motion that starts settle into: periodic, quasi-
              periodic or chaotic
  share       of all starts of the grid
  unresolved  a start whose attractor is not known after the last
              extension of its transient
  escaping    starts whose state grows without bound; their id is -2
  equilibrium of a SYSTEM: a motion that does not return
  exponent    mean rate, per forcing period, at which a small
              difference between two motions grows; positive: chaos
  multiplier  factor by which a small deviation from an orbit grows in
              one turn; below 1 in size: stable
  drift       v, by which the slider has gone forward; per period, its
              mean rate";

pub(super) const BASINS: &str = "\
Examples:
  percuss basins --xi 0.1 --omega 1.6 --grid 60x40 \\
      --window -3,1.2,-1.5,1.5 --transient 60 --output basins.png \\
      --format table
      a picture, and a table of the attractors
  percuss basins --xi 0.1 --omega 1.6 --grid 20x20 \\
      --window -3,1.2,-1.5,1.5 --transient 60 --output basins.npz \\
      --format table
      arrays

Words:
  attractor    a motion that starts settle into: periodic, quasi-
               periodic or chaotic
  basin        the starts that settle into one attractor
  label        the id of a start's attractor; -1 unresolved, -2
               escaping; of a SYSTEM also -3 where a guard is positive
               at the start, and -4 where the run ends
  unresolved   a start whose attractor is not known after the last
               extension of its transient
  uncertainty  shares of starts whose neighbour at a distance has
               another label; its exponent gives the dimension of the
               boundary";

pub(super) const ORBIT: &str = "\
Examples:
  percuss orbit --xi 0.1 --omega 1.6 --period 6 --format table
      all that a scan of starts finds
  percuss orbit --xi 0.1 --omega 1.6 --period 6 --all \\
      --output orbits.json
      the same as JSON
  percuss orbit relay-feedback --section switch-up --period 1 \\
      --format table
      of a system, from the motion that its start leads to
  percuss orbit rigid-impact-oscillator --period 3 --all \\
      --grid 12x12 --window=-1,0.1,-1,1 --format table
      all of a system that are reached from a grid of starts

Words:
  orbit           a motion that repeats, but for its drift, after a
                  whole number of forcing periods, or of returns to a
                  SYSTEM's section
  multiplier      factor by which a small deviation from an orbit grows
                  in one turn; below 1 in size: stable
  residual        what is left of the equation that the orbit solves,
                  in the state
  forcing period  2 pi/omega, the unit of all periods in flags and
                  results
  drift           v, by which the slider has gone forward; per period,
                  its mean rate";

pub(super) const CONTINUE: &str = "\
Examples:
  percuss continue --xi 0.1 --parameter omega --from 1.6 \\
      --to 1.59 --period 6 --output branch.json
      a branch without a bifurcation
  percuss continue --xi 0.1 --parameter omega --from 1.6 --to 1.7 \\
      --period 5 --output fold.json
      one that turns back in a fold: exit code 1
  percuss continue buck-converter --section clock --transient 200 \\
      --parameter Vin --from 24 --to 25 --period 1 --output buck.json
      a SYSTEM: where a converter's orbit doubles
  percuss continue buck-converter --section clock --transient 200 \\
      --parameter Vin --from 22 --to 26 --period 1 --show v-Vref \\
      --size 80x60 --output doubling.png --output doubling.json
      a picture of the branch, and its data
  percuss continue buck-converter --section clock --transient 200 \\
      --parameter Vin --from 22 --to 26 --period 1 --second R \\
      --second-range 15,30 --output flips.csv
      where it doubles in two parameters: curve, type, parameter,
      second, error, event

Words:
  branch          the orbits that one orbit becomes as the parameter
                  varies
  fold            a multiplier passes 1: the branch turns back
  flip            a multiplier passes -1: an orbit of twice the period
                  begins
  Neimark-Sacker  a pair of complex multipliers passes size 1
  grazing         a phase of the orbit appears or vanishes; of a SYSTEM
                  a guard is touched
  corner          two guards of a SYSTEM are crossed at once
  multiplier      factor by which a small deviation from an orbit grows
                  in one turn; below 1 in size: stable";

pub(super) const SWEEP: &str = "\
Examples:
  percuss sweep run --plan drift.toml --out drift
      all shards on this machine
  percuss sweep merge --plan drift.toml --out drift --output drift.npz
      one file of arrays

Words:
  plan   a TOML file: the verb, its flags, its SYSTEM if it has one,
         what varies, and the number of shards
  shard  one part of a sweep, which any machine may compute; the result
         does not depend on their number";

pub(super) const SWEEP_RUN: &str = "\
Example:
  percuss sweep run --plan drift.toml --out drift --shard 2/4
      the third of four shards

Words:
  shard  one part of a sweep, which any machine may compute; the result
         does not depend on their number";

pub(super) const SWEEP_STATUS: &str = "\
Example:
  percuss sweep status --plan drift.toml --out drift --format table
      a table for reading

Words:
  shard    one part of a sweep, which any machine may compute; the
           result does not depend on their number
  damaged  truncated, altered or of another sweep: computed again by
           run";

pub(super) const SWEEP_MERGE: &str = "\
Example:
  percuss sweep merge --plan drift.toml --out drift --output drift.npz
      exit code 1, and no file, where a shard is missing

Words:
  shard  one part of a sweep, which any machine may compute; the result
         does not depend on their number";

pub(super) const REPRODUCE: &str = "\
Examples:
  percuss reproduce --only figure-2 --out paper
      one figure
  percuss reproduce --only figure-5 --out paper
      another

Words:
  claim           a number or statement of the paper, with what percuss
                  computes and the verdict
  differs         the computation contradicts the claim
  not-determined  the paper does not say enough to decide";

pub(super) const BENCH: &str = "\
Examples:
  percuss bench -e '^ode_solvers-dopri5$' -c '^small-b$' --rounds 1
      one engine on one case
  percuss bench -e '^ode_solvers-dopri5$' -c '^small-b$' \\
      --rounds 1 --out bench
      with figures and pictures in a folder

Words:
  round    all engines once, one after the other, so that a slow moment
           of the machine meets all
  ratio    time over the exact solver's time in the same round, the
           median over rounds
  floor    time of one sine, cosine and exponential that waits for the
           last one
  harness  the share of a time that percuss itself takes";

pub(super) const BENCH_RECORD: &str = "\
Example:
  percuss bench record --history history.jsonl --rounds 1
      a quick one, into a file of your own

Words:
  history  a file with one row per workload and version";

pub(super) const BENCH_COMPARE: &str = "\
Example:
  percuss bench compare ./percuss-old ./percuss-new
      two binaries, interleaved

Words:
  workload  a run that is timed, such as a case of the oscillator";

pub(super) const BENCH_HISTORY: &str = "\
Example:
  percuss bench history --history history.jsonl --output history.svg";

pub(super) const COMPLETIONS: &str = "\
Examples:
  percuss completions bash \\
      > ~/.local/share/bash-completion/completions/percuss
  percuss completions zsh > ~/.zfunc/_percuss
  percuss completions fish > ~/.config/fish/completions/percuss.fish
  percuss completions powershell >> $PROFILE";

pub(super) const MAN: &str = "\
Example:
  percuss man --out man1";
