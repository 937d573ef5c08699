/* A run with an integrator of SUNDIALS, from mode to mode. */

#include "percuss_sundials.h"

#include <math.h>
#include <string.h>

/* Of all of SUNDIALS' integrators. */
static const int NORMAL = 1, ONE_STEP = 2, ROOT_RETURN = 2;

bool sundials_prepare(sundials_run *run, SUNContext context) {
    int size = run->course->size;
    run->z = N_VNew_Serial(size, context);
    run->at = N_VClone(run->z);
    run->matrix = SUNDenseMatrix(size, size, context);
    run->linear = SUNLinSol_Dense(run->z, run->matrix, context);
    if (run->linear) memcpy(N_VGetArrayPointer(run->z), run->course->z, size * sizeof(double));
    return run->linear != NULL;
}

void sundials_free(sundials_run *run) {
    SUNLinSolFree(run->linear);
    SUNMatDestroy(run->matrix);
    N_VDestroy(run->at);
    N_VDestroy(run->z);
}

int sundials_rates(realtype t, N_Vector z, N_Vector out, void *run) {
    percuss_course *course = ((sundials_run *)run)->course;
    return percuss_rates(course, t, N_VGetArrayPointer(z), N_VGetArrayPointer(out)) ? 0 : -1;
}

int sundials_jacobian(realtype t, N_Vector z, N_Vector fz, SUNMatrix out, void *run, N_Vector a,
                      N_Vector b, N_Vector c) {
    (void)t, (void)z, (void)fz, (void)a, (void)b, (void)c;
    const percuss_course *course = ((sundials_run *)run)->course;
    for (int i = 0; i < course->size; i++)
        for (int j = 0; j < course->size; j++)
            SM_ELEMENT_D(out, i, j) = course->modes[course->mode].matrix[i][j];
    return 0;
}

double sundials_longest_step(const percuss_course *course) {
    return LONGEST_STEP * fmin(course->period, course->turn);
}

static int guards(realtype t, N_Vector z, realtype *out, void *data) {
    const sundials_run *run = data;
    const double *values = N_VGetArrayPointer(z);
    for (int i = 0; i < run->course->modes[run->course->mode].event_count; i++)
        out[i] = run->is_default ? percuss_guard(run->course, i, t, values)
                                 : percuss_guard_after(run->course, &run->entry, i, t, values);
    return 0;
}

/* Begins a mode. */
static int begin(sundials_run *run) {
    percuss_course *course = run->course;
    const percuss_mode *mode = &course->modes[course->mode];
    memcpy(N_VGetArrayPointer(run->z), course->z, course->size * sizeof *course->z);
    int flag = run->calls->begin(run->memory, course->t, run->z);
    if (flag >= 0) flag = run->calls->root_init(run->memory, mode->event_count, guards);
    if (flag >= 0 && !run->is_default && mode->event_count > 0) {
        int directions[PERCUSS_EVENTS];
        for (int i = 0; i < mode->event_count; i++) directions[i] = mode->events[i].sign;
        flag = run->calls->set_root_direction(run->memory, directions);
    }
    if (flag >= 0) flag = run->calls->set_stop_time(run->memory, course->span);
    bool has_names = course->name_count && run->calls->begin_sensitivities;
    if (flag >= 0 && has_names) flag = run->calls->begin_sensitivities(run);
    return flag;
}

/* Takes the samples up to a time, inside the last step. */
static void sample(sundials_run *run, double until) {
    double time;
    while (percuss_due(run->course, until, &time)) {
        if (run->calls->get_dky(run->memory, time, 0, run->at) < 0)
            percuss_fail(run->course, "there is no dense output at %g", time);
        percuss_sample(run->course, N_VGetArrayPointer(run->at));
        if (run->course->failure[0]) return;
    }
}

/* Reports the roots that were found: those that are only counted, then the first that ends the
 * mode, whose place is returned; -1 where the mode goes on. */
static int roots(sundials_run *run, double t) {
    percuss_course *course = run->course;
    const percuss_mode *mode = &course->modes[course->mode];
    int found[PERCUSS_EVENTS], ends = -1;
    run->calls->get_root_info(run->memory, found);
    for (int i = mode->event_count - 1; i >= 0; i--) {
        int sign = mode->events[i].sign;
        if (!found[i] || (sign && sign != found[i])) continue;
        if (mode->events[i].successor_count) ends = i;
    }
    for (int i = 0; i < mode->event_count; i++) {
        int sign = mode->events[i].sign;
        if (!found[i] || (sign && sign != found[i]) || mode->events[i].successor_count) continue;
        percuss_count(course, t, i, N_VGetArrayPointer(run->z));
    }
    return ends;
}

static void count(sundials_run *run) {
    long steps = 0, jacobians = 0, iterations = 0;
    run->calls->get_steps(run->memory, &steps);
    if (run->is_implicit) {
        run->calls->get_jacobians(run->memory, &jacobians);
        run->calls->get_iterations(run->memory, &iterations);
    }
    run->course->steps += steps;
    run->course->jacobians += jacobians;
    run->course->linear_solves += iterations;
}

/* Runs one mode to its end, or to the horizon; returns the event that ended it, or -1. */
static int stretch(sundials_run *run) {
    percuss_course *course = run->course;
    int flag = begin(run), ends = -1;
    double t = course->t, time;
    while (flag >= 0 && t < course->span && ends < 0 && !course->failure[0]) {
        /* By default the caller goes from output to output. */
        double next = percuss_due(course, course->span, &time) ? time : course->span;
        if (run->is_default && next <= t) {
            percuss_sample(course, N_VGetArrayPointer(run->z));
            continue;
        }
        flag = run->calls->step(run->memory, next, run->z, &t, run->is_default ? NORMAL : ONE_STEP);
        if (flag < 0) break;
        bool is_asked = run->sensitivities && (flag == ROOT_RETURN || t >= course->span);
        if (is_asked && run->calls->take_sensitivities(run) < 0)
            percuss_fail(course, "there are no sensitivities at %g", t);
        sample(run, flag == ROOT_RETURN ? nextafter(t, 0.0) : t);
        if (flag == ROOT_RETURN) ends = roots(run, t);
        percuss_move_on(course, &run->entry, t, N_VGetArrayPointer(run->z));
    }
    if (flag < 0) percuss_fail(course, "%s", run->calls->get_name(flag));
    count(run);
    if (ends < 0) {
        course->t = course->span;
        memcpy(course->z, N_VGetArrayPointer(run->z), course->size * sizeof *course->z);
    } else {
        percuss_pass(course, t, ends, N_VGetArrayPointer(run->z), run->is_default);
    }
    return ends;
}

void sundials_make(sundials_run *run) {
    percuss_course *course = run->course;
    const percuss_event *passed = NULL;
    while (percuss_goes_on(course)) {
        const percuss_mode *mode = &course->modes[course->mode];
        int ends;
        if (!run->is_default) run->entry = percuss_enter(course, passed);
        if (!run->is_default && run->entry.fires >= 0) {
            ends = run->entry.fires;
            percuss_pass(course, course->t, ends, course->z, false);
        } else {
            ends = stretch(run);
        }
        passed = ends < 0 ? NULL : &mode->events[ends];
    }
}
