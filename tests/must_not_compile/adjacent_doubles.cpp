// Two moduli without names could be swapped unseen.
// expect: no matching (function|constructor)
#include <softtissue/material/stable_neo_hookean.hpp>

const softtissue::StableNeoHookean<double> material(3e4, 9e4);
