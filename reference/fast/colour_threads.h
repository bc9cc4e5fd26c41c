// For speed alone: springs of one colour share no particle, so threads may correct
// them concurrently.
#pragma once

#include <functional>
#include <vector>

namespace foldproof {

/// Calls run(first, last, thread) so that every spring of every colour is in exactly one part
/// [first, last), with thread in 0 .. threads - 1. The parts of a colour run concurrently, one per
/// thread; a colour starts when the one before it has finished.
///   colours   first spring of each colour, then the number of springs
void run_colours_on_threads(const std::vector<int>& colours, int threads,
                            const std::function<void(int first, int last, int thread)>& run);

}  // namespace foldproof
