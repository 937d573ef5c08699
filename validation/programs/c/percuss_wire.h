/* What the two halves of the helper for C have in common. */

#ifndef PERCUSS_WIRE_H
#define PERCUSS_WIRE_H

#include "percuss_program.h"

#include <cjson/cJSON.h>

struct percuss_private {
    cJSON *events, *samples;
    int64_t most_calls;
    int most_events, reported, crowd;
    double deadline;
    bool gave_up;
    /* A list of the derivatives of events for each name. */
    cJSON **derivatives;
};

/* The vector (z, cos theta, sin theta, 1), and a row times such a vector. */
void percuss_wide(const percuss_course *course, double t, const double *z, double *w);
double percuss_dot(const percuss_course *course, const double *row, const double *w);

/* Seconds of a clock that never goes back. */
double percuss_now(void);

/* Ends a run that goes beyond its limits. */
void percuss_give_up(percuss_course *course, const char *why);

/* Reports an event, with the states before and after its reset. */
void percuss_report(percuss_course *course, double t, int event, int mode, const double *before,
                    const double *after);

/* Fills a row from a list of numbers; returns how many there were. */
int percuss_numbers(const cJSON *list, double *values);

/* Reads the coefficients of a mode into the rows of its states. */
void percuss_read_rows(percuss_mode *mode, const cJSON *wire, int size);

/* Reads the names by which derivatives are asked for, and forgets them. */
void percuss_read_names(percuss_course *course, const cJSON *list);
void percuss_forget_names(percuss_course *course);

/* Takes the derivatives through an event: that of its time, and of the state after it. */
void percuss_differentiate(percuss_course *course, double t, int event, const double *z);

/* The derivatives of a run that has come to its horizon. */
cJSON *percuss_derivatives(percuss_course *course);

#endif
