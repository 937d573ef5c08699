/* SUNDIALS CVODES 6.4.1: y' = 1 from 0 goes back to 0 at y = b = 1. At t = 1.5, y = t - b and
 * dy/db = -1. cc cvodes_reset.c -lsundials_cvodes -lsundials_nvecserial -lm */
#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

static int rates(double t, N_Vector y, N_Vector f, void *data) { return N_VConst(1, f), 0; }
static int by_b(int count, double t, N_Vector y, N_Vector f, int place, N_Vector s, N_Vector out,
                void *data, N_Vector a, N_Vector b) { return N_VConst(0, out), 0; }
static int guard(double t, N_Vector y, double *g, void *data) { return *g = NV_Ith_S(y, 0) - 1, 0; }

static double run(double jump, SUNContext context) {
    N_Vector y = N_VNew_Serial(1, context), s = N_VNew_Serial(1, context);
    N_VConst(0, y), N_VConst(0, s);
    void *memory = CVodeCreate(CV_BDF, context);
    CVodeInit(memory, rates, 0, y), CVodeSStolerances(memory, 1e-9, 1e-9);
    SUNMatrix matrix = SUNDenseMatrix(1, 1, context);
    CVodeSetLinearSolver(memory, SUNLinSol_Dense(y, matrix, context), matrix);
    CVodeSensInit1(memory, 1, CV_STAGGERED, by_b, &s), CVodeRootInit(memory, 1, guard);
    double t, p = 1, tolerance = 1e-9;
    CVodeSetSensParams(memory, NULL, &p, NULL), CVodeSensSStolerances(memory, 1e-9, &tolerance);
    CVodeSetStopTime(memory, 1.5);
    while (CVode(memory, 1.5, y, &t, CV_NORMAL) == CV_ROOT_RETURN) {
        CVodeGetSens(memory, &t, &s);
        N_VConst(0, y), NV_Ith_S(s, 0) += jump;
        CVodeReInit(memory, t, y), CVodeSensReInit(memory, CV_STAGGERED, &s);
        CVodeSetStopTime(memory, 1.5);
    }
    return CVodeGetSens(memory, &t, &s), NV_Ith_S(s, 0);
}

int main(void) {
    SUNContext context;
    SUNContext_Create(NULL, &context);
    printf("as it is: dy/db = %f, expected -1\n", run(0, context));
    printf("with the jump by hand: dy/db = %f\n", run(-1, context));
}
