// Loops on several threads: the ranges they get, their order and their errors; points out of reach.
#include <atomic>
#include <barrier>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

#include "reference/fast/out_of_reach.h"
#include "reference/fast/loops.h"

using namespace foldproof;

namespace {

using Range = std::pair<long, long>;  // first, count

/// The ranges that n items are divided into among threads, in ascending order.
std::vector<Range> ranges_of(int threads, long n) {
  std::vector<Range> ranges;
  std::mutex guard;
  for_each_range(threads, Eigen::Index(n), [&](Eigen::Index first, Eigen::Index count) {
    const std::lock_guard lock(guard);
    ranges.push_back({first, count});
  });
  std::ranges::sort(ranges);
  return ranges;
}

std::vector<Range> blocks_of(int threads, long n, long block) {
  std::vector<Range> blocks;
  std::mutex guard;
  for_each_block(threads, n, block, [&](Eigen::Index first, Eigen::Index count) {
    const std::lock_guard lock(guard);
    blocks.push_back({first, count});
  });
  std::ranges::sort(blocks);
  return blocks;
}

using Elements = std::vector<std::array<int, 4>>;
const Elements chain{{0, 1, 0, 1}, {1, 2, 1, 2}, {2, 3, 2, 3}, {3, 4, 3, 4}, {4, 5, 4, 5}};

/// The half-space z < 0, moving at `velocity` [m/s] and raised by `height` [m].
Object half_space(const Vector3& velocity, double height) {
  Motion motion;
  motion.velocity = velocity;
  return {"ground",
          RigidObject{HalfSpace{}, {Eigen::Quaterniond::Identity(), {0, 0, height}}, motion}, 0.3};
}

}  // namespace

TEST_CASE("threads: each part is done once, whatever the number of parts") {
  for (const int parts : {3, 1, 4, 2, 2}) {
    std::vector<std::atomic<int>> times(static_cast<size_t>(parts));
    in_parallel(parts, [&](int k) { ++times[size_t(k)]; });
    for (const std::atomic<int>& one : times) CHECK(one == 1);
  }
}

TEST_CASE("threads: a loop waits for its last part") {
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> ended = 0;
    in_parallel(3, [&](int k) {
      for (int i = 0; i < 40 * k; ++i) std::this_thread::yield();
      ++ended;
    });
    CHECK(ended == 3);
  }
}

TEST_CASE("threads: parts are on threads of their own, again and again") {
  for (int round = 0; round < 5; ++round) {
    std::barrier all_have_begun(3);
    std::mutex guard;
    std::set<std::thread::id> threads;
    in_parallel(3, [&](int) {
      all_have_begun.arrive_and_wait();
      const std::lock_guard lock(guard);
      threads.insert(std::this_thread::get_id());
    });
    CHECK(threads.size() == 3);
    CHECK(threads.contains(std::this_thread::get_id()));  // the caller works too
  }
}

TEST_CASE("threads: a caller that has done its part sleeps until the others have ended") {
  std::barrier all_have_begun(2);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> other_ended = false;
  in_parallel(2, [&](int) {
    all_have_begun.arrive_and_wait();
    if (std::this_thread::get_id() == caller) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    other_ended = true;
  });
  CHECK(other_ended);
}

TEST_CASE("threads: helpers are kept for the next loop, and loops of one thread do without") {
  static thread_local int rounds_here = 0;
  const auto rounds_of_each = [] {
    std::barrier all_have_begun(3);
    std::array<int, 3> rounds{};
    in_parallel(3, [&](int k) {
      all_have_begun.arrive_and_wait();
      rounds[size_t(k)] = ++rounds_here;
    });
    return rounds;
  };
  CHECK(rounds_of_each() == std::array{1, 1, 1});
  CHECK(rounds_of_each() == std::array{2, 2, 2});
  CHECK(ranges_of(1, 7).size() == 1);
  CHECK(rounds_of_each() == std::array{3, 3, 3});
  found_in_order<int>(1, 7, [](Eigen::Index, Eigen::Index, std::vector<int>&) {});
  CHECK(rounds_of_each() == std::array{4, 4, 4});
}

TEST_CASE("threads: what the lowest part threw is thrown, after all parts have ended") {
  std::atomic<int> ended = 0;
  const auto some_throw = [&](int k) {
    ++ended;
    if (k != 1) throw std::runtime_error("part " + std::to_string(k));
  };
  CHECK_THROWS_WITH(in_parallel(4, some_throw), "part 0");
  CHECK(ended == 4);
  CHECK_THROWS_WITH(in_parallel(3,
                                [](int k) {
                                  if (k == 2) throw std::runtime_error("the last");
                                }),
                    "the last");
  CHECK_NOTHROW(in_parallel(3, [](int) {}));
}

TEST_CASE("threads: ranges follow each other and make up the whole") {
  CHECK(ranges_of(3, 17) == std::vector<Range>{{0, 5}, {5, 6}, {11, 6}});
  CHECK(ranges_of(2, 7) == std::vector<Range>{{0, 3}, {3, 4}});
  CHECK(ranges_of(1, 7) == std::vector<Range>{{0, 7}});
  CHECK(ranges_of(0, 7) == std::vector<Range>{{0, 7}});
  CHECK(ranges_of(3, 0) == std::vector<Range>{{0, 0}, {0, 0}, {0, 0}});
}

TEST_CASE("threads: parts of a vector come with the index of their first element") {
  const std::vector<int> elements{10, 11, 12, 13, 14, 15, 16};
  for (const int threads : {1, 2, 3}) {
    std::vector<std::atomic<int>> seen(elements.size());
    for_each_range(threads, elements, [&](std::span<const int> part, size_t first) {
      for (size_t i = 0; i < part.size(); ++i) seen[first + i] += part[i];
    });
    for (size_t i = 0; i < elements.size(); ++i) CHECK(seen[i] == elements[i]);
  }
}

TEST_CASE("threads: columns are assigned and evaluated whole") {
  PerParticle3 x(3, 7);
  for (int i = 0; i < 21; ++i) x(i % 3, i / 3) = 0.3 + 0.7 * i;
  for (const int threads : {1, 2, 3}) {
    const PerParticle3 doubled = evaluated(threads, 2 * x);
    REQUIRE(doubled.cols() == 7);
    for (int i = 0; i < 21; ++i) CHECK(doubled(i % 3, i / 3) == 2 * (0.3 + 0.7 * i));
    PerParticle3 y = PerParticle3::Constant(3, 2, -0.4);
    assign(threads, y, x);
    CHECK(y == x);
    assign(threads, y, 3 * y);
    CHECK(y == PerParticle3(3 * x));
  }
}

TEST_CASE("threads: findings come in the order of the items") {
  const auto odd_ones = [](Eigen::Index first, Eigen::Index count, std::vector<long>& found) {
    for (Eigen::Index i = first; i < first + count; ++i)
      if (i % 2 == 1) found.push_back(i);
  };
  for (const int threads : {0, 1, 2, 3, 4})
    CHECK(found_in_order<long>(threads, 13, odd_ones) == std::vector<long>{1, 3, 5, 7, 9, 11});
}

TEST_CASE("threads: findings on several threads are looked for in several ranges") {
  std::atomic<int> calls = 0;
  const auto count_calls = [&](Eigen::Index first, Eigen::Index count, std::vector<Range>& found) {
    ++calls;
    found.push_back({first, count});
  };
  CHECK(found_in_order<Range>(2, 7, count_calls) == std::vector<Range>{{0, 3}, {3, 4}});
  CHECK(calls == 2);
  CHECK(found_in_order<Range>(3, 17, count_calls) == std::vector<Range>{{0, 5}, {5, 6}, {11, 6}});
  CHECK(found_in_order<Range>(1, 17, count_calls) == std::vector<Range>{{0, 17}});
}

TEST_CASE("threads: blocks have their size, but the last one what is left") {
  for (const int threads : {1, 2, 3}) {
    CHECK(blocks_of(threads, 11, 4) == std::vector<Range>{{0, 4}, {4, 4}, {8, 3}});
    CHECK(blocks_of(threads, 9, 4) == std::vector<Range>{{0, 4}, {4, 4}, {8, 1}});
    CHECK(blocks_of(threads, 12, 4) == std::vector<Range>{{0, 4}, {4, 4}, {8, 4}});
    CHECK(blocks_of(threads, 3, 4) == std::vector<Range>{{0, 3}});
    CHECK(blocks_of(threads, 0, 4).empty());
  }
}

TEST_CASE("threads: a sum has one part for each block") {
  const auto part = [](Eigen::Index first, Eigen::Index count) {
    return 1000.0 * double(first) + double(count);
  };
  for (const int threads : {1, 2, 3}) {
    CHECK(sum_of_blocks(threads, 11, 4, part) == 12011);
    CHECK(sum_of_blocks(threads, 9, 4, part) == 12009);
    CHECK(sum_of_blocks(threads, 12, 4, part) == 12012);
    CHECK(sum_of_blocks(threads, 0, 4, part) == 0);
  }
}

TEST_CASE("threads: long sums are taken in blocks of 8192, whose sums are added in order") {
  // 2^53 swallows each 1 that is added to it: that of its own block, not the 2 of the next
  const double huge = std::ldexp(1, 53);
  std::vector<double> terms(3 * 8192 + 5, 0);
  terms[0] = huge, terms[8191] = terms[8192] = terms[8193] = 1;
  for (const int threads : {1, 2, 3})
    CHECK(sum_over(threads, terms, [](double term) { return term; }) == huge + 2);
}

TEST_CASE("threads: a sum over elements adds up all their terms") {
  const std::vector<int> elements{3, 5, 11, 17};
  for (const int threads : {1, 2})
    CHECK(sum_over(threads, elements, [](int one) { return 0.5 * one; }) == 18);
  CHECK(sum_over(2, std::vector<int>{}, [](int) { return 0.5; }) == 0);
}

TEST_CASE("threads: a share has its particles from its first to the one before its end") {
  const Share share{3, 6, {}};
  for (const int own : {3, 4, 5}) CHECK(share.has(own));
  for (const int other : {0, 2, 6, 7}) CHECK_FALSE(share.has(other));
  CHECK(AllParticles::has(7));
}

TEST_CASE("threads: particles are shared out evenly, for more than one thread only") {
  const Sharing sharing = share_out(3, 17, {});
  REQUIRE(threads_of(sharing) == 3);
  CHECK(sharing->elements == 0);
  CHECK(sharing->shares[0].first == 0);
  CHECK(sharing->shares[0].end == 5);
  CHECK(sharing->shares[1].first == 5);
  CHECK(sharing->shares[1].end == 11);
  CHECK(sharing->shares[2].first == 11);
  CHECK(sharing->shares[2].end == 17);
  CHECK(threads_of(share_out(2, 17, {})) == 2);
  CHECK_FALSE(share_out(1, 17, {}));
  CHECK_FALSE(share_out(0, 17, {}));
  CHECK(threads_of(nullptr) == 1);
  CHECK(SharedOut().elements == 0);
}

TEST_CASE("threads: an element with one particle in a share belongs to its runs") {
  const Sharing sharing = share_out(2, 6, {{0, 1, 2, 3}, {3, 4, 5, 2}, {5, 4, 3, 5}, {0, 1, 2, 1}});
  const auto runs_of = [&](size_t share) {
    std::vector<std::array<size_t, 3>> runs;
    for (const ElementRun& run : sharing->shares.at(share).runs)
      runs.push_back({run.first, run.end, size_t(run.is_inside)});
    return runs;
  };
  CHECK(runs_of(0) == std::vector<std::array<size_t, 3>>{{0, 2, 0}, {3, 4, 1}});
  CHECK(runs_of(1) == std::vector<std::array<size_t, 3>>{{0, 2, 0}, {2, 3, 1}});
}

TEST_CASE("threads: every particle adds up its elements in ascending order") {
  for (const int threads : {1, 2, 3}) {
    const Sharing sharing = share_out(threads, 6, chain);
    std::vector<std::vector<int>> met(6);
    for_each_run(sharing, chain, [&](std::span<const std::array<int, 4>> part, const auto& own) {
      for (const auto& [a, b, c, d] : part)
        for (const int i : {a, b})
          if (own.has(i)) met[size_t(i)].push_back(a);
    });
    CHECK(met == std::vector<std::vector<int>>{{0}, {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4}});
  }
}

TEST_CASE("threads: runs inside a share own all their particles, and others only the share's") {
  std::atomic<int> inside = 0, across = 0;
  for_each_run(share_out(2, 6, chain), chain,
               [&](std::span<const std::array<int, 4>> part, const auto& own) {
                 (own.has(-1) ? inside : across) += int(part.size());
               });
  CHECK(inside == 4);
  CHECK(across == 2);  // once for each owner
}

TEST_CASE("threads: elements that were not shared out are refused") {
  const Elements fewer(chain.begin(), chain.begin() + 3);
  const auto nothing = [](std::span<const std::array<int, 4>>, const auto&) {};
  CHECK_THROWS_WITH(for_each_run(share_out(2, 6, chain), fewer, nothing),
                    "elements of another sharing");
  CHECK_NOTHROW(for_each_run(share_out(2, 6, chain), chain, nothing));
  CHECK_NOTHROW(for_each_run(nullptr, fewer, nothing));
}

TEST_CASE("threads: an error is that of the first element that one thread would meet") {
  const auto fail = [](std::span<const std::array<int, 4>> part, const auto& own) {
    for (const auto& element : part)
      if (element[0] >= 1 && own.has(element[0]))
        throw std::runtime_error("element " + std::to_string(element[0]));
  };
  CHECK_THROWS_WITH(for_each_run(share_out(3, 6, chain), chain, fail), "element 1");
  const auto fail_backwards = [](std::span<const std::array<int, 4>> part, const auto&) {
    throw std::runtime_error(std::to_string(part.size()) + " elements");
  };
  CHECK_THROWS_WITH(for_each_run(share_out(2, 6, chain), chain, fail_backwards), "5 elements");
}

TEST_CASE("threads: an error that does not come again is thrown all the same") {
  const auto fail_in_parts = [](std::span<const std::array<int, 4>> part, const auto&) {
    if (part.size() < 5) throw std::runtime_error("in a part");
  };
  CHECK_THROWS_WITH(for_each_run(share_out(2, 6, chain), chain, fail_in_parts), "in a part");
}

TEST_CASE("a point is out of reach if its clearance is more than the way it may go") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  ObjectsOverSpan over(objects, {0, 0, 0.1});
  over.at({0.3, -0.7, 0.5});
  // 0.125 m beside the query: clearance 0.5 - 2 * 0.125 = 0.25 m
  const Vector3 p(0.3, -0.575, 0.5);
  CHECK(out_of_reach(over, p, {0, 0.4, 0.3}, 0.49));        // 0.245 m
  CHECK_FALSE(out_of_reach(over, p, {0, 0.4, 0.3}, 0.51));  // 0.255 m
  CHECK(out_of_reach(over, p, {0, 1.6, 1.2}, 0.12));        // 0.24 m
  CHECK_FALSE(out_of_reach(over, p, {0, 1.6, 1.2}, 0.13));  // 0.26 m
  CHECK(out_of_reach(over, p, Vector3::Zero(), 30));
}

TEST_CASE("clearance shrinks by twice the distance from the query, and none is not enough") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  ObjectsOverSpan over(objects, {0, 0, 0.1});
  over.at({0.3, -0.7, 0.5});
  CHECK(out_of_reach(over, {0.54, -0.7, 0.5}, Vector3::Zero(), 0.2));
  CHECK_FALSE(out_of_reach(over, {0.56, -0.7, 0.5}, Vector3::Zero(), 0.2));
  CHECK_FALSE(out_of_reach(over, {1.3, -0.7, 0.5}, {0.1, 0, 0}, 0.2));
  over.at({0.3, -0.7, -0.5});  // inside: not out of reach, though far from the surface
  CHECK_FALSE(out_of_reach(over, {0.3, -0.7, -0.5}, {0.1, 0, 0}, 0.2));
}

TEST_CASE("clearances of more than a metre count as well as small ones") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  ObjectsOverSpan over(objects, {0, 0, 0.1});
  over.at({0.3, -0.7, 7.5});
  CHECK(out_of_reach(over, {0.3, -0.7, 7.5}, {3, 0, 0}, 2.4));        // 7.2 m
  CHECK_FALSE(out_of_reach(over, {0.3, -0.7, 7.5}, {3, 0, 0}, 2.6));  // 7.8 m
}

TEST_CASE("it is the velocity against the object that brings a point within reach") {
  const Vector3 fast(0, 3, 4);
  const std::vector<Object> objects{half_space(fast, 0)};
  ObjectsOverSpan over(objects, {0, 0, 0.1});
  const Vector3 p(0.3, -0.7, 0.5);
  over.at(p);
  CHECK(out_of_reach(over, p, fast, 10));
  CHECK(out_of_reach(over, p, Vector3::Zero(), 0.09));        // 5 m/s: 0.45 m
  CHECK_FALSE(out_of_reach(over, p, Vector3::Zero(), 0.11));  // 0.55 m
}

TEST_CASE("a point is out of reach of every object or of none, in any order of answers") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), -0.9), half_space({0, 3, 4}, -0.2)};
  ObjectsOverSpan over(objects, {0, 0, 0.1});
  const Vector3 p(0.3, -0.7, 0.5), v(0, 0.3, 0.4);  // clearances 1.4 m and 0.7 m
  for (const bool reversed : {false, true}) {
    const auto answers = over.at(p);
    if (reversed) std::swap(answers[0], answers[1]);
    // against the second object 4.5 m/s: 0.63 m and 0.72 m
    CHECK(out_of_reach(over, p, v, 0.14));
    CHECK_FALSE(out_of_reach(over, p, v, 0.16));
    // along with the second object 5 m/s against the first: 1.35 m and 1.45 m
    CHECK(out_of_reach(over, p, {0, 3, 4}, 0.27));
    CHECK_FALSE(out_of_reach(over, p, {0, 3, 4}, 0.29));
  }
}

TEST_CASE("without a query, or with an answer that knows no distance, nothing is out of reach") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  ObjectsOverSpan over(objects, {0, 0, 0.1});
  const Vector3 p(0.3, -0.7, 0.5);
  CHECK_FALSE(out_of_reach(over, p, Vector3::Zero(), 0.2));
  over.at(p)[0].phi = std::numeric_limits<double>::infinity();
  CHECK_FALSE(out_of_reach(over, p, Vector3::Zero(), 0.2));
  const ObjectsOverSpan nothing(std::span<const Object>(), {0, 0, 0.1});
  CHECK(out_of_reach(nothing, p, {0.3, 0.2, 0.1}, 0.2));
}
