// Who knows what finite math means for the solvers may have it.
// expect: success
// flags: -ffast-math -DSOFTTISSUE_ALLOW_FINITE_MATH
#include <softtissue/solver/newton.hpp>
