// Loops on several threads: the ranges they get, their order and their errors; points out of reach.
#include <atomic>
#include <barrier>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

#include "reference/fast/out_of_reach.h"
#include "reference/fast/elements.h"
#include "reference/fast/vectors.h"

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

struct Link {
  int a, b;
};

/// Five links of six particles, divided among a team.
Elements<Link> chain(const Team& team) {
  Elements<Link> links{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}};
  links.divide(team, 6);
  return links;
}

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

TEST_CASE("threads: the parts of a loop are under way at once") {
  if (std::thread::hardware_concurrency() < 2) return;
  std::barrier both_have_begun(2);
  std::set<std::thread::id> threads;
  std::mutex guard;
  in_parallel(2, [&](int) {
    both_have_begun.arrive_and_wait();
    const std::lock_guard lock(guard);
    threads.insert(std::this_thread::get_id());
  });
  CHECK(threads.size() == 2);
  CHECK(threads.contains(std::this_thread::get_id()));  // the caller works too
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
  CHECK(ranges_of(3, 0) == std::vector<Range>{{0, 0}, {0, 0}, {0, 0}});
}

TEST_CASE("threads: a team has at least one") {
  CHECK_THROWS_AS(Team(0), InputError);
  CHECK(Team().threads() == 1);
  CHECK(Team(3).threads() == 3);
}

TEST_CASE("threads: each item comes with its index") {
  const std::vector<int> items{10, 11, 12, 13, 14, 15, 16};
  for (const int threads : {1, 2, 3}) {
    std::vector<std::atomic<int>> seen(items.size()), indices(items.size());
    for_each_item(threads, items, [&](int item, size_t k) { seen[k] += item; });
    for_each_index(threads, 7, [&](Eigen::Index i) { indices[size_t(i)] += int(i) + 1; });
    for (size_t k = 0; k < items.size(); ++k) {
      CHECK(seen[k] == items[k]);
      CHECK(indices[k] == int(k) + 1);
    }
  }
}

TEST_CASE("threads: batches of 8192 start from the same value, in order") {
  const std::vector<int> items(8192 + 3, 1);
  for (const int threads : {1, 2})
    CHECK(for_each_with(threads, items, 100, [](int item, int& own) { own += item; }) ==
          std::vector<int>{8292, 103});
}

TEST_CASE("threads: acts in order, and asks anew what an act has changed") {
  // each act takes from its right neighbour, which may then have nothing left
  for (const int threads : {1, 2, 3}) {
    std::vector<int> left{1, 0, 2, 1, 1, 0, 1};
    std::vector<char> changed(left.size(), 0);
    const std::vector<int> items{0, 1, 2, 3, 4, 5, 6};
    std::vector<int> acted;
    const long count = act_in_order(
        threads, items,
        [&](int k) { return left[size_t(k)] > 0 ? std::optional(left[size_t(k)]) : std::nullopt; },
        [&](int k) { return changed[size_t(k)] != 0; },
        [&](int k, int amount) {
          acted.push_back(10 * k + amount);
          if (k == 6) return;
          left[size_t(k) + 1] = k == 4 ? 5 : 0;
          changed[size_t(k) + 1] = 1;
        });
    CHECK(count == 4);
    CHECK(acted == std::vector<int>{1, 22, 41, 55});
  }
}

TEST_CASE("threads: columns are assigned and evaluated whole") {
  PerParticle3 x(3, 7);
  for (int i = 0; i < 21; ++i) x(i % 3, i / 3) = 0.3 + 0.7 * i;
  for (const int threads : {1, 2, 3}) {
    PerParticle3 doubled;
    set(threads, doubled, 2 * x);
    REQUIRE(doubled.cols() == 7);
    for (int i = 0; i < 21; ++i) CHECK(doubled(i % 3, i / 3) == 2 * (0.3 + 0.7 * i));
    PerParticle3 y = PerParticle3::Constant(3, 2, -0.4);
    set(threads, y, x);
    CHECK(y == x);
    set(threads, y, 3 * y);
    CHECK(y == PerParticle3(3 * x));
  }
}

TEST_CASE("threads: findings come in the order of the items") {
  const auto odd_ones = [](Eigen::Index first, Eigen::Index count, std::vector<long>& found) {
    for (Eigen::Index i = first; i < first + count; ++i)
      if (i % 2 == 1) found.push_back(i);
  };
  for (const int threads : {1, 2, 3, 4})
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
  Elements<double> terms;
  for (int k = 0; k < 3 * 8192 + 5; ++k)
    terms.push_back(k == 0 ? huge : k == 8191 || k == 8192 || k == 8193);
  CHECK(terms.sum(terms, [](double term, double) { return term; }) == huge + 2);
}

TEST_CASE("elements: sums, largest terms and lists made of two lists") {
  for (const int threads : {1, 2, 3}) {
    const Elements<Link> links = chain(threads);
    const Elements<int> sums = links.map([](const Link& link) { return link.a + link.b; });
    CHECK(std::vector<int>(sums.begin(), sums.end()) == std::vector<int>{1, 3, 5, 7, 9});
    const auto product = [](const Link& link, int sum) { return double(link.a * sum); };
    CHECK(links.sum(sums, product) == 3 + 10 + 21 + 36);
    CHECK(links.largest(sums, product) == 36);
    CHECK(links.map(sums, product)[3] == 21);
  }
  CHECK(Elements<double>().largest(Elements<double>(), [](double, double) { return 1.; }) == 0);
}

TEST_CASE("elements: a list behind another is not divided any more") {
  Elements<Link> links = chain(2);
  links.append({{5, 0}});
  CHECK(links.size() == 6);
  PerParticle touched = PerParticle::Zero(6);
  links.push(touched, [](const Link& link, const auto& to) { to.add(link.b, 1.0); });
  CHECK(touched == PerParticle::Ones(6));
}

TEST_CASE("elements: a thread has its particles from its first to the one before its end") {
  const OwnedParticles three{3, 6, {}};
  for (const int own : {3, 4, 5}) CHECK(three.has(own));
  for (const int other : {0, 2, 6, 7}) CHECK_FALSE(three.has(other));
  CHECK(AllParticles::has(7));
}

TEST_CASE("elements: particles are divided evenly, for more than one thread only") {
  const Division division = divide(3, 17, {});
  REQUIRE(division->owners.size() == 3);
  CHECK(division->elements == 0);
  CHECK(division->owners[0].first == 0);
  CHECK(division->owners[0].end == 5);
  CHECK(division->owners[1].first == 5);
  CHECK(division->owners[1].end == 11);
  CHECK(division->owners[2].first == 11);
  CHECK(division->owners[2].end == 17);
  CHECK_FALSE(divide(1, 17, {}));
}

TEST_CASE(
    "elements: one that touches a thread's particle is in its runs, and they are of one kind") {
  const auto runs_of = [](const Division& division, size_t thread) {
    std::vector<std::array<size_t, 3>> runs;
    for (const ElementRun& run : division->owners.at(thread).runs)
      runs.push_back({run.first, run.end, size_t(run.is_inside)});
    return runs;
  };
  using Runs = std::vector<std::array<size_t, 3>>;
  const Division hinges = divide(2, 6, {{0, 1, 2, 3}, {3, 4, 5, 2}, {5, 4, 3, 5}, {0, 1, 2, 1}});
  CHECK(runs_of(hinges, 0) == Runs{{0, 2, 0}, {3, 4, 1}});
  CHECK(runs_of(hinges, 1) == Runs{{0, 2, 0}, {2, 3, 1}});
  const Division mixed =
      divide(2, 6, {{0, 1, 0, 1}, {1, 2, 1, 2}, {4, 5, 4, 5}, {0, 2, 3, 4}, {2, 5, 2, 5}});
  CHECK(mixed->elements == 5);
  CHECK(runs_of(mixed, 0) == Runs{{0, 2, 1}, {3, 5, 0}});
  CHECK(runs_of(mixed, 1) == Runs{{2, 3, 1}, {3, 5, 0}});
}

TEST_CASE("elements: every particle adds up its elements in ascending order") {
  for (const int threads : {1, 2, 3}) {
    PerParticle3 met = PerParticle3::Zero(3, 6);
    PerParticle digits = PerParticle::Zero(6);
    chain(threads).push(digits, [&](const Link& link, const auto& to) {
      // shifts the digits that are there, so that the order counts
      for (const int i : {link.a, link.b}) to.add(i, 9 * digits[i] + link.a + 1);
    });
    CHECK(digits == (PerParticle(6) << 1, 12, 23, 34, 45, 5).finished());
    chain(threads).push(met, [](const Link& link, const auto& to) {
      to.add(link.a, Vector3(1, 0, 0));
      to.add(link.b, Vector3(0, 0, 2));
    });
    CHECK(met.col(0) == Vector3(1, 0, 0));
    CHECK(met.col(3) == Vector3(1, 0, 2));
  }
}

TEST_CASE("elements: a list that was changed since it was divided is refused") {
  Elements<Link> more = chain(2);
  more.push_back({5, 0});
  PerParticle f = PerParticle::Zero(6);
  CHECK_THROWS_WITH(more.push(f, [](const Link&, const auto&) {}),
                    "elements were added or removed");
}

TEST_CASE("elements: an error is that of the first element that one thread would meet") {
  PerParticle f = PerParticle::Zero(6);
  const auto fail = [](const Link& link, const auto&) {
    if (link.a >= 1) throw std::runtime_error("element " + std::to_string(link.a));
  };
  CHECK_THROWS_WITH(chain(3).push(f, fail), "element 1");
  CHECK_THROWS_WITH(chain(3).map([](const Link& link) -> int {
    throw std::runtime_error("element " + std::to_string(link.a));
  }),
                    "element 0");
}

TEST_CASE("elements: an error that does not come again is thrown all the same") {
  PerParticle f = PerParticle::Zero(6);
  std::atomic<int> calls = 0;
  const auto fail_once = [&](const Link&, const auto&) {
    if (++calls == 1) throw std::runtime_error("once");
  };
  CHECK_THROWS_WITH(chain(2).push(f, fail_once), "once");
}

TEST_CASE("a point is out of reach if its clearance is more than the way it may go") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  RememberedQuery over(objects, {0, 0, 0.1});
  over.at({0.3, -0.7, 0.5});
  // 0.125 m beside the query: clearance 0.5 - 2 * 0.125 = 0.25 m
  const Vector3 p(0.3, -0.575, 0.5);
  CHECK(over.out_of_reach(p, {0, 0.4, 0.3}, 0.49));        // 0.245 m
  CHECK_FALSE(over.out_of_reach(p, {0, 0.4, 0.3}, 0.51));  // 0.255 m
  CHECK(over.out_of_reach(p, {0, 1.6, 1.2}, 0.12));        // 0.24 m
  CHECK_FALSE(over.out_of_reach(p, {0, 1.6, 1.2}, 0.13));  // 0.26 m
  CHECK(over.out_of_reach(p, Vector3::Zero(), 30));
}

TEST_CASE("clearance shrinks by twice the distance from the query, and none is not enough") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  RememberedQuery over(objects, {0, 0, 0.1});
  over.at({0.3, -0.7, 0.5});
  CHECK(over.out_of_reach({0.54, -0.7, 0.5}, Vector3::Zero(), 0.2));
  CHECK_FALSE(over.out_of_reach({0.56, -0.7, 0.5}, Vector3::Zero(), 0.2));
  CHECK_FALSE(over.out_of_reach({1.3, -0.7, 0.5}, {0.1, 0, 0}, 0.2));
  over.at({0.3, -0.7, -0.5});  // inside: not out of reach, though far from the surface
  CHECK_FALSE(over.out_of_reach({0.3, -0.7, -0.5}, {0.1, 0, 0}, 0.2));
}

TEST_CASE("clearances of more than a metre count as well as small ones") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  RememberedQuery over(objects, {0, 0, 0.1});
  over.at({0.3, -0.7, 7.5});
  CHECK(over.out_of_reach({0.3, -0.7, 7.5}, {3, 0, 0}, 2.4));        // 7.2 m
  CHECK_FALSE(over.out_of_reach({0.3, -0.7, 7.5}, {3, 0, 0}, 2.6));  // 7.8 m
}

TEST_CASE("it is the velocity against the object that brings a point within reach") {
  const Vector3 fast(0, 3, 4);
  const std::vector<Object> objects{half_space(fast, 0)};
  RememberedQuery over(objects, {0, 0, 0.1});
  const Vector3 p(0.3, -0.7, 0.5);
  over.at(p);
  CHECK(over.out_of_reach(p, fast, 10));
  CHECK(over.out_of_reach(p, Vector3::Zero(), 0.09));        // 5 m/s: 0.45 m
  CHECK_FALSE(over.out_of_reach(p, Vector3::Zero(), 0.11));  // 0.55 m
}

TEST_CASE("a point is out of reach only if every object is") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), -0.9), half_space({0, 3, 4}, -0.2)};
  RememberedQuery over(objects, {0, 0, 0.1});
  const Vector3 p(0.3, -0.7, 0.5), v(0, 0.3, 0.4);  // clearances 1.4 m and 0.7 m
  for (const bool reversed : {false, true}) {
    const auto answers = over.at(p);
    if (reversed) std::swap(answers[0], answers[1]);
    // against the second object 4.5 m/s: 0.63 m and 0.72 m
    CHECK(over.out_of_reach(p, v, 0.14));
    CHECK_FALSE(over.out_of_reach(p, v, 0.16));
    // along with the second object 5 m/s against the first: 1.35 m and 1.45 m
    CHECK(over.out_of_reach(p, {0, 3, 4}, 0.27));
    CHECK_FALSE(over.out_of_reach(p, {0, 3, 4}, 0.29));
  }
}

TEST_CASE("without a query, or with an answer that knows no distance, nothing is out of reach") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  RememberedQuery over(objects, {0, 0, 0.1});
  const Vector3 p(0.3, -0.7, 0.5);
  CHECK_FALSE(over.out_of_reach(p, Vector3::Zero(), 0.2));
  over.at({0.3, -0.7, std::numeric_limits<double>::infinity()});
  CHECK_FALSE(over.out_of_reach(p, Vector3::Zero(), 0.2));
  const RememberedQuery nothing(std::span<const Object>(), {0, 0, 0.1});
  CHECK(nothing.out_of_reach(p, {0.3, 0.2, 0.1}, 0.2));
}
