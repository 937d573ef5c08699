/* SUNDIALS CVODE with its own root finding, run by percuss.
 *
 * `bdf-default` is the first example of the documentation, cvRoberts_dns: BDF, a dense Jacobian,
 * root functions, the tolerances, and nothing else; `adams-default` is the same by CV_ADAMS. `bdf`
 * and `adams` are what an expert adds:
 *
 * - Root functions have directions; without them the caller looks at the signs that
 *   CVodeGetRootInfo gives, and each crossing in the other direction ends a call.
 * - Steps are at most an eighth of a forcing period and of a turn: roots are looked for by signs at
 *   the ends of steps.
 * - A guard that is zero where a mode begins has the sign that it has just after it, until it has
 *   moved away by more than the tolerance hides: CVODE's first steps are small, and what the
 *   corrector leaves is found as another root after each of them. Where a flight is lower than the
 *   tolerance this gives spurious impacts (docs/FINDINGS_LANGUAGES.md, CVODE near an accumulation).
 * - What follows an event is told by the first derivative that is not zero.
 * - There is no limit on steps between outputs.
 * - Adams has a fixed-point iteration, which its problems are meant for. */

#include <cvode/cvode.h>

#include "percuss_cvode.h"

#include <string.h>
#include <sundials/sundials_version.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static const sundials_calls CVODE = {CVODE_CALLS};

static void make(percuss_course *course) {
    SUNContext context;
    if (SUNContext_Create(NULL, &context)) return percuss_fail(course, "no context");
    bool is_adams = !strncmp(course->setup, "adams", 5);
    sundials_run run = {.calls = &CVODE, .course = course};
    run.is_default = strstr(course->setup, "-default") != NULL;
    run.is_implicit = !is_adams || run.is_default;
    sundials_prepare(&run, context);
    SUNNonlinearSolver fixed = SUNNonlinSol_FixedPoint(run.z, 0, context);
    cvode_create(&run, is_adams ? CV_ADAMS : CV_BDF, context);
    if (run.is_implicit) cvode_set_linear_solver(&run);
    else CVodeSetNonlinearSolver(run.memory, fixed);
    if (!run.is_default) cvode_set_steps(&run);
    sundials_make(&run);
    CVodeFree(&run.memory);
    SUNNonlinSolFree(fixed);
    sundials_free(&run);
    SUNContext_Free(&context);
}

#define SET_UP(name, method)                                                                      \
    "{\"name\":\"" name "\",\"method\":\"" method "\",\"class\":\"multistep\","                   \
    "\"events\":\"library\",\"dense_output\":true,\"stepping\":\"adaptive\"}"
#define BDF "BDF of orders 1 to 5 in Nordsieck form"
#define ADAMS "Adams-Moulton of orders 1 to 12"

int main(void) {
    char version[32] = "unknown";
    SUNDIALSGetVersion(version, sizeof version);
    return percuss_serve("sundials-cvode", version, "C11, gcc " __VERSION__,
                         "[" SET_UP("bdf", BDF) "," SET_UP("adams", ADAMS) ","
                             SET_UP("bdf-default", BDF) "," SET_UP("adams-default", ADAMS) "]",
                         make);
}
