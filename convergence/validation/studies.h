// Validations: is what is simulated like something measured, or like the continuum that the paper
// means? Studies of a kind of their own.
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study heavy_cantilever_study();  // heavy-cantilever: over five decades of weight
Study strip_tests_study();       // strip-tests: a laboratory's loops, rings and wrinkles

}  // namespace foldproof
