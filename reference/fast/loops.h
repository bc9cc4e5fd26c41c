// For speed only: loops on several threads, with the same bits for any number of threads.
//
// A loop over items that never mixes them may be divided anywhere. A sum is taken in blocks of a
// fixed size, and their sums are added in order.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "reference/fast/team.h"
#include "reference/types.h"

namespace foldproof {

/// Calls act(k) for k from 0 to parts - 1, in parallel as far as there are cores: no part may wait
/// for another. Waits for all; then rethrows the exception of the lowest k, if any.
void in_parallel(int parts, const std::function<void(int)>& act);

/// Calls act(arguments...) with every function inlined into its loop, so that results
/// stay in registers.
template <class Act, class... Arguments>
[[gnu::flatten, gnu::noinline]] void call(const Act& act, const Arguments&... arguments) {
  act(arguments...);
}

/// Calls act(first, count) for consecutive ranges of n items, one per thread.
template <class Act>
void for_each_range(const Team& team, Eigen::Index n, const Act& act) {
  const int threads = team.threads();
  if (threads == 1) return call(act, Eigen::Index(0), n);
  in_parallel(threads, [&](int k) {
    const Eigen::Index first = n * k / threads, end = n * (k + 1) / threads;
    call(act, first, end - first);
  });
}

/// Calls act(item, its index) for each; act may write only to the place of its item.
template <class Items, class Act>
void for_each_item(const Team& team, const Items& items, const Act& act) {
  for_each_range(team, Eigen::Index(items.size()), [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index k = first; k < first + count; ++k) act(items[size_t(k)], size_t(k));
  });
}

/// Calls act(i) for i from 0 to n - 1; act may write only to the place of its index.
template <class Act>
void for_each_index(const Team& team, Eigen::Index n, const Act& act) {
  for_each_range(team, n, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index i = first; i < first + count; ++i) act(i);
  });
}

/// Calls find(first, count, found) for consecutive ranges of n items; each call appends to its own
/// `found`. Returns these lists joined, in order.
template <class Found, class Find>
std::vector<Found> found_in_order(const Team& team, Eigen::Index n, const Find& find) {
  const int threads = team.threads();
  std::vector<std::vector<Found>> parts(static_cast<size_t>(threads));
  if (threads == 1) {
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

/// The items for which find(item) has a value, and those values, in order.
template <class Found, class Items, class Find>
std::vector<Found> found_among(const Team& team, const Items& items, const Find& find) {
  return found_in_order<Found>(
      team, Eigen::Index(items.size()),
      [&](Eigen::Index first, Eigen::Index count, std::vector<Found>& found) {
        for (Eigen::Index k = first; k < first + count; ++k)
          if (std::optional<Found> one = find(items[size_t(k)])) found.push_back(*one);
      });
}

/// Calls act(item, answer) in order for each item whose ask(item) has a value. An act may change
/// the answers of later items: has_changed(item) marks these. Several threads call ask in advance;
/// for a marked item it is called again. Returns the number of acts.
template <class Items, class Ask, class HasChanged, class Act>
long act_in_order(const Team& team, const Items& items, const Ask& ask,
                  const HasChanged& has_changed, const Act& act) {
  std::vector<char> has_none(team.threads() > 1 ? items.size() : 0);
  if (!has_none.empty())
    for_each_item(team, items, [&](const auto& item, size_t k) { has_none[k] = !ask(item); });
  long acted = 0;
  for (size_t k = 0; k < items.size(); ++k) {
    if (!has_none.empty() && has_none[k] && !has_changed(items[k])) continue;
    const auto answer = ask(items[k]);
    if (!answer) continue;
    act(items[k], *answer);
    ++acted;
  }
  return acted;
}

// Block size for long sums; smaller blocks do not reduce the rounding error further.
inline constexpr Eigen::Index block_of_sums = 8192;

/// Calls act(first, count) for blocks of n items: for loops whose cost, but not result, depends on
/// where blocks start.
template <class Act>
void for_each_block(const Team& team, Eigen::Index n, Eigen::Index block, const Act& act) {
  for_each_range(team, (n + block - 1) / block, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index b = first; b < first + count; ++b)
      act(b * block, std::min(block, n - b * block));
  });
}

/// Calls act(item, own) in order, in batches of a fixed size; `own` is a copy of `start` for each
/// batch. Returns the copies in order.
template <class Items, class Own, class Act>
std::vector<Own> for_each_with(const Team& team, const Items& items, const Own& start,
                               const Act& act) {
  const auto n = Eigen::Index(items.size());
  std::vector<Own> batches(size_t(n / block_of_sums + 1), start);
  for_each_block(team, n, block_of_sums, [&](Eigen::Index first, Eigen::Index count) {
    Own& own = batches[size_t(first / block_of_sums)];
    for (Eigen::Index k = first; k < first + count; ++k) act(items[size_t(k)], own);
  });
  return batches;
}

/// The sum of part(first, count) over blocks of n items, block by block, which reduces the rounding
/// error of long sums.
template <class Part>
double sum_of_blocks(const Team& team, Eigen::Index n, Eigen::Index block, const Part& part) {
  std::vector<double> sums(static_cast<size_t>((n + block - 1) / block));
  for_each_block(team, n, block, [&](Eigen::Index first, Eigen::Index count) {
    sums[size_t(first / block)] = part(first, count);
  });
  double sum = 0;
  for (const double one : sums) sum += one;
  return sum;
}

}  // namespace foldproof
