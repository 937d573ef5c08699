/* The functions that CVODE and CVODES have by the same names, and how a run of both is set up; to
 * be included after the header of either. */

#ifndef PERCUSS_CVODE_H
#define PERCUSS_CVODE_H

#include "percuss_sundials.h"

/* The functions of an integrator that both have. */
#define CVODE_CALLS                                                                               \
    .begin = CVodeReInit, .root_init = CVodeRootInit,                                             \
    .set_root_direction = CVodeSetRootDirection, .set_stop_time = CVodeSetStopTime,               \
    .step = CVode, .get_dky = CVodeGetDky, .get_root_info = CVodeGetRootInfo,                     \
    .get_steps = CVodeGetNumSteps, .get_jacobians = CVodeGetNumJacEvals,                          \
    .get_iterations = CVodeGetNumNonlinSolvIters, .get_name = CVodeGetReturnFlagName

/* Makes the integrator of a run. */
static inline void cvode_create(sundials_run *run, int method, SUNContext context) {
    const percuss_course *course = run->course;
    run->memory = CVodeCreate(method, context);
    CVodeInit(run->memory, sundials_rates, course->t, run->z);
    CVodeSStolerances(run->memory, course->relative, course->absolute);
    CVodeSetUserData(run->memory, run);
    CVodeSetErrFile(run->memory, stderr);
}

/* Sets the solver that an implicit method uses in its corrector. */
static inline void cvode_set_linear_solver(sundials_run *run) {
    CVodeSetLinearSolver(run->memory, run->linear, run->matrix);
    CVodeSetJacFn(run->memory, sundials_jacobian);
}

/* Sets what an expert sets of steps. */
static inline void cvode_set_steps(sundials_run *run) {
    CVodeSetMaxStep(run->memory, sundials_longest_step(run->course));
    CVodeSetMaxNumSteps(run->memory, -1);
}

#endif
