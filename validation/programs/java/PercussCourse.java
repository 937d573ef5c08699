import com.google.gson.Gson;
import com.google.gson.JsonElement;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;

/** A run as it is made: what is asked for, its state, and what is reported of it. */
final class PercussCourse {
    /** How much of a guard that was zero where its mode begins the first steps may hide, in
     *  tolerances: of a simple zero, which it leaves at once, and of a multiple one, which it
     *  leaves slowly. */
    private static final double SIMPLE_ZERO_TOLERANCES = 0.1, MULTIPLE_ZERO_TOLERANCES = 10;
    /** So many events in one instant end a run, and so many stretches in so little of a run are one
     *  event that is found again and again. */
    private static final int MAX_SIMULTANEOUS_EVENTS = 64, MAX_STRETCHES = 200;
    private static final double INSTANT_TOLERANCE = 8 * Math.ulp(1.0), PROGRESS_TOLERANCE = 1e-9;

    /** What is asked for, by its names in a request. */
    static final class Run {
        String setup;
        JsonElement system;
        boolean backward;
        int mode;
        double[] state, samples;
        double span;
        Tolerance tolerance;
        Times times;
        Limits limits;
    }

    static final class Tolerance {
        double relative, absolute;
    }

    static final class Times {
        double period;
        Double turn;
    }

    static final class Limits {
        double calls, wall_s;
        int events;
    }

    /** An event as an answer reports it, with the states before and after its reset. */
    record Reported(double time, int event, int mode, double[] before, double[] state) {}

    /** How a run went beyond its limits. */
    static final class GaveUp extends RuntimeException {
        private static final long serialVersionUID = 1;

        GaveUp(String why) {
            super(why);
        }
    }

    /** A guard as a function. */
    interface Guard {
        double at(double t, double[] z);
    }

    final Run run;
    final PercussSystem system;
    double t;
    int mode;
    double[] z;
    long rhs, steps;
    private final List<Reported> events = new ArrayList<>();
    private final List<double[]> sampled = new ArrayList<>();
    private final long began = System.nanoTime();
    private String ended;
    private int crowd, stretches;
    private double progress;

    PercussCourse(Gson gson, JsonElement wire) {
        run = gson.fromJson(wire, Run.class);
        system = PercussSystem.read(gson, run.system);
        mode = run.mode;
        z = run.state;
        sampleHere();
    }

    PercussSystem.Mode now() {
        return system.modes.get(mode);
    }

    /** The right-hand side. */
    void rates(double t, double[] z, double[] out) {
        if (++rhs > run.limits.calls) throw new GaveUp("too many calls");
        if (rhs % 1024 == 0 && System.nanoTime() - began > 1e9 * run.limits.wall_s)
            throw new GaveUp("the time is over");
        double[] w = system.wide(t, z);
        for (int i = 0; i < z.length; i++) out[i] = PercussSystem.dot(now().wide[i], w);
    }

    /** The longest time that an expert allows between two looks at a guard: an eighth of a forcing
     *  period and of a turn. */
    double longestStep() {
        double turn = run.times.turn == null ? run.times.period : run.times.turn;
        return 0.125 * Math.min(run.times.period, turn);
    }

    /** The guard of an event. One that is zero where the mode begins has the sign that it has just
     *  after it, until it has moved away by more than the tolerance hides. */
    Guard guard(int place, Map<Integer, PercussSystem.Leading> zeros) {
        PercussSystem.Event event = now().events.get(place);
        PercussSystem.Leading zero = zeros.get(place);
        if (zero == null) return (t, z) -> PercussSystem.dot(event.guard, system.wide(t, z));
        if (zero.order() < 0) return (t, z) -> -1; // it stays zero
        double[] moved = {Double.POSITIVE_INFINITY};
        return (t, z) -> {
            double value = PercussSystem.dot(event.guard, system.wide(t, z));
            if (t < moved[0] && Math.abs(value) <= hidden(event, zero.order(), z))
                return zero.sign() * 1e-300;
            moved[0] = Math.min(t, moved[0]);
            return value;
        };
    }

    private double hidden(PercussSystem.Event event, int order, double[] z) {
        double errors = 0;
        for (int i = 0; i < z.length; i++)
            errors += Math.abs(event.guard[i])
                    * (run.tolerance.absolute + run.tolerance.relative * Math.abs(z[i]));
        return (order == 1 ? SIMPLE_ZERO_TOLERANCES : MULTIPLE_ZERO_TOLERANCES) * errors;
    }

    /** Runs a mode to the first event that ends it, whose place it returns, or to the horizon,
     *  which is -1. */
    interface Stretch {
        int run(Map<Integer, PercussSystem.Leading> zeros);
    }

    /** Runs from mode to mode as a documentation's example does. */
    void byDefault(Stretch stretch) {
        while (goesOn()) stretch.run(Map.of());
    }

    /** Runs from mode to mode, where events that follow at once are told by derivatives. */
    void byExperts(Stretch stretch) {
        PercussSystem.Event passed = null;
        while (goesOn()) {
            List<PercussSystem.Event> before = now().events;
            PercussSystem.Entry entry = system.entry(mode, t, z, passed);
            int place = entry.fires();
            if (place >= 0) pass(t, place, z, false);
            else place = stretch.run(new TreeMap<>(entry.zeros()));
            passed = place < 0 ? null : before.get(place);
        }
    }

    /** The next instant at which the state is wanted; infinity where there is none. */
    double due() {
        return sampled.size() < run.samples.length
                ? run.samples[sampled.size()]
                : Double.POSITIVE_INFINITY;
    }

    void sample(double[] z) {
        sampled.add(z.clone());
    }

    private void sampleHere() {
        while (due() <= t) sample(z);
    }

    /** Reports an event that is only counted. */
    void count(double t, int event, double[] z) {
        report(t, event, mode, z, z);
    }

    private void report(double t, int event, int mode, double[] before, double[] after) {
        if (events.size() >= run.limits.events) throw new GaveUp("too many events");
        events.add(new Reported(t, event, mode, before.clone(), after.clone()));
    }

    /** Goes through an event that ends its mode. */
    void pass(double time, int place, double[] state, boolean plainly) {
        if (run.backward) {
            t = time;
            z = state.clone();
            ended = "leaves-domain";
            return;
        }
        PercussSystem.Event event = now().events.get(place);
        double[] after = system.after(event, time, state);
        int follows = system.follows(event, time, after, plainly);
        report(time, place, follows, state, after);
        crowd = time - t <= INSTANT_TOLERANCE * time ? crowd + 1 : 1;
        t = time;
        mode = follows;
        z = after;
        if (crowd >= MAX_SIMULTANEOUS_EVENTS) ended = "no-progress";
    }

    /** Whether the run has not come to its end; asked once a stretch. */
    private boolean goesOn() {
        stretches++;
        if (t - progress > PROGRESS_TOLERANCE * run.span) {
            stretches = 0;
            progress = t;
        } else if (stretches > MAX_STRETCHES) {
            throw new IllegalStateException("events at " + t + " are found again and again");
        }
        boolean goes = ended == null && run.span - t > 2 * INSTANT_TOLERANCE * run.span;
        if (goes) sampleHere();
        return goes;
    }

    /** The answer, for a run that has taken so many nanoseconds. */
    Map<String, Object> answer(long took) {
        if (ended == null) {
            t = run.span;
            sampleHere();
        }
        Map<String, Object> answer = new TreeMap<>();
        answer.put("events", events);
        answer.put("samples", sampled);
        answer.put("end", z);
        answer.put("ended", ended == null ? "horizon" : ended);
        answer.put("ended_at", t);
        answer.put("work", Map.of("rhs", rhs, "steps", steps));
        answer.put("own_ns", took);
        return answer;
    }
}
