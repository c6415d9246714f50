// Without exceptions the user says what a throw becomes.
// expect: define SOFTTISSUE_THROW\(type, text\)
// flags: -fno-exceptions
#include <softtissue/core/error.hpp>
