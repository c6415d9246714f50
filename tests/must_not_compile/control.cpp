// The control: without a mistake the same headers and flags compile.
// expect: success
#include <softtissue/core/executor.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/solver/newton.hpp>

static_assert(softtissue::HyperelasticMaterial<softtissue::StableNeoHookean<double>>);
static_assert(softtissue::Executor<softtissue::SequentialExecutor>);
