/* Programs that percuss runs as engines, for C: the protocol, and a system's equations.
 *
 * A program calls percuss_serve with what it can do and with a function that makes a run. The
 * protocol is described in docs/PROTOCOL.md. */

#ifndef PERCUSS_PROGRAM_H
#define PERCUSS_PROGRAM_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The most states of a system. */
#define PERCUSS_STATES 11
/* A row is over (z, cos theta, sin theta, 1). */
#define PERCUSS_WIDE (PERCUSS_STATES + 3)
/* The most events of a mode. */
#define PERCUSS_EVENTS 64

typedef double percuss_row[PERCUSS_WIDE];

typedef struct {
    bool has_when;
    percuss_row when;
    int mode;
} percuss_successor;

typedef struct {
    percuss_row guard;
    /* 1 where the guard rises, -1 where it falls, 0 for both. */
    int sign;
    percuss_row reset[PERCUSS_WIDE];
    /* None where the event is only counted. */
    percuss_successor *successors;
    int successor_count;
} percuss_event;

typedef struct {
    /* The matrix M of w' = M w, with w = (z, cos theta, sin theta, 1). */
    percuss_row matrix[PERCUSS_WIDE];
    percuss_event *events;
    int event_count;
} percuss_mode;

/* A name by which derivatives are asked for. */
typedef struct {
    char wrt[64];
    double value, omega, phi;
    /* The derivatives of the coefficients, each in its place. */
    percuss_mode *modes;
    /* The derivatives of the time of the last event and of the state after it, at that time. */
    double time, state[PERCUSS_STATES];
    /* The derivative of the state of now at a fixed time. Who makes the run writes it before an
     * event is passed or counted, and at the end. */
    double fixed[PERCUSS_STATES];
} percuss_name;

/* A run as it is made. */
typedef struct {
    /* The system: how many states it has, its forcing, its modes. */
    int size;
    double omega, phi;
    percuss_mode *modes;
    int mode_count;
    bool backward;
    /* What is asked for. */
    char setup[64];
    double span, relative, absolute, step, period, turn;
    double *samples;
    int sample_count;
    percuss_name *names;
    int name_count;
    /* Whether derivatives jump at events, as they do; without it they go on as they are. */
    bool has_jumps;
    /* The run so far: time, mode, state, samples taken; how it ended, or NULL. */
    double t;
    int mode;
    double z[PERCUSS_STATES];
    int sampled;
    const char *ended;
    /* What it cost. */
    int64_t rhs, jacobians, linear_solves, steps;
    /* Why there is no run; empty as a rule. */
    char failure[256];
    /* Of no concern to who makes the run. */
    struct percuss_private *own;
} percuss_course;

/* What is known of a mode where it begins. */
typedef struct {
    /* The first event that ends the mode at once; -1 if there is none. */
    int fires;
    /* Of each guard: the order of its first derivative that is not zero, 0 once the guard has moved
     * away; and the sign that it has just after the entry. */
    int order[PERCUSS_EVENTS], sign[PERCUSS_EVENTS];
} percuss_entry;

/* The right-hand side in the mode of now. False once the run has cost too much. */
bool percuss_rates(percuss_course *course, double t, const double *z, double *rates);

/* The Jacobian of the right-hand side, by rows, and its derivative by time. */
void percuss_jacobian(percuss_course *course, double t, double *jacobian, double *slope);

/* The value of a guard of the mode of now. */
double percuss_guard(const percuss_course *course, int event, double t, const double *z);

/* As percuss_guard, where the mode was entered with what is known of its entry: a guard that is
 * zero there has the sign that it has just after it until it has moved away by more than
 * the tolerance hides, and one that stays zero is negative. */
double percuss_guard_after(const percuss_course *course, const percuss_entry *entry, int event,
                           double t, const double *z);

/* Notes which guards have moved away from their zeros by the end of a step. */
void percuss_move_on(const percuss_course *course, percuss_entry *entry, double t,
                     const double *z);

/* What is known of the mode of now, after an event whose guard was zero (or NULL). */
percuss_entry percuss_enter(const percuss_course *course, const percuss_event *passed);

/* Whether a sample is wanted at or before a time; takes it. */
bool percuss_due(const percuss_course *course, double until, double *time);
void percuss_sample(percuss_course *course, const double *z);

/* Reports an event that is only counted. */
void percuss_count(percuss_course *course, double t, int event, const double *z);

/* Goes through an event that ends the mode. `plainly` decides what follows by the signs of
 * conditions alone, zero or not. */
void percuss_pass(percuss_course *course, double t, int event, const double *z, bool plainly);

/* The derivative of the right-hand side by a name, at a fixed time and state. */
void percuss_rates_by(const percuss_course *course, const percuss_name *name, double t,
                      const double *z, double *out);

/* The derivative of the state by a name where the mode of now begins, at that fixed time. */
void percuss_begin_by(percuss_course *course, const percuss_name *name, double *out);

/* Whether the run has not come to its end. */
bool percuss_goes_on(const percuss_course *course);

/* Says why there is no run. */
void percuss_fail(percuss_course *course, const char *why, ...);

/* Answers requests until there are no more. `setups` is a list in JSON. */
int percuss_serve(const char *library, const char *version, const char *language,
                  const char *setups, void (*make)(percuss_course *));

#ifdef __cplusplus
}
#endif

#endif
