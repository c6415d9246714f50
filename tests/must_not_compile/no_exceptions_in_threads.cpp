// What catches exceptions says that it needs them.
// expect: core/thread_executor.hpp needs exceptions
// flags: -fno-exceptions
#define SOFTTISSUE_THROW(type, text) __builtin_abort()

#include <softtissue/core/thread_executor.hpp>
