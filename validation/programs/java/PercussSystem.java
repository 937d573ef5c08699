import com.google.gson.Gson;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;

/** A system's equations, as a request brings them: what is read has fields of the same names. */
final class PercussSystem {
    /** Displacements of so many roundings are none: those of thousands of steps add up. */
    private static final double ROUNDING = 1024 * Math.ulp(1.0);

    double omega, phi;
    List<Mode> modes;

    /** A mode: z' = A z + c + B (cos theta, sin theta). A row is over (z, cos theta, sin theta,
     *  1). */
    static final class Mode {
        double[][] A, B;
        double[] c;
        List<Event> events;
        /** The matrix M of w' = M w, with w = (z, cos theta, sin theta, 1). */
        transient double[][] wide;
    }

    /** An event of a mode; without successors it is only counted. */
    static final class Event {
        double[] guard;
        String direction;
        double[][] reset;
        List<Successor> successors;

        int sign() {
            return direction.equals("rising") ? 1 : direction.equals("falling") ? -1 : 0;
        }

        boolean ends() {
            return !successors.isEmpty();
        }
    }

    /** A mode that may follow an event. */
    static final class Successor {
        double[] when;
        int mode;
    }

    /** The order of the first derivative that is not zero, 0 where the value itself is not, and its
     *  sign; the order is -1 where all are zero. */
    record Leading(int order, int sign) {}

    /** What is known of a mode where it begins: the first event that ends it at once, or -1, and
     *  the guards that are zero there. */
    record Entry(int fires, Map<Integer, Leading> zeros) {}

    static PercussSystem read(Gson gson, com.google.gson.JsonElement wire) {
        PercussSystem system = gson.fromJson(wire, PercussSystem.class);
        for (Mode mode : system.modes) {
            int size = mode.c.length;
            mode.wide = new double[size + 3][size + 3];
            for (int i = 0; i < size; i++) {
                System.arraycopy(mode.A[i], 0, mode.wide[i], 0, size);
                System.arraycopy(mode.B[i], 0, mode.wide[i], size, 2);
                mode.wide[i][size + 2] = mode.c[i];
            }
            mode.wide[size][size + 1] = -system.omega;
            mode.wide[size + 1][size] = system.omega;
        }
        return system;
    }

    double[] wide(double t, double[] z) {
        double[] w = java.util.Arrays.copyOf(z, z.length + 3);
        double theta = omega * t + phi;
        w[z.length] = Math.cos(theta);
        w[z.length + 1] = Math.sin(theta);
        w[z.length + 2] = 1;
        return w;
    }

    static double dot(double[] row, double[] w) {
        double sum = 0;
        for (int i = 0; i < row.length; i++) sum += row[i] * w[i];
        return sum;
    }

    private static double[] times(double[] row, double[][] matrix) {
        double[] product = new double[row.length];
        for (int i = 0; i < row.length; i++)
            for (int j = 0; j < row.length; j++) product[j] += row[i] * matrix[i][j];
        return product;
    }

    /** A row before an event, of one that is taken after it. */
    private static double[] before(double[] row, Event passed) {
        if (passed.reset == null) return row;
        double[] product = new double[row.length];
        int size = row.length - 3;
        System.arraycopy(row, size, product, size, 3);
        for (int i = 0; i < size; i++)
            for (int j = 0; j < row.length; j++) product[j] += row[i] * passed.reset[i][j];
        return product;
    }

    /** Whether a row is a multiple of another one, of 0 at the least. */
    private static boolean isMultiple(double[] row, double[] of) {
        double size = dot(of, of), along = dot(row, of), apart = 0;
        for (int i = 0; i < row.length; i++) {
            double rest = row[i] * size - of[i] * along;
            apart += rest * rest;
        }
        return Math.sqrt(apart) <= 1e-12 * size * Math.sqrt(dot(row, row));
    }

    /** The first derivative of row . w along a mode that is not zero. What is a multiple of the
     *  guard that was passed, if one was, is zero there, whatever rounding says. */
    Leading leading(double[] row, int mode, double t, double[] z, Event passed) {
        double[] w = wide(t, z);
        for (int order = 0; order < w.length; order++) {
            boolean known = passed != null && isMultiple(before(row, passed), passed.guard);
            double value = dot(row, w), size = 0;
            for (int i = 0; i < w.length; i++) size += Math.abs(row[i] * w[i]);
            if (!known && Math.abs(value) > ROUNDING * size)
                return new Leading(order, (int) Math.signum(value));
            row = times(row, modes.get(mode).wide);
        }
        return new Leading(-1, 0);
    }

    /** What is known of a mode where it begins, after an event or none. */
    Entry entry(int mode, double t, double[] z, Event passed) {
        int fires = -1;
        Map<Integer, Leading> zeros = new TreeMap<>();
        List<Event> events = modes.get(mode).events;
        for (int place = 0; place < events.size(); place++) {
            Leading leading = leading(events.get(place).guard, mode, t, z, passed);
            if (events.get(place).ends() && leading.sign() > 0 && fires < 0) fires = place;
            if (leading.order() != 0) zeros.put(place, leading);
        }
        return new Entry(fires, zeros);
    }

    /** The state after an event. */
    double[] after(Event event, double t, double[] z) {
        if (event.reset == null) return z.clone();
        double[] w = wide(t, z), after = new double[z.length];
        for (int i = 0; i < z.length; i++) after[i] = dot(event.reset[i], w);
        return after;
    }

    /** The mode that follows an event, for the state after it: by the signs of conditions alone,
     *  zero or not, or by the first derivatives that are not zero. */
    int follows(Event event, double t, double[] after, boolean plainly) {
        double[] w = wide(t, after);
        for (Successor next : event.successors) {
            if (next.when == null) return next.mode;
            boolean holds = plainly
                    ? dot(next.when, w) > 0
                    : leading(next.when, next.mode, t, after, event).sign() > 0;
            if (holds) return next.mode;
        }
        throw new IllegalStateException("no mode follows");
    }
}
