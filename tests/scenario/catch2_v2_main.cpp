// Catch2 v2 brings no main of its own; v3 does.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
