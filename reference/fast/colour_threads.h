// For speed alone: springs of a colour share no particle, so threads may correct them
// at the same time.
#pragma once

#include <functional>
#include <vector>

namespace foldproof {

/// Calls run(first, last, thread) so that every spring of every colour is in one part [first,
/// last), thread in 0 .. threads - 1. The parts of a colour run at the same time, one each; a
/// colour begins when the one before it is done.
///   colours   where each colour begins among the springs, and their number at the end
void run_colours_on_threads(const std::vector<int>& colours, int threads,
                            const std::function<void(int first, int last, int thread)>& run);

}  // namespace foldproof
