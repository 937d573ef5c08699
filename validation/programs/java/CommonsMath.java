import java.io.IOException;
import java.io.InputStream;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import java.util.Properties;
import org.apache.commons.math3.ode.AbstractIntegrator;
import org.apache.commons.math3.ode.FirstOrderDifferentialEquations;
import org.apache.commons.math3.ode.events.EventHandler;
import org.apache.commons.math3.ode.nonstiff.DormandPrince54Integrator;
import org.apache.commons.math3.ode.nonstiff.DormandPrince853Integrator;
import org.apache.commons.math3.ode.nonstiff.GraggBulirschStoerIntegrator;
import org.apache.commons.math3.ode.sampling.StepHandler;
import org.apache.commons.math3.ode.sampling.StepInterpolator;

/**
 * Apache Commons Math's integrators with its own event handlers, run by percuss.
 *
 * <p>{@code METHOD-default} is the user guide: the steps of its first integrator, 1e-8 to 100; for
 * each event a handler whose {@code g} is the guard and whose {@code eventOccurred} stops the run;
 * the tolerances, with that of an event's time among them; and nothing else. How often handlers
 * look has no default: once a step. {@code METHOD} is what an expert adds:
 *
 * <ul>
 *   <li>Steps are at most an eighth of a forcing period and of a turn, and guards are looked at
 *       eight times as often, inside of steps.
 *   <li>An event's time converges to rounding, and steps have no least length.
 *   <li>A guard that is zero where a mode begins has the sign that it has just after it, until it
 *       has moved away by more than the tolerance hides.
 *   <li>What follows an event is told by the first derivative that is not zero.
 * </ul>
 */
final class CommonsMath {
    private static final double MIN_STEP = 1e-8, MAX_STEP = 100;
    /** How often guards are looked at: by default once a step; in steps of the longest length. */
    private static final double DEFAULT_CHECK_TIME = Double.POSITIVE_INFINITY, CHECK_STEPS = 0.125;
    private static final int MAX_ITERATIONS = 100;
    /** Of a time, what is rounding. */
    private static final double ROUNDING = 8 * Math.ulp(1.0);

    private CommonsMath() {}

    private static AbstractIntegrator integrator(
            PercussCourse course, String name, boolean expert) {
        double least = expert ? 0 : MIN_STEP;
        double longest = expert ? course.longestStep() : MAX_STEP;
        double absolute = course.run.tolerance.absolute, relative = course.run.tolerance.relative;
        return switch (name) {
            case "dp54" -> new DormandPrince54Integrator(least, longest, absolute, relative);
            case "dp853" -> new DormandPrince853Integrator(least, longest, absolute, relative);
            default -> new GraggBulirschStoerIntegrator(least, longest, absolute, relative);
        };
    }

    /** The right-hand side in the mode of now. */
    private record Field(PercussCourse course) implements FirstOrderDifferentialEquations {
        @Override
        public int getDimension() {
            return course.z.length;
        }

        @Override
        public void computeDerivatives(double t, double[] z, double[] out) {
            course.rates(t, z, out);
        }
    }

    /** What a stretch has come to: the event that has stopped it, or -1. */
    private static final class Found {
        int place = -1;
        double time = Double.POSITIVE_INFINITY;
    }

    /** An event as the library takes it: it stops the run, or it is counted. */
    private record Handler(PercussCourse course, int place, PercussCourse.Guard guard, Found found)
            implements EventHandler {
        @Override
        public void init(double t0, double[] z, double t) {}

        @Override
        public double g(double t, double[] z) {
            return guard.at(t, z);
        }

        @Override
        public Action eventOccurred(double t, double[] z, boolean increasing) {
            PercussSystem.Event event = course.now().events.get(place);
            if (event.sign() != 0 && (event.sign() > 0) != increasing) return Action.CONTINUE;
            if (!event.ends()) {
                course.count(t, place, z);
                return Action.CONTINUE;
            }
            found.place = place;
            found.time = t;
            return Action.STOP;
        }

        @Override
        public void resetState(double t, double[] z) {}
    }

    /** Takes the samples of a step, up to an event that has stopped it. */
    private record Samples(PercussCourse course, Found found) implements StepHandler {
        @Override
        public void init(double t0, double[] z, double t) {}

        @Override
        public void handleStep(StepInterpolator step, boolean isLast) {
            course.steps++;
            double end = step.getCurrentTime();
            while (course.due() <= end && course.due() < Math.min(found.time, course.run.span)) {
                step.setInterpolatedTime(course.due());
                course.sample(step.getInterpolatedState());
            }
        }
    }

    private static int stretch(
            PercussCourse course,
            String name,
            boolean expert,
            Map<Integer, PercussSystem.Leading> zeros) {
        Found found = new Found();
        AbstractIntegrator integrator = integrator(course, name, expert);
        double every = expert ? CHECK_STEPS * course.longestStep() : DEFAULT_CHECK_TIME;
        double close = expert ? ROUNDING * course.run.span : course.run.tolerance.absolute;
        for (int place = 0; place < course.now().events.size(); place++) {
            Handler handler = new Handler(course, place, course.guard(place, zeros), found);
            integrator.addEventHandler(handler, every, close, MAX_ITERATIONS);
        }
        integrator.addStepHandler(new Samples(course, found));
        double[] z = new double[course.z.length];
        Field field = new Field(course);
        double t = integrator.integrate(field, course.t, course.z, course.run.span, z);
        if (found.place >= 0) {
            course.pass(t, found.place, z, !expert);
        } else {
            course.t = course.run.span;
            course.z = z;
        }
        return found.place;
    }

    private static void make(PercussCourse course) {
        String setup = course.run.setup, name = setup.replace("-default", "");
        if (name.equals(setup)) course.byExperts(zeros -> stretch(course, name, true, zeros));
        else course.byDefault(zeros -> stretch(course, name, false, zeros));
    }

    public static void main(String[] words) throws IOException {
        String[][] methods = {
            {"dp54", "Dormand-Prince 5(4)", "explicit", "5"},
            {"dp853", "Dormand-Prince 8(5,3)", "explicit", "8"},
            {"gbs", "Gragg-Bulirsch-Stoer", "explicit", null},
        };
        List<Map<String, Object>> setups = new ArrayList<>();
        for (String[] it : methods)
            for (String suffix : new String[] {"", "-default"}) {
                Integer order = it[3] == null ? null : Integer.valueOf(it[3]);
                setups.add(PercussProgram.setup(it[0] + suffix, it[1], it[2], order));
            }
        PercussProgram.serve("commons-math", version(), setups, CommonsMath::make);
    }

    /** The library's version, which its build leaves in its archive. */
    private static String version() throws IOException {
        Properties build = new Properties();
        try (InputStream in = AbstractIntegrator.class.getResourceAsStream(
                "/META-INF/maven/org.apache.commons/commons-math3/pom.properties")) {
            if (in != null) build.load(in);
        }
        return build.getProperty("version", "unknown");
    }
}
