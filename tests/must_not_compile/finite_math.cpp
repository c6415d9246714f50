// Under -ffinite-math-only the checks for NaN would vanish, those of a mesh as those of a solver.
// expect: input and solvers are checked for NaN
// flags: -ffast-math
#include <softtissue/mesh/cell_mesh.hpp>
