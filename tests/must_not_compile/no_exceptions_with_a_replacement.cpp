// With a replacement for throw the library compiles without exceptions.
// expect: success
// flags: -fno-exceptions
#include <cstdlib>

#define SOFTTISSUE_THROW(type, text) std::abort()

#include <softtissue/softtissue.hpp>

int main() { softtissue::require(true, "never seen"); }
