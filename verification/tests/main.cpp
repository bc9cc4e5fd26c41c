// Compiled once: the unit tests (readers, meshes, oracles, orders), not of the method.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
