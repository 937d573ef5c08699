/* SUNDIALS CVODES: CVODE's root finding with forward sensitivities, run by percuss.
 *
 * The documentation has an example of each, and of both together none: `bdf-default` is BDF as in
 * cvRoberts_dns with the sensitivities of cvsRoberts_FSA_dns, staggered and in the error control,
 * at tolerances that CVODES estimates. At an event the state is reset and all begins anew with the
 * sensitivities as they are. `bdf` is what an expert adds: all that cvode.c does, the tolerances
 * for the sensitivities too, and at an event the jump by hand: the time moves by the change of the
 * guard over the guard's rate, the state along its rates, and the reset is differentiated. Each
 * name is one sensitivity, whose right-hand side is given. */

#include <cvodes/cvodes.h>

#include "percuss_cvode.h"

#include <string.h>
#include <sundials/sundials_version.h>

static int sensitivity_rates(int count, realtype t, N_Vector z, N_Vector fz, int place, N_Vector s,
                             N_Vector out, void *data, N_Vector a, N_Vector b) {
    (void)count, (void)fz, (void)a, (void)b;
    const percuss_course *course = ((sundials_run *)data)->course;
    const percuss_mode *mode = &course->modes[course->mode];
    const double *from = N_VGetArrayPointer(s);
    double *to = N_VGetArrayPointer(out);
    percuss_rates_by(course, &course->names[place], t, N_VGetArrayPointer(z), to);
    for (int i = 0; i < course->size; i++)
        for (int j = 0; j < course->size; j++) to[i] += mode->matrix[i][j] * from[j];
    return 0;
}

/* Begins sensitivities for the first time. */
static int first_sensitivities(sundials_run *run) {
    percuss_course *course = run->course;
    int count = course->name_count;
    double scales[count], absolute[count];
    for (int n = 0; n < count; n++) {
        double value = course->names[n].value;
        scales[n] = value != 0.0 ? value : 1.0;
        absolute[n] = course->absolute;
    }
    int flag = CVodeSensInit1(run->memory, count, CV_STAGGERED, sensitivity_rates,
                              run->sensitivities);
    if (flag >= 0) flag = CVodeSetSensErrCon(run->memory, SUNTRUE);
    if (flag >= 0) flag = CVodeSetSensParams(run->memory, NULL, scales, NULL);
    if (flag < 0) return flag;
    return run->is_default ? CVodeSensEEtolerances(run->memory)
                           : CVodeSensSStolerances(run->memory, course->relative, absolute);
}

static int begin_sensitivities(sundials_run *run) {
    percuss_course *course = run->course;
    bool is_first = !run->sensitivities;
    if (is_first) run->sensitivities = N_VCloneVectorArray(course->name_count, run->z);
    for (int n = 0; n < course->name_count; n++)
        percuss_begin_by(course, &course->names[n], N_VGetArrayPointer(run->sensitivities[n]));
    if (is_first) return first_sensitivities(run);
    return CVodeSensReInit(run->memory, CV_STAGGERED, run->sensitivities);
}

static int take_sensitivities(sundials_run *run) {
    percuss_course *course = run->course;
    double t;
    int flag = CVodeGetSens(run->memory, &t, run->sensitivities);
    for (int n = 0; flag >= 0 && n < course->name_count; n++)
        memcpy(course->names[n].fixed, N_VGetArrayPointer(run->sensitivities[n]),
               course->size * sizeof(double));
    return flag;
}

static const sundials_calls CVODES = {
    CVODE_CALLS,
    .begin_sensitivities = begin_sensitivities,
    .take_sensitivities = take_sensitivities,
};

static void make(percuss_course *course) {
    SUNContext context;
    if (SUNContext_Create(NULL, &context)) return percuss_fail(course, "no context");
    sundials_run run = {.calls = &CVODES, .course = course, .is_implicit = true};
    run.is_default = strstr(course->setup, "-default") != NULL;
    course->has_jumps = !run.is_default;
    sundials_prepare(&run, context);
    cvode_create(&run, CV_BDF, context);
    cvode_set_linear_solver(&run);
    if (!run.is_default) cvode_set_steps(&run);
    sundials_make(&run);
    CVodeFree(&run.memory);
    if (run.sensitivities) N_VDestroyVectorArray(run.sensitivities, course->name_count);
    sundials_free(&run);
    SUNContext_Free(&context);
}

#define SET_UP(name)                                                                              \
    "{\"name\":\"" name "\",\"method\":\"BDF of orders 1 to 5 in Nordsieck form\","               \
    "\"class\":\"multistep\",\"events\":\"library\",\"dense_output\":true,"                       \
    "\"stepping\":\"adaptive\",\"gradients\":true}"

int main(void) {
    char version[32] = "unknown";
    SUNDIALSGetVersion(version, sizeof version);
    return percuss_serve("sundials-cvodes", version, "C11, gcc " __VERSION__,
                         "[" SET_UP("bdf") "," SET_UP("bdf-default") "]", make);
}
