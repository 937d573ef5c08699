/* Requests read and answers written, with cJSON. */

#define _GNU_SOURCE
#include "percuss_wire.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double number(const cJSON *object, const char *key) {
    return cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(object, key));
}

/* A list of numbers; of null, nothing. */
int percuss_numbers(const cJSON *list, double *values) {
    int count = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, list) values[count++] = item->valuedouble;
    return count;
}

static void read_event(percuss_event *event, const cJSON *wire, int size) {
    percuss_numbers(cJSON_GetObjectItem(wire, "guard"), event->guard);
    const char *direction = cJSON_GetStringValue(cJSON_GetObjectItem(wire, "direction"));
    event->sign = !strcmp(direction, "rising") ? 1 : !strcmp(direction, "falling") ? -1 : 0;
    for (int i = 0; i < size + 3; i++) event->reset[i][i] = 1.0;
    const cJSON *item;
    int row = 0;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(wire, "reset")) {
        memset(event->reset[row], 0, sizeof event->reset[row]);
        percuss_numbers(item, event->reset[row++]);
    }
    const cJSON *successors = cJSON_GetObjectItem(wire, "successors");
    event->successors = calloc((size_t)cJSON_GetArraySize(successors) + 1,
                               sizeof *event->successors);
    cJSON_ArrayForEach(item, successors) {
        percuss_successor *next = &event->successors[event->successor_count++];
        next->has_when = percuss_numbers(cJSON_GetObjectItem(item, "when"), next->when) > 0;
        next->mode = (int)number(item, "mode");
    }
}

void percuss_read_rows(percuss_mode *mode, const cJSON *wire, int size) {
    const cJSON *item;
    int row = 0;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(wire, "A"))
        percuss_numbers(item, mode->matrix[row++]);
    row = 0;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(wire, "B"))
        percuss_numbers(item, mode->matrix[row++] + size);
    row = 0;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(wire, "c"))
        mode->matrix[row++][size + 2] = item->valuedouble;
}

static void read_mode(percuss_mode *mode, const cJSON *wire, int size, double omega) {
    const cJSON *item;
    percuss_read_rows(mode, wire, size);
    mode->matrix[size][size + 1] = -omega;
    mode->matrix[size + 1][size] = omega;
    const cJSON *events = cJSON_GetObjectItem(wire, "events");
    mode->events = calloc((size_t)cJSON_GetArraySize(events) + 1, sizeof *mode->events);
    cJSON_ArrayForEach(item, events) read_event(&mode->events[mode->event_count++], item, size);
}

static void read_system(percuss_course *course, const cJSON *wire) {
    course->omega = number(wire, "omega");
    course->phi = number(wire, "phi");
    const cJSON *modes = cJSON_GetObjectItem(wire, "modes"), *item;
    course->modes = calloc((size_t)cJSON_GetArraySize(modes), sizeof *course->modes);
    cJSON_ArrayForEach(item, modes)
        read_mode(&course->modes[course->mode_count++], item, course->size, course->omega);
}

static void read_run(percuss_course *course, const cJSON *run) {
    const cJSON *tolerance = cJSON_GetObjectItem(run, "tolerance");
    const cJSON *times = cJSON_GetObjectItem(run, "times");
    const cJSON *limits = cJSON_GetObjectItem(run, "limits");
    const cJSON *samples = cJSON_GetObjectItem(run, "samples");
    const char *setup = cJSON_GetStringValue(cJSON_GetObjectItem(run, "setup"));
    snprintf(course->setup, sizeof course->setup, "%s", setup);
    course->size = percuss_numbers(cJSON_GetObjectItem(run, "state"), course->z);
    course->mode = (int)number(run, "mode");
    course->span = number(run, "span");
    course->backward = cJSON_IsTrue(cJSON_GetObjectItem(run, "backward"));
    course->relative = number(tolerance, "relative");
    course->absolute = number(tolerance, "absolute");
    course->step = number(run, "step");
    course->period = number(times, "period");
    course->turn = number(times, "turn");
    if (isnan(course->turn)) course->turn = INFINITY;
    course->samples = calloc((size_t)cJSON_GetArraySize(samples) + 1, sizeof *course->samples);
    course->sample_count = percuss_numbers(samples, course->samples);
    course->own->most_calls = (int64_t)number(limits, "calls");
    course->own->most_events = (int)number(limits, "events");
    course->own->deadline = percuss_now() + number(limits, "wall_s");
    read_system(course, cJSON_GetObjectItem(run, "system"));
    percuss_read_names(course, cJSON_GetObjectItem(run, "gradients"));
}

static void forget(percuss_course *course) {
    for (int mode = 0; mode < course->mode_count; mode++) {
        for (int event = 0; event < course->modes[mode].event_count; event++)
            free(course->modes[mode].events[event].successors);
        free(course->modes[mode].events);
    }
    free(course->modes);
    free(course->samples);
    percuss_forget_names(course);
}

/* A state in JSON; one that is not finite is a failure. */
static cJSON *state(percuss_course *course, const double *z) {
    for (int i = 0; i < course->size; i++)
        if (!isfinite(z[i])) percuss_fail(course, "a state is not finite");
    return cJSON_CreateDoubleArray(z, course->size);
}

void percuss_sample(percuss_course *course, const double *z) {
    cJSON_AddItemToArray(course->own->samples, state(course, z));
    course->sampled++;
}

void percuss_report(percuss_course *course, double t, int event, int mode, const double *before,
                    const double *after) {
    if (course->own->reported++ >= course->own->most_events)
        percuss_give_up(course, "too many events");
    if (course->failure[0]) return;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "time", t);
    cJSON_AddNumberToObject(object, "event", event);
    cJSON_AddNumberToObject(object, "mode", mode);
    cJSON_AddItemToObject(object, "before", state(course, before));
    cJSON_AddItemToObject(object, "state", state(course, after));
    cJSON_AddItemToArray(course->own->events, object);
}

static void answer_run(cJSON *answer, percuss_course *course, double seconds) {
    double time;
    while (!course->ended && percuss_due(course, INFINITY, &time))
        percuss_sample(course, course->z);
    cJSON *end = state(course, course->z);
    if (course->failure[0]) {
        const char *kind = course->own->gave_up ? "gave_up" : "failure";
        cJSON_AddStringToObject(answer, kind, course->failure);
        cJSON_Delete(end);
        return;
    }
    cJSON *run = cJSON_AddObjectToObject(answer, "run");
    /* The lists belong to the course, which outlives the answer. */
    cJSON_AddItemReferenceToObject(run, "events", course->own->events);
    cJSON_AddItemReferenceToObject(run, "samples", course->own->samples);
    cJSON_AddItemToObject(run, "end", end);
    cJSON_AddStringToObject(run, "ended", course->ended ? course->ended : "horizon");
    cJSON_AddNumberToObject(run, "ended_at", course->ended ? course->t : course->span);
    cJSON *work = cJSON_AddObjectToObject(run, "work");
    cJSON_AddNumberToObject(work, "rhs", (double)course->rhs);
    cJSON_AddNumberToObject(work, "jacobians", (double)course->jacobians);
    cJSON_AddNumberToObject(work, "linear_solves", (double)course->linear_solves);
    cJSON_AddNumberToObject(work, "steps", (double)course->steps);
    cJSON_AddNumberToObject(run, "own_ns", floor(1e9 * seconds));
    if (course->name_count && !course->ended)
        cJSON_AddItemToObject(run, "gradients", percuss_derivatives(course));
}

static void write_answer(cJSON *answer) {
    char *text = cJSON_PrintUnformatted(answer);
    puts(text);
    fflush(stdout);
    free(text);
    cJSON_Delete(answer);
}

static void run(cJSON *answer, const cJSON *wire, void (*make)(percuss_course *)) {
    struct percuss_private own = {.events = cJSON_CreateArray(), .samples = cJSON_CreateArray()};
    percuss_course course = {.own = &own};
    read_run(&course, wire);
    double began = percuss_now(), time;
    while (percuss_due(&course, 0.0, &time)) percuss_sample(&course, course.z);
    make(&course);
    answer_run(answer, &course, percuss_now() - began);
    write_answer(answer);
    forget(&course);
    cJSON_Delete(own.events);
    cJSON_Delete(own.samples);
}

int percuss_serve(const char *library, const char *version, const char *language,
                  const char *setups, void (*make)(percuss_course *)) {
    char *line = NULL;
    size_t room = 0;
    while (getline(&line, &room, stdin) > 0) {
        cJSON *request = cJSON_Parse(line), *answer = cJSON_CreateObject();
        const char *ask = cJSON_GetStringValue(cJSON_GetObjectItem(request, "ask"));
        if (!ask) return 1;
        cJSON_AddNumberToObject(answer, "percuss_protocol", 1);
        cJSON_AddNumberToObject(answer, "id", number(request, "id"));
        if (!strcmp(ask, "run")) {
            run(answer, cJSON_GetObjectItem(request, "run"), make);
        } else if (!strcmp(ask, "capabilities")) {
            cJSON *said = cJSON_AddObjectToObject(answer, "capabilities");
            cJSON_AddStringToObject(said, "library", library);
            cJSON_AddStringToObject(said, "version", version);
            cJSON_AddStringToObject(said, "language", language);
            cJSON_AddItemToObject(said, "setups", cJSON_Parse(setups));
            write_answer(answer);
        } else {
            cJSON_AddTrueToObject(answer, "ready");
            write_answer(answer);
        }
        cJSON_Delete(request);
    }
    free(line);
    return 0;
}
