// SPDX-License-Identifier: MIT
/// @file
/// CHOLMOD's supernodal Cholesky behind the five verbs of sparse/concepts.hpp. Optional: needs SuiteSparse.
///
/// What        a drop-in for Eigen::SimplicialLLT, several times faster to factor on solid meshes; double only.
/// Threads     CHOLMOD opens four OpenMP threads by default, slower than one on small machines: set OMP_NUM_THREADS.
/// Link        softtissue::cholmod
/// Tests       tests/unit/sparse/cholmod_test.cpp
#pragma once

#if !__has_include(<cholmod.h>)
#error "softtissue: sparse/cholmod.hpp needs SuiteSparse (Debian: libsuitesparse-dev); link softtissue::cholmod, which adds its include path"
#endif

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>

namespace softtissue {

/// Satisfies SparseCholesky<double>.
class CholmodCholesky : public Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> {
public:
    CholmodCholesky() {
        cholmod().print = 0;  // an indefinite matrix is an answer here, not a warning for the console
    }
};

}  // namespace softtissue
