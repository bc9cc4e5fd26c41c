// Compiled once: the tests of the machinery (readers, meshes, oracles, orders), not of the method.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
