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
};

/* Seconds of a clock that never goes back. */
double percuss_now(void);

/* Ends a run that goes beyond its limits. */
void percuss_give_up(percuss_course *course, const char *why);

/* Reports an event, with the states before and after its reset. */
void percuss_report(percuss_course *course, double t, int event, int mode, const double *before,
                    const double *after);

#endif
