/* SUNDIALS ARKODE with its own root finding, run by percuss: explicit and diagonally implicit
 * Runge-Kutta methods.
 *
 * `dirk-default` and `erk-default` are the documentation's example with roots, ark_robertson_root,
 * and the same with an explicit right-hand side: root functions, the tolerances, and nothing else.
 * `dirk`, `erk` and `erk8` are what an expert adds, which is what is said in cvode.c. */

#include "percuss_sundials.h"

#include <arkode/arkode_arkstep.h>
#include <string.h>
#include <sundials/sundials_version.h>

static int begin_explicit(void *memory, realtype t, N_Vector z) {
    return ARKStepReInit(memory, sundials_rates, NULL, t, z);
}

static int begin_implicit(void *memory, realtype t, N_Vector z) {
    return ARKStepReInit(memory, NULL, sundials_rates, t, z);
}

static const sundials_calls ARKODE = {
    .root_init = ARKStepRootInit,
    .set_root_direction = ARKStepSetRootDirection,
    .set_stop_time = ARKStepSetStopTime,
    .step = ARKStepEvolve,
    .get_dky = ARKStepGetDky,
    .get_root_info = ARKStepGetRootInfo,
    .get_steps = ARKStepGetNumSteps,
    .get_jacobians = ARKStepGetNumJacEvals,
    .get_iterations = ARKStepGetNumNonlinSolvIters,
    .get_name = ARKStepGetReturnFlagName,
};

static void make(percuss_course *course) {
    SUNContext context;
    if (SUNContext_Create(NULL, &context)) return percuss_fail(course, "no context");
    sundials_calls calls = ARKODE;
    sundials_run run = {.calls = &calls, .course = course};
    run.is_default = strstr(course->setup, "-default") != NULL;
    run.is_implicit = !strncmp(course->setup, "dirk", 4);
    calls.begin = run.is_implicit ? begin_implicit : begin_explicit;
    sundials_prepare(&run, context);
    ARKRhsFn explicit = run.is_implicit ? NULL : sundials_rates;
    ARKRhsFn implicit = run.is_implicit ? sundials_rates : NULL;
    run.memory = ARKStepCreate(explicit, implicit, course->t, run.z, context);
    ARKStepSStolerances(run.memory, course->relative, course->absolute);
    ARKStepSetUserData(run.memory, &run);
    ARKStepSetErrFile(run.memory, stderr);
    if (!strcmp(course->setup, "erk8")) ARKStepSetOrder(run.memory, 8);
    if (run.is_implicit) {
        ARKStepSetLinearSolver(run.memory, run.linear, run.matrix);
        ARKStepSetJacFn(run.memory, sundials_jacobian);
    }
    if (!run.is_default) {
        ARKStepSetMaxStep(run.memory, sundials_longest_step(course));
        ARKStepSetMaxNumSteps(run.memory, -1);
    }
    sundials_make(&run);
    ARKStepFree(&run.memory);
    sundials_free(&run);
    SUNContext_Free(&context);
}

#define SET_UP(name, method, class, order)                                                        \
    "{\"name\":\"" name "\",\"method\":\"" method "\",\"class\":\"" class "\","                    \
    "\"order\":" order ",\"events\":\"library\",\"dense_output\":true,\"stepping\":\"adaptive\"}"
#define DIRK "SDIRK 5(3)4, the default"
#define ERK "Zonneveld 5(3)4, the default"

int main(void) {
    char version[32] = "unknown";
    SUNDIALSGetVersion(version, sizeof version);
    return percuss_serve("sundials-arkode", version, "C11, gcc " __VERSION__,
                         "[" SET_UP("dirk", DIRK, "implicit", "4") ","
                             SET_UP("erk", ERK, "explicit", "4") ","
                             SET_UP("erk8", "Fehlberg 13(7)8", "explicit", "8") ","
                             SET_UP("dirk-default", DIRK, "implicit", "4") ","
                             SET_UP("erk-default", ERK, "explicit", "4") "]",
                         make);
}
