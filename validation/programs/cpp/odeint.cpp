// Boost.Odeint, run by percuss: its methods with dense output. It locates no events itself.
//
// `METHOD-default` is the documentation's find_crossing.cpp: steps until a condition holds at the
// end of one, then bisection on the dense output to 1e-6, the tolerances set, and nothing else.
// `METHOD` is what an expert adds:
//
// - Bisection goes on until rounding ends it.
// - Steps are at most an eighth of a forcing period and of a turn.
// - Of all guards that have risen in a step the first counts.
// - A guard that is zero where a mode begins has the sign that it has just after it, until it has
//   moved away by more than the tolerance hides.
// - What follows an event is told by the first derivative that is not zero.

#include "../c/percuss_program.h"

#include <boost/numeric/odeint.hpp>
#include <boost/numeric/ublas/matrix.hpp>
#include <boost/numeric/ublas/vector.hpp>
#include <boost/version.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace odeint = boost::numeric::odeint;

namespace ublas = boost::numeric::ublas;

// What rosenbrock4 takes.
using State = ublas::vector<double>;
using Matrix = ublas::matrix<double>;

constexpr double LONGEST_STEP = 0.125;
constexpr double DOCUMENTED_PRECISION = 1e-6;

// The methods: the type that steps, how it is made, and what it takes for a step.
struct Dopri5 {
    using Method = odeint::runge_kutta_dopri5<State>;
    using Dense = odeint::result_of::make_dense_output<Method>::type;
    static Dense make(const percuss_course &course, double longest) {
        return odeint::make_dense_output(course.absolute, course.relative, longest, Method());
    }
    template <class Rates, class Jacobian>
    static void step(Dense &dense, Rates rates, Jacobian) { dense.do_step(rates); }
};

struct BulirschStoer {
    using Dense = odeint::bulirsch_stoer_dense_out<State>;
    static Dense make(const percuss_course &course, double longest) {
        return Dense(course.absolute, course.relative, 1.0, 1.0, longest);
    }
    template <class Rates, class Jacobian>
    static void step(Dense &dense, Rates rates, Jacobian) { dense.do_step(rates); }
};

struct Rosenbrock4 {
    using Method = odeint::rosenbrock4<double>;
    using Dense = odeint::result_of::make_dense_output<Method>::type;
    static Dense make(const percuss_course &course, double longest) {
        return odeint::make_dense_output(course.absolute, course.relative, longest, Method());
    }
    template <class Rates, class Jacobian>
    static void step(Dense &dense, Rates rates, Jacobian jacobian) {
        dense.do_step(std::make_pair(rates, jacobian));
    }
};

// A crossing inside a step.
struct Crossing {
    double t;
    int event;
};

template <class Method> class Run {
  public:
    Run(percuss_course &course, bool is_default) : course(course), is_default(is_default) {}

    void operator()() {
        const percuss_event *passed = nullptr;
        while (percuss_goes_on(&course)) {
            const percuss_mode &mode = course.modes[course.mode];
            if (!is_default) entry = percuss_enter(&course, passed);
            int ends = is_default ? -1 : entry.fires;
            if (ends >= 0) {
                percuss_pass(&course, course.t, ends, course.z, false);
            } else {
                ends = stretch();
            }
            passed = ends < 0 ? nullptr : &mode.events[ends];
        }
    }

  private:
    using Dense = typename Method::Dense;

    percuss_course &course;
    bool is_default;
    percuss_entry entry{};

    double guard(int event, double t, const State &z) const {
        return is_default ? percuss_guard(&course, event, t, &z[0])
                          : percuss_guard_after(&course, &entry, event, t, &z[0]);
    }

    // Whether a guard has crossed zero between two states in the direction that counts.
    bool has_crossed(int event, double before, double after) const {
        int sign = course.modes[course.mode].events[event].sign;
        bool rises = before < 0 && after >= 0, falls = before > 0 && after <= 0;
        // By default a condition holds or does not.
        if (is_default && sign > 0 && course.modes[course.mode].events[event].successor_count)
            return after > 0;
        return (sign >= 0 && rises) || (sign <= 0 && falls);
    }

    // Where a guard crosses zero in the last step, by bisection.
    double bisected(Dense &stepper, int event, double left, double right, double before) const {
        double precision = is_default ? DOCUMENTED_PRECISION : 0.0;
        State z(course.size);
        while (right - left > precision) {
            double middle = 0.5 * (left + right);
            if (middle <= left || middle >= right) break;
            stepper.calc_state(middle, z);
            (has_crossed(event, before, guard(event, middle, z)) ? right : left) = middle;
        }
        return is_default ? 0.5 * (left + right) : right;
    }

    // The crossings in the last step, in the order of their times.
    std::vector<Crossing> crossings(Dense &stepper, const std::vector<double> &before) const {
        std::vector<Crossing> found;
        for (int event = 0; event < static_cast<int>(before.size()); event++) {
            double after = guard(event, stepper.current_time(), stepper.current_state());
            if (!has_crossed(event, before[event], after)) continue;
            double left = stepper.previous_time(), right = stepper.current_time();
            found.push_back({bisected(stepper, event, left, right, before[event]), event});
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const Crossing &a, const Crossing &b) { return a.t < b.t; });
        return found;
    }

    void sample(Dense &stepper, double until) {
        double time;
        State z(course.size);
        while (percuss_due(&course, until, &time)) {
            stepper.calc_state(time, z);
            percuss_sample(&course, &z[0]);
        }
    }

    // Takes over a step: what is counted in it, and the event that ends the mode, or -1.
    int take(Dense &stepper, const std::vector<double> &before, double end) {
        const percuss_mode &mode = course.modes[course.mode];
        State z(course.size);
        for (const Crossing &crossing : crossings(stepper, before)) {
            if (crossing.t > end) break;
            stepper.calc_state(crossing.t, z);
            if (mode.events[crossing.event].successor_count) {
                sample(stepper, std::nextafter(crossing.t, 0.0));
                percuss_pass(&course, crossing.t, crossing.event, &z[0], is_default);
                return crossing.event;
            }
            percuss_count(&course, crossing.t, crossing.event, &z[0]);
        }
        sample(stepper, std::min(end, stepper.current_time()));
        return -1;
    }

    // Runs one mode to its end, or to the horizon; returns the event that ended it, or -1.
    int stretch() {
        // Without a longest step it is 0, which is none.
        double longest = is_default ? 0.0 : LONGEST_STEP * std::min(course.period, course.turn);
        Dense stepper = Method::make(course, longest);
        auto rates = [this](const State &z, State &out, double t) {
            if (!percuss_rates(&course, t, &z[0], &out[0]))
                throw std::runtime_error("no more right-hand sides");
        };
        auto jacobian = [this](const State &, Matrix &out, double t, State &slope) {
            percuss_jacobian(&course, t, &out(0, 0), &slope[0]);
        };
        State z(course.size);
        std::copy(course.z, course.z + course.size, z.begin());
        double first = std::min(1e-3 * course.period, course.span - course.t);
        stepper.initialize(z, course.t, first);
        std::vector<double> before = values(course.t, z);
        while (stepper.current_time() < course.span) {
            Method::step(stepper, rates, jacobian);
            course.steps++;
            int ends = take(stepper, before, course.span);
            if (ends >= 0 || course.failure[0]) return ends;
            const State &now = stepper.current_state();
            if (!is_default) percuss_move_on(&course, &entry, stepper.current_time(), &now[0]);
            before = values(stepper.current_time(), now);
        }
        stepper.calc_state(course.span, z);
        course.t = course.span;
        std::copy(z.begin(), z.end(), course.z);
        return -1;
    }

    std::vector<double> values(double t, const State &z) const {
        std::vector<double> values(course.modes[course.mode].event_count);
        for (size_t event = 0; event < values.size(); event++)
            values[event] = guard(static_cast<int>(event), t, z);
        return values;
    }
};

template <class Method> static void run(percuss_course *course, bool is_default) {
    try {
        Run<Method>{*course, is_default}();
    } catch (const std::exception &why) {
        percuss_fail(course, "%s", why.what());
    }
}

static void make(percuss_course *course) {
    std::string name = course->setup;
    size_t suffix = name.find("-default");
    bool is_default = suffix != std::string::npos;
    name = name.substr(0, suffix);
    if (name == "dopri5") run<Dopri5>(course, is_default);
    if (name == "bulirsch-stoer") run<BulirschStoer>(course, is_default);
    if (name == "rosenbrock4") run<Rosenbrock4>(course, is_default);
}

static std::string set_up(const std::string &name, const std::string &method,
                          const std::string &of_class, const std::string &order) {
    return "{\"name\":\"" + name + "\",\"method\":\"" + method + "\",\"class\":\"" + of_class +
           "\",\"order\":" + order +
           ",\"events\":\"program\",\"dense_output\":true,\"stepping\":\"adaptive\"}";
}

int main() {
    std::string version = BOOST_LIB_VERSION, setups;
    std::replace(version.begin(), version.end(), '_', '.');
    for (const std::string suffix : {"", "-default"}) {
        setups += setups.empty() ? "[" : ",";
        const std::string dopri5 = "Runge-Kutta 5(4) of Dormand and Prince";
        setups += set_up("dopri5" + suffix, dopri5, "explicit", "5") + ",";
        setups += set_up("bulirsch-stoer" + suffix, "Bulirsch-Stoer", "explicit", "null") + ",";
        setups += set_up("rosenbrock4" + suffix, "Rosenbrock 4(3)", "implicit", "4");
    }
    return percuss_serve("boost.odeint", version.c_str(), "C++17, gcc " __VERSION__,
                         (setups + "]").c_str(), make);
}
