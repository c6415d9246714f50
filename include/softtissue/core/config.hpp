// SPDX-License-Identifier: MIT
/// @file
/// The library's three macros; no other configuration exists.
///
/// SOFTTISSUE_ASSERT(condition)       caller bug inside a kernel; gone with NDEBUG; overridable
/// SOFTTISSUE_THROW(type, text)       the one way an exception leaves the library; override it to
///                                    compile with -fno-exceptions (the replacement must not return)
/// SOFTTISSUE_ALLOW_FINITE_MATH       define it to compile solver headers under -ffinite-math-only
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
