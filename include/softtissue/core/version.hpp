// SPDX-License-Identifier: MIT
/// @file
/// The version of the library, for programs that must work with several.
///
/// What        SOFTTISSUE_VERSION_MAJOR, _MINOR, _PATCH, to be used in #if. The only place where the version is written:
///             CMake reads it from here, packages and documentation take it from CMake.
/// Promise     while the major number is 0, another minor number may have another interface
/// Tests       tests/unit/core/version_test.cpp, tests/consumer
#pragma once

#define SOFTTISSUE_VERSION_MAJOR 0  ///< changes with the interface
#define SOFTTISSUE_VERSION_MINOR 1  ///< grows with what is added
#define SOFTTISSUE_VERSION_PATCH 0  ///< grows with what is mended
