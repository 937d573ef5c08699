/* What programs of SUNDIALS' integrators have in common: the functions that they give the library,
 * and a run from mode to mode. The libraries' own functions differ by the beginning of their names
 * alone, which is why they are handed over in a table. */

#ifndef PERCUSS_SUNDIALS_H
#define PERCUSS_SUNDIALS_H

#include "percuss_program.h"

#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

/* The longest step that an expert allows, in forcing periods and in turns. */
#define LONGEST_STEP 0.125

typedef int (*sundials_guards)(realtype, N_Vector, realtype *, void *);

struct sundials_run;

/* The functions of an integrator. */
typedef struct {
    /* Begins anew at a time and state. */
    int (*begin)(void *memory, realtype t, N_Vector z);
    int (*root_init)(void *memory, int count, sundials_guards guards);
    int (*set_root_direction)(void *memory, int *directions);
    int (*set_stop_time)(void *memory, realtype t);
    int (*step)(void *memory, realtype next, N_Vector z, realtype *t, int task);
    int (*get_dky)(void *memory, realtype t, int order, N_Vector z);
    int (*get_root_info)(void *memory, int *found);
    int (*get_steps)(void *memory, long *count);
    int (*get_jacobians)(void *memory, long *count);
    int (*get_iterations)(void *memory, long *count);
    char *(*get_name)(long flag);
    /* Begins anew with sensitivities after `begin`, and takes them at the time that the last call
     * returned; NULL where the integrator has none. */
    int (*begin_sensitivities)(struct sundials_run *run);
    int (*take_sensitivities)(struct sundials_run *run);
} sundials_calls;

/* A run. */
typedef struct sundials_run {
    const sundials_calls *calls;
    percuss_course *course;
    percuss_entry entry;
    /* Whether the method has Jacobians. */
    bool is_default, is_implicit;
    void *memory;
    /* The state, and room for another one. */
    N_Vector z, at;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    /* A sensitivity for each name; NULL before they are begun. */
    N_Vector *sensitivities;
} sundials_run;

/* Makes the vectors and the linear solver; false where there is no memory for them. */
bool sundials_prepare(sundials_run *run, SUNContext context);
void sundials_free(sundials_run *run);

/* The right-hand side and its Jacobian, which libraries are given with the run as their data. */
int sundials_rates(realtype t, N_Vector z, N_Vector out, void *run);
int sundials_jacobian(realtype t, N_Vector z, N_Vector fz, SUNMatrix out, void *run, N_Vector a,
                      N_Vector b, N_Vector c);

/* The longest step that an expert allows. */
double sundials_longest_step(const percuss_course *course);

/* Makes the run, with a `memory` that is set up. */
void sundials_make(sundials_run *run);

#endif
