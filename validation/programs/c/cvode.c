/* SUNDIALS CVODE with its own root finding, run by percuss.
 *
 * `bdf-default` is the first example of the documentation, cvRoberts_dns: BDF, a dense Jacobian,
 * root functions, the tolerances, and nothing else. `bdf` and `adams` are what an expert adds:
 *
 * - Root functions have directions; without them the caller looks at the signs that
 *   CVodeGetRootInfo gives, and each crossing in the other direction ends a call.
 * - Steps are at most an eighth of a forcing period and of a turn: roots are looked for by signs at
 *   the ends of steps.
 * - A guard that is zero where a mode begins has the sign that it has just after it, until it has
 *   moved away by more than the tolerance hides: CVODE's first steps are small, and what the
 *   corrector leaves is found as another root after each of them.
 * - What follows an event is told by the first derivative that is not zero.
 * - There is no limit on steps between outputs. */

#include "percuss_program.h"

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static const double LONGEST_STEP = 0.125;

typedef struct {
    percuss_course *course;
    percuss_entry entry;
    bool is_default, is_adams;
    void *memory;
    N_Vector z;
} solver;

static int rates(realtype t, N_Vector z, N_Vector out, void *data) {
    solver *self = data;
    return percuss_rates(self->course, t, N_VGetArrayPointer(z), N_VGetArrayPointer(out)) ? 0 : -1;
}

static int jacobian(realtype t, N_Vector z, N_Vector fz, SUNMatrix out, void *data, N_Vector a,
                    N_Vector b, N_Vector c) {
    (void)t, (void)z, (void)fz, (void)a, (void)b, (void)c;
    const percuss_course *course = ((solver *)data)->course;
    for (int i = 0; i < course->size; i++)
        for (int j = 0; j < course->size; j++)
            SM_ELEMENT_D(out, i, j) = course->modes[course->mode].matrix[i][j];
    return 0;
}

static int guards(realtype t, N_Vector z, realtype *out, void *data) {
    solver *self = data;
    const double *values = N_VGetArrayPointer(z);
    for (int i = 0; i < self->course->modes[self->course->mode].event_count; i++)
        out[i] = self->is_default
                     ? percuss_guard(self->course, i, t, values)
                     : percuss_guard_after(self->course, &self->entry, i, t, values);
    return 0;
}

/* Begins a mode. */
static int begin(solver *self) {
    percuss_course *course = self->course;
    const percuss_mode *mode = &course->modes[course->mode];
    memcpy(N_VGetArrayPointer(self->z), course->z, course->size * sizeof *course->z);
    int flag = CVodeReInit(self->memory, course->t, self->z);
    if (flag == CV_SUCCESS) flag = CVodeRootInit(self->memory, mode->event_count, guards);
    if (flag == CV_SUCCESS && !self->is_default && mode->event_count > 0) {
        int directions[PERCUSS_EVENTS];
        for (int i = 0; i < mode->event_count; i++) directions[i] = mode->events[i].sign;
        flag = CVodeSetRootDirection(self->memory, directions);
    }
    if (flag == CV_SUCCESS) flag = CVodeSetStopTime(self->memory, course->span);
    return flag;
}

/* Takes the samples up to a time, inside the last step. */
static void sample(solver *self, N_Vector at, double until) {
    double time;
    while (percuss_due(self->course, until, &time)) {
        if (CVodeGetDky(self->memory, time, 0, at) != CV_SUCCESS)
            percuss_fail(self->course, "CVodeGetDky fails at %g", time);
        percuss_sample(self->course, N_VGetArrayPointer(at));
        if (self->course->failure[0]) return;
    }
}

/* Reports the roots that were found: those that are only counted, then the first that ends the
 * mode, whose place is returned; -1 where the mode goes on. */
static int roots(solver *self, double t) {
    percuss_course *course = self->course;
    const percuss_mode *mode = &course->modes[course->mode];
    int found[PERCUSS_EVENTS], ends = -1;
    CVodeGetRootInfo(self->memory, found);
    for (int i = mode->event_count - 1; i >= 0; i--) {
        int sign = mode->events[i].sign;
        if (!found[i] || (sign && sign != found[i])) continue;
        if (mode->events[i].successor_count) ends = i;
    }
    for (int i = 0; i < mode->event_count; i++) {
        int sign = mode->events[i].sign;
        if (!found[i] || (sign && sign != found[i]) || mode->events[i].successor_count) continue;
        percuss_count(course, t, i, N_VGetArrayPointer(self->z));
    }
    return ends;
}

static void count(solver *self) {
    long steps = 0, jacobians = 0, iterations = 0;
    CVodeGetNumSteps(self->memory, &steps);
    if (!self->is_adams) {
        CVodeGetNumJacEvals(self->memory, &jacobians);
        CVodeGetNumNonlinSolvIters(self->memory, &iterations);
    }
    self->course->steps += steps;
    self->course->jacobians += jacobians;
    self->course->linear_solves += iterations;
}

/* Runs one mode to its end, or to the horizon; returns the event that ended it, or -1. */
static int stretch(solver *self, N_Vector at) {
    percuss_course *course = self->course;
    int flag = begin(self), ends = -1;
    double t = course->t, time;
    while (flag >= 0 && t < course->span && ends < 0 && !course->failure[0]) {
        /* By default the caller goes from output to output. */
        double next = percuss_due(course, course->span, &time) ? time : course->span;
        if (self->is_default && next <= t) {
            percuss_sample(course, N_VGetArrayPointer(self->z));
            continue;
        }
        flag = CVode(self->memory, next, self->z, &t, self->is_default ? CV_NORMAL : CV_ONE_STEP);
        if (flag < 0) break;
        sample(self, at, flag == CV_ROOT_RETURN ? nextafter(t, 0.0) : t);
        if (flag == CV_ROOT_RETURN) ends = roots(self, t);
        percuss_move_on(course, &self->entry, t, N_VGetArrayPointer(self->z));
    }
    if (flag < 0) percuss_fail(course, "CVode: %s", CVodeGetReturnFlagName(flag));
    count(self);
    if (ends < 0) {
        course->t = course->span;
        memcpy(course->z, N_VGetArrayPointer(self->z), course->size * sizeof *course->z);
    } else {
        percuss_pass(course, t, ends, N_VGetArrayPointer(self->z), self->is_default);
    }
    return ends;
}

static void run(solver *self, N_Vector at) {
    percuss_course *course = self->course;
    const percuss_event *passed = NULL;
    while (percuss_goes_on(course)) {
        const percuss_mode *mode = &course->modes[course->mode];
        int ends;
        if (!self->is_default) self->entry = percuss_enter(course, passed);
        if (!self->is_default && self->entry.fires >= 0) {
            ends = self->entry.fires;
            percuss_pass(course, course->t, ends, course->z, false);
        } else {
            ends = stretch(self, at);
        }
        passed = ends < 0 ? NULL : &mode->events[ends];
    }
}

static void make(percuss_course *course) {
    SUNContext context;
    if (SUNContext_Create(NULL, &context)) return percuss_fail(course, "no context");
    bool is_adams = !strcmp(course->setup, "adams");
    solver self = {.course = course, .is_adams = is_adams};
    self.is_default = !strcmp(course->setup, "bdf-default");
    self.z = N_VNew_Serial(course->size, context);
    N_Vector at = N_VClone(self.z);
    memcpy(N_VGetArrayPointer(self.z), course->z, course->size * sizeof *course->z);
    SUNMatrix matrix = SUNDenseMatrix(course->size, course->size, context);
    SUNLinearSolver linear = SUNLinSol_Dense(self.z, matrix, context);
    SUNNonlinearSolver fixed = SUNNonlinSol_FixedPoint(self.z, 0, context);
    self.memory = CVodeCreate(is_adams ? CV_ADAMS : CV_BDF, context);
    CVodeInit(self.memory, rates, course->t, self.z);
    CVodeSStolerances(self.memory, course->relative, course->absolute);
    CVodeSetUserData(self.memory, &self);
    CVodeSetErrFile(self.memory, stderr);
    if (is_adams) {
        CVodeSetNonlinearSolver(self.memory, fixed);
    } else {
        CVodeSetLinearSolver(self.memory, linear, matrix);
        CVodeSetJacFn(self.memory, jacobian);
    }
    if (!self.is_default) {
        CVodeSetMaxStep(self.memory, LONGEST_STEP * fmin(course->period, course->turn));
        CVodeSetMaxNumSteps(self.memory, -1);
    }
    run(&self, at);
    CVodeFree(&self.memory);
    SUNNonlinSolFree(fixed);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(at);
    N_VDestroy(self.z);
    SUNContext_Free(&context);
}

#define SET_UP(name, method)                                                                      \
    "{\"name\":\"" name "\",\"method\":\"" method "\",\"events\":\"library\","                     \
    "\"dense_output\":true,\"stepping\":\"adaptive\"}"

int main(void) {
    char version[32] = "unknown";
    SUNDIALSGetVersion(version, sizeof version);
    return percuss_serve("sundials", version, "C11, gcc " __VERSION__,
                         "[" SET_UP("bdf", "BDF of orders 1 to 5 in Nordsieck form") ","
                             SET_UP("adams", "Adams-Moulton of orders 1 to 12") ","
                             SET_UP("bdf-default", "BDF of orders 1 to 5 in Nordsieck form") "]",
                         make);
}
