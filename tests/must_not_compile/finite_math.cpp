// Under -ffinite-math-only the solvers' NaN checks would vanish.
// expect: solvers detect NaN
// flags: -ffast-math
#include <softtissue/solver/newton.hpp>
