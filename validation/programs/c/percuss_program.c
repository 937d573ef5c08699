/* The equations and the course of a run; what is read and written is in percuss_wire.c. */

#define _POSIX_C_SOURCE 200809L
#include "percuss_program.h"
#include "percuss_wire.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* Displacements of so many roundings are none: those of thousands of steps add up. */
static const double ROUNDING = 1024 * DBL_EPSILON;
/* How much of a guard that was zero where its mode begins the first steps may hide, in tolerances:
 * of a simple zero, which it leaves at once, and of a multiple one, which it leaves slowly. */
static const double SIMPLE_ZERO_TOLERANCES = 0.1, MULTIPLE_ZERO_TOLERANCES = 10;
/* So many events in one instant end a run. */
static const int MAX_SIMULTANEOUS_EVENTS = 64;
static const double INSTANT_TOLERANCE = 8 * DBL_EPSILON;

void percuss_wide(const percuss_course *course, double t, const double *z, double *w) {
    double theta = course->omega * t + course->phi;
    memcpy(w, z, course->size * sizeof *w);
    w[course->size] = cos(theta);
    w[course->size + 1] = sin(theta);
    w[course->size + 2] = 1.0;
}

double percuss_dot(const percuss_course *course, const double *row, const double *w) {
    double sum = 0.0;
    for (int i = 0; i < course->size + 3; i++) sum += row[i] * w[i];
    return sum;
}

bool percuss_rates(percuss_course *course, double t, const double *z, double *rates) {
    percuss_row w;
    percuss_wide(course, t, z, w);
    for (int i = 0; i < course->size; i++)
        rates[i] = percuss_dot(course, course->modes[course->mode].matrix[i], w);
    course->rhs++;
    struct percuss_private *own = course->own;
    if (course->rhs + course->jacobians > own->most_calls)
        percuss_give_up(course, "too many calls");
    else if (course->rhs % 4096 == 0 && percuss_now() > own->deadline)
        percuss_give_up(course, "the time is over");
    return !course->failure[0];
}

void percuss_jacobian(percuss_course *course, double t, double *jacobian, double *slope) {
    const percuss_mode *mode = &course->modes[course->mode];
    int size = course->size;
    double theta = course->omega * t + course->phi;
    course->jacobians++;
    for (int i = 0; i < size; i++) {
        for (int j = 0; j < size; j++) jacobian[i * size + j] = mode->matrix[i][j];
        slope[i] = course->omega * (mode->matrix[i][size + 1] * cos(theta) -
                                    mode->matrix[i][size] * sin(theta));
    }
}

double percuss_guard(const percuss_course *course, int event, double t, const double *z) {
    percuss_row w;
    percuss_wide(course, t, z, w);
    return percuss_dot(course, course->modes[course->mode].events[event].guard, w);
}

/* What the first steps may hide of a guard that was zero where its mode begins. */
static double hidden(const percuss_course *course, int event, int order, const double *z) {
    const double *guard = course->modes[course->mode].events[event].guard;
    double errors = 0.0;
    for (int i = 0; i < course->size; i++)
        errors += fabs(guard[i]) * (course->absolute + course->relative * fabs(z[i]));
    return (order > 1 ? MULTIPLE_ZERO_TOLERANCES : SIMPLE_ZERO_TOLERANCES) * errors;
}

double percuss_guard_after(const percuss_course *course, const percuss_entry *entry, int event,
                           double t, const double *z) {
    int order = entry->order[event], sign = entry->sign[event];
    if (order > 0 && sign == 0) return -1.0;
    double value = percuss_guard(course, event, t, z);
    bool is_hidden = order > 0 && fabs(value) <= hidden(course, event, order, z);
    return is_hidden ? sign * 1e-300 : value;
}

void percuss_move_on(const percuss_course *course, percuss_entry *entry, double t,
                     const double *z) {
    for (int i = 0; i < course->modes[course->mode].event_count; i++)
        if (entry->sign[i] != 0 &&
            fabs(percuss_guard(course, i, t, z)) > hidden(course, i, entry->order[i], z))
            entry->order[i] = 0;
}

/* A row times a matrix. */
static void times(const percuss_course *course, const double *row, percuss_row *matrix,
                  double *product) {
    percuss_row sum = {0};
    for (int i = 0; i < course->size + 3; i++)
        for (int j = 0; j < course->size + 3; j++) sum[j] += row[i] * matrix[i][j];
    memcpy(product, sum, sizeof sum);
}

/* Whether a row is a multiple of another one, of 0 at the least. */
static bool is_multiple(const percuss_course *course, const double *row, const double *of) {
    double size = percuss_dot(course, of, of), along = percuss_dot(course, row, of), apart = 0.0;
    for (int i = 0; i < course->size + 3; i++) {
        double rest = row[i] * size - of[i] * along;
        apart += rest * rest;
    }
    return sqrt(apart) <= 1e-12 * size * sqrt(percuss_dot(course, row, row));
}

/* The sign of the first derivative of row . w along a mode that is not zero, and its order. What is
 * a multiple of the guard that was passed is zero there, whatever rounding says. */
static int leading(const percuss_course *course, const double *row, int mode, double t,
                   const double *z, const percuss_event *passed, int *order) {
    percuss_row w, derivative, before;
    percuss_wide(course, t, z, w);
    memcpy(derivative, row, sizeof derivative);
    for (*order = 0; *order < course->size + 3; ++*order) {
        bool known = false;
        if (passed) {
            times(course, derivative, (percuss_row *)passed->reset, before);
            known = is_multiple(course, before, passed->guard);
        }
        double value = percuss_dot(course, derivative, w), size = 0.0;
        for (int i = 0; i < course->size + 3; i++) size += fabs(derivative[i] * w[i]);
        if (!known && fabs(value) > ROUNDING * size) return value > 0 ? 1 : -1;
        times(course, derivative, course->modes[mode].matrix, derivative);
    }
    return 0;
}

percuss_entry percuss_enter(const percuss_course *course, const percuss_event *passed) {
    percuss_entry entry = {.fires = -1};
    const percuss_mode *mode = &course->modes[course->mode];
    for (int event = 0; event < mode->event_count; event++) {
        int order;
        const double *guard = mode->events[event].guard;
        int sign = leading(course, guard, course->mode, course->t, course->z, passed, &order);
        if (mode->events[event].successor_count && sign > 0 && entry.fires < 0) entry.fires = event;
        entry.order[event] = order;
        entry.sign[event] = sign;
    }
    return entry;
}

bool percuss_due(const percuss_course *course, double until, double *time) {
    if (course->sampled >= course->sample_count) return false;
    *time = course->samples[course->sampled];
    return *time <= until;
}

void percuss_count(percuss_course *course, double t, int event, const double *z) {
    percuss_report(course, t, event, course->mode, z, z);
    percuss_differentiate(course, t, event, z);
}

/* Whether a mode follows: by the sign of its condition, or after an event that was passed by the
 * first derivative of it that is not zero. */
static bool holds(const percuss_course *course, const percuss_successor *next, double t,
                  const double *after, const percuss_event *passed) {
    int order;
    if (!next->has_when) return true;
    if (!passed) return percuss_dot(course, next->when, after) > 0;
    return leading(course, next->when, next->mode, t, after, passed, &order) > 0;
}

void percuss_pass(percuss_course *course, double t, int event, const double *z, bool plainly) {
    if (course->backward) {
        course->t = t;
        memcpy(course->z, z, course->size * sizeof *z);
        course->ended = "leaves-domain";
        return;
    }
    const percuss_event *passed = &course->modes[course->mode].events[event];
    percuss_row w, after;
    percuss_wide(course, t, z, w);
    for (int i = 0; i < course->size + 3; i++) after[i] = percuss_dot(course, passed->reset[i], w);
    int follows = -1;
    for (int n = 0; n < passed->successor_count && follows < 0; n++)
        if (holds(course, &passed->successors[n], t, after, plainly ? NULL : passed))
            follows = passed->successors[n].mode;
    percuss_report(course, t, event, follows, z, after);
    percuss_differentiate(course, t, event, z);
    struct percuss_private *own = course->own;
    own->crowd = t - course->t <= INSTANT_TOLERANCE * t ? own->crowd + 1 : 1;
    course->t = t;
    course->mode = follows;
    memcpy(course->z, after, course->size * sizeof *after);
    if (own->crowd >= MAX_SIMULTANEOUS_EVENTS) course->ended = "no-progress";
}

bool percuss_goes_on(const percuss_course *course) {
    bool is_over = course->ended || course->failure[0];
    return !is_over && course->span - course->t > 2 * INSTANT_TOLERANCE * course->span;
}

void percuss_fail(percuss_course *course, const char *why, ...) {
    va_list rest;
    va_start(rest, why);
    if (!course->failure[0]) vsnprintf(course->failure, sizeof course->failure, why, rest);
    va_end(rest);
}

void percuss_give_up(percuss_course *course, const char *why) {
    if (course->failure[0]) return;
    percuss_fail(course, "%s", why);
    course->own->gave_up = true;
}

double percuss_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
