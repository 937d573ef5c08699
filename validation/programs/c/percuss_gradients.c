/* Derivatives of a run by names, through its events. */

#include "percuss_wire.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void read_mode(percuss_mode *mode, const cJSON *wire, int size) {
    const cJSON *item, *row;
    percuss_read_rows(mode, wire, size);
    const cJSON *events = cJSON_GetObjectItem(wire, "events");
    mode->events = calloc((size_t)cJSON_GetArraySize(events) + 1, sizeof *mode->events);
    cJSON_ArrayForEach(item, events) {
        percuss_event *event = &mode->events[mode->event_count++];
        percuss_numbers(cJSON_GetObjectItem(item, "guard"), event->guard);
        int i = 0;
        cJSON_ArrayForEach(row, cJSON_GetObjectItem(item, "reset"))
            percuss_numbers(row, event->reset[i++]);
    }
}

void percuss_read_names(percuss_course *course, const cJSON *list) {
    int count = cJSON_GetArraySize(list);
    if (!count) return;
    course->names = calloc((size_t)count, sizeof *course->names);
    course->own->derivatives = calloc((size_t)count, sizeof(cJSON *));
    const cJSON *item, *mode;
    cJSON_ArrayForEach(item, list) {
        course->own->derivatives[course->name_count] = cJSON_CreateArray();
        percuss_name *name = &course->names[course->name_count++];
        const char *wrt = cJSON_GetStringValue(cJSON_GetObjectItem(item, "wrt"));
        snprintf(name->wrt, sizeof name->wrt, "%s", wrt);
        name->value = cJSON_GetNumberValue(cJSON_GetObjectItem(item, "value"));
        name->omega = cJSON_GetNumberValue(cJSON_GetObjectItem(item, "omega"));
        name->phi = cJSON_GetNumberValue(cJSON_GetObjectItem(item, "phi"));
        percuss_numbers(cJSON_GetObjectItem(item, "state"), name->state);
        name->modes = calloc((size_t)course->mode_count, sizeof *name->modes);
        int place = 0;
        cJSON_ArrayForEach(mode, cJSON_GetObjectItem(item, "modes"))
            read_mode(&name->modes[place++], mode, course->size);
    }
}

void percuss_forget_names(percuss_course *course) {
    for (int n = 0; n < course->name_count; n++) {
        for (int mode = 0; mode < course->mode_count; mode++)
            free(course->names[n].modes[mode].events);
        free(course->names[n].modes);
        cJSON_Delete(course->own->derivatives[n]);
    }
    free(course->own->derivatives);
    free(course->names);
}

/* The derivative of (z, cos theta, sin theta, 1) by a name, at a time that moves by dt. */
static void wide_by(const percuss_course *course, const percuss_name *name, double t, double dt,
                    const double *dz, double *w) {
    percuss_wide(course, t, dz, w);
    double angle = name->omega * t + course->omega * dt + name->phi, sine = w[course->size + 1];
    w[course->size + 1] = w[course->size] * angle;
    w[course->size] = -sine * angle;
    w[course->size + 2] = 0.0;
}

void percuss_rates_by(const percuss_course *course, const percuss_name *name, double t,
                      const double *z, double *out) {
    percuss_row w, still = {0}, turned;
    percuss_wide(course, t, z, w);
    wide_by(course, name, t, 0.0, still, turned);
    for (int i = 0; i < course->size; i++)
        out[i] = percuss_dot(course, name->modes[course->mode].matrix[i], w) +
                 percuss_dot(course, course->modes[course->mode].matrix[i], turned);
}

void percuss_begin_by(percuss_course *course, const percuss_name *name, double *out) {
    double rates[PERCUSS_STATES];
    percuss_rates(course, course->t, course->z, rates);
    for (int i = 0; i < course->size; i++) out[i] = name->state[i] - name->time * rates[i];
}

/* By how much the time of an event moves: the change of its guard over the guard's rate, with the
 * rates of the state before it. */
static double moves(const percuss_course *course, const percuss_name *name, double t, int event,
                    const double *z, const double *rates) {
    const double *guard = course->modes[course->mode].events[event].guard;
    percuss_row w, change, speed;
    percuss_wide(course, t, z, w);
    wide_by(course, name, t, 0.0, name->fixed, change);
    memcpy(speed, rates, course->size * sizeof *rates);
    speed[course->size] = -course->omega * w[course->size + 1];
    speed[course->size + 1] = course->omega * w[course->size];
    speed[course->size + 2] = 0.0;
    double own = percuss_dot(course, name->modes[course->mode].events[event].guard, w);
    return -(percuss_dot(course, guard, change) + own) / percuss_dot(course, guard, speed);
}

/* A list of numbers, or null where one is not finite. */
static cJSON *finite(const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return cJSON_CreateNull();
    return cJSON_CreateDoubleArray(values, count);
}

static void by_name(percuss_course *course, int n, double t, int event, const double *z,
                    const double *rates) {
    percuss_name *name = &course->names[n];
    const percuss_event *own = &name->modes[course->mode].events[event];
    const percuss_event *passed = &course->modes[course->mode].events[event];
    double time = name->time, state[PERCUSS_STATES], after[PERCUSS_STATES];
    memcpy(state, name->state, sizeof state);
    /* An event where its mode is entered comes when the entry does. */
    if (t > course->t) {
        time = moves(course, name, t, event, z, rates);
        for (int i = 0; i < course->size; i++) state[i] = name->fixed[i] + time * rates[i];
    }
    percuss_row w, change;
    percuss_wide(course, t, z, w);
    wide_by(course, name, t, time, state, change);
    for (int i = 0; i < course->size; i++)
        after[i] = percuss_dot(course, passed->reset[i], change) +
                   percuss_dot(course, own->reset[i], w);
    cJSON *item = cJSON_CreateObject();
    cJSON *moved = isfinite(time) ? cJSON_CreateNumber(time) : cJSON_CreateNull();
    cJSON_AddItemToObject(item, "time", moved);
    cJSON_AddItemToObject(item, "state", finite(after, course->size));
    cJSON_AddItemToArray(course->own->derivatives[n], item);
    /* Where the mode goes on, so does the stretch with its sensitivities. */
    if (!passed->successor_count) return;
    name->time = time;
    memcpy(name->state, after, sizeof after);
}

void percuss_differentiate(percuss_course *course, double t, int event, const double *z) {
    if (!course->name_count) return;
    if (!course->has_jumps) {
        for (int n = 0; n < course->name_count; n++)
            memcpy(course->names[n].state, course->names[n].fixed, sizeof course->names[n].fixed);
        return;
    }
    double rates[PERCUSS_STATES];
    percuss_rates(course, t, z, rates);
    for (int n = 0; n < course->name_count; n++) by_name(course, n, t, event, z, rates);
}

cJSON *percuss_derivatives(percuss_course *course) {
    cJSON *list = cJSON_CreateArray();
    for (int n = 0; n < course->name_count; n++) {
        cJSON *end = finite(course->names[n].fixed, course->size);
        if (cJSON_IsNull(end)) {
            cJSON_Delete(end);
            continue;
        }
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "wrt", course->names[n].wrt);
        /* The list belongs to the course, which outlives the answer. */
        if (course->has_jumps)
            cJSON_AddItemReferenceToObject(item, "events", course->own->derivatives[n]);
        cJSON_AddItemToObject(item, "end", end);
        cJSON_AddItemToArray(list, item);
    }
    return list;
}
