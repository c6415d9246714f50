// SPDX-License-Identifier: MIT
/// @file
/// The library's three macros; no other configuration exists.
///
/// SOFTTISSUE_ASSERT(condition)       caller bug inside a kernel; gone with NDEBUG; overridable
/// SOFTTISSUE_THROW(type, text)       the one way an exception leaves the library; override it to
///                                    compile with -fno-exceptions (the replacement must not return)
/// SOFTTISSUE_ALLOW_FINITE_MATH       define it to compile under -ffinite-math-only (part of -ffast-math), where the compiler takes
///                                    for granted that there is no NaN, and deletes the checks of input and of solvers for it
#pragma once

#include <cassert>

#ifndef SOFTTISSUE_ASSERT
/// A caller's mistake inside a kernel.
#define SOFTTISSUE_ASSERT(condition) assert(condition)
#endif

#ifndef SOFTTISSUE_THROW
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
/// The one way an exception leaves the library.
#define SOFTTISSUE_THROW(type, text) throw type(text)
#else
#error "softtissue: exceptions are off; define SOFTTISSUE_THROW(type, text) to something that does not return"
#endif
#endif

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ && !defined(SOFTTISSUE_ALLOW_FINITE_MATH)
#error \
    "softtissue: input and solvers are checked for NaN; compile without -ffast-math/-ffinite-math-only or define SOFTTISSUE_ALLOW_FINITE_MATH"
#endif
