// For speed alone: loops on several threads, with the same bits for every number of them.
//
// A loop over particles that never mixes them may be divided anywhere. A sum is taken in blocks of
// a fixed size, and their sums are added in order. Elements that push on particles (springs,
// hinges) are shared out by particle: each thread owns a range of particles, visits the elements
// that touch it in ascending order, and adds to its own particles only. So each particle adds up
// the same numbers in the same order as on one thread. An element across a border is computed by
// each of its owners.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "reference/types.h"

namespace foldproof {

/// Calls act(k) for k from 0 to parts - 1, each on a thread of its own. If some throw, rethrows
/// what the lowest k threw, after all have ended.
void in_parallel(int parts, const std::function<void(int)>& act);

/// act(arguments...), flattened: its loop holds all that it calls, whose results would else pass
/// through memory.
template <class Act, class... Arguments>
[[gnu::flatten, gnu::noinline]] void call(const Act& act, const Arguments&... arguments) {
  act(arguments...);
}

/// Calls act(first, count) for consecutive ranges of n items, one a thread.
template <class Act>
void for_each_range(int threads, Eigen::Index n, const Act& act) {
  if (threads <= 1) return call(act, Eigen::Index(0), n);
  in_parallel(threads, [&](int k) {
    const Eigen::Index first = n * k / threads, end = n * (k + 1) / threads;
    call(act, first, end - first);
  });
}

/// Calls act(part of the elements, index of its first) likewise.
template <class Element, class Allocator, class Act>
void for_each_range(int threads, const std::vector<Element, Allocator>& elements, const Act& act) {
  const std::span<const Element> all(elements);
  for_each_range(threads, Eigen::Index(all.size()), [&](Eigen::Index first, Eigen::Index count) {
    act(all.subspan(size_t(first), size_t(count)), size_t(first));
  });
}

/// to = columns, where each column depends on the same column of others only; `to`
/// may be among them.
template <class Columns>
void assign(int threads, PerParticle3& to, const Eigen::MatrixBase<Columns>& columns) {
  to.resize(3, columns.cols());
  for_each_range(threads, to.cols(), [&](Eigen::Index first, Eigen::Index count) {
    to.middleCols(first, count) = columns.middleCols(first, count);
  });
}

/// The same as a value.
template <class Columns>
PerParticle3 evaluated(int threads, const Eigen::MatrixBase<Columns>& columns) {
  PerParticle3 result;
  assign(threads, result, columns);
  return result;
}

/// What find(first, count, found) appends to `found` for consecutive ranges of n items, in order.
template <class Found, class Find>
std::vector<Found> found_in_order(int threads, Eigen::Index n, const Find& find) {
  std::vector<std::vector<Found>> parts(static_cast<size_t>(std::max(1, threads)));
  if (threads <= 1) {
    find(Eigen::Index(0), n, parts[0]);
    return std::move(parts[0]);
  }
  in_parallel(threads, [&](int k) {
    const Eigen::Index first = n * k / threads, end = n * (k + 1) / threads;
    find(first, end - first, parts[size_t(k)]);
  });
  for (size_t k = 1; k < parts.size(); ++k)
    parts[0].insert(parts[0].end(), parts[k].begin(), parts[k].end());
  return std::move(parts[0]);
}

// Items in a block of a sum, where no smaller block rounds better.
inline constexpr Eigen::Index block_of_sums = 8192;

/// Calls act(first, count) for blocks of n items: for loops whose work, but not whose results,
/// depend on where they start.
template <class Act>
void for_each_block(int threads, Eigen::Index n, Eigen::Index block, const Act& act) {
  for_each_range(threads, (n + block - 1) / block, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index b = first; b < first + count; ++b)
      act(b * block, std::min(block, n - b * block));
  });
}

/// The sum of part(first, count) over blocks of n items, block by block: a long sum rounds less so.
template <class Part>
double sum_of_blocks(int threads, Eigen::Index n, Eigen::Index block, const Part& part) {
  std::vector<double> sums(static_cast<size_t>((n + block - 1) / block));
  for_each_block(threads, n, block, [&](Eigen::Index first, Eigen::Index count) {
    sums[size_t(first / block)] = part(first, count);
  });
  double sum = 0;
  for (const double one : sums) sum += one;
  return sum;
}

/// The sum of term(element), in blocks.
template <class Element, class Term>
double sum_over(int threads, const std::vector<Element>& elements, const Term& term) {
  const auto n = Eigen::Index(elements.size());
  return sum_of_blocks(threads, n, block_of_sums, [&](Eigen::Index first, Eigen::Index count) {
    double sum = 0;
    for (Eigen::Index e = first; e < first + count; ++e) sum += term(elements[size_t(e)]);
    return sum;
  });
}

/// Consecutive elements; is_inside: all their particles belong to the share.
struct ElementRun {
  size_t first, end;
  bool is_inside;
};

/// A thread's particles, first to end - 1, and the elements that touch them, in ascending order.
struct Share {
  int first, end;
  std::vector<ElementRun> runs;

  bool has(int particle) const { return first <= particle && particle < end; }
};

/// The share of the only thread, and of a run inside a share.
struct AllParticles {
  static constexpr bool has(int) { return true; }
};

/// How elements are shared out; one thread takes all if there are no shares.
struct SharedOut {
  size_t elements = 0;
  std::vector<Share> shares;
};
using Sharing = std::shared_ptr<const SharedOut>;  // null: one thread

inline int threads_of(const Sharing& sharing) { return sharing ? int(sharing->shares.size()) : 1; }

/// Shares out elements with these particles among threads, N particles in even ranges.
///   elements   of each its particles; a spring's are listed twice
Sharing share_out(int threads, Eigen::Index particles,
                  const std::vector<std::array<int, 4>>& elements);

/// Calls act(part of the elements, own) for each thread's runs; act adds to a particle i only if
/// own.has(i). If act throws, the exception is that of one thread.
template <class Element, class Allocator, class Act>
void for_each_run(const Sharing& sharing, const std::vector<Element, Allocator>& elements,
                  const Act& act) {
  const std::span<const Element> all(elements);
  if (!sharing) return call(act, all, AllParticles{});
  if (sharing->elements != all.size()) throw std::logic_error("elements of another sharing");
  try {
    in_parallel(int(sharing->shares.size()), [&](int k) {
      const Share& own = sharing->shares[size_t(k)];
      for (const ElementRun& run : own.runs) {
        const auto part = all.subspan(run.first, run.end - run.first);
        run.is_inside ? call(act, part, AllParticles{}) : call(act, part, own);
      }
    });
  } catch (...) {
    call(act, all, AllParticles{});  // throws at the first element that one thread would meet
    throw;
  }
}

/// An allocator that leaves new elements of a vector unfilled, for threads to fill.
template <class T>
struct Unfilled : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Unfilled<U>;
  };
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U{std::forward<Arguments>(arguments)...};
  }
};

}  // namespace foldproof
