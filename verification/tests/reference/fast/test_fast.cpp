// Loops on several threads, and points out of reach.
#include <atomic>
#include <catch2/catch.hpp>
#include <limits>

#include "reference/fast/out_of_reach.h"
#include "reference/fast/elements.h"

using namespace foldproof;

namespace {

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

TEST_CASE("threads: each part is done once, and then what the lowest part threw is thrown") {
  for (const int parts : {3, 1, 4}) {
    std::vector<std::atomic<int>> times(static_cast<size_t>(parts));
    const auto act = [&](int k) {
      ++times[size_t(k)];
      if (k != 1) throw std::runtime_error("part " + std::to_string(k));
    };
    CHECK_THROWS_WITH(in_parallel(parts, act), "part 0");
    for (const std::atomic<int>& one : times) CHECK(one == 1);
  }
  CHECK_THROWS_AS(Team(0), InputError);
}

TEST_CASE("elements: every particle adds up its elements in ascending order") {
  for (const int threads : {1, 2, 3}) {
    PerParticle digits = PerParticle::Zero(6);
    Elements<Link> links = chain(threads);
    const auto append_digit = [&](const Link& link, const auto& to) {
      // shifts the digits that are there, so that the order counts
      for (const int i : {link.a, link.b}) to.add(i, 9 * digits[i] + link.a + 1);
    };
    links.push(digits, append_digit);
    CHECK(digits == (PerParticle(6) << 1, 12, 23, 34, 45, 5).finished());
    links.append({{5, 0}});  // not divided any more
    digits.setZero();
    links.push(digits, append_digit);
    CHECK(digits == (PerParticle(6) << 16, 12, 23, 34, 45, 56).finished());
  }
}

TEST_CASE("elements: an error is that of the first element that one thread would meet") {
  PerParticle f = PerParticle::Zero(6);
  const auto fail = [](const Link& link, const auto&) {
    if (link.a >= 1) throw std::runtime_error("element " + std::to_string(link.a));
  };
  CHECK_THROWS_WITH(chain(3).push(f, fail), "element 1");
  std::atomic<int> calls = 0;  // an error that does not come again is thrown all the same
  const auto fail_once = [&](const Link&, const auto&) {
    if (++calls == 1) throw std::runtime_error("once");
  };
  CHECK_THROWS_WITH(chain(2).push(f, fail_once), "once");
  Elements<Link> more = chain(2);
  more.push_back({5, 0});
  CHECK_THROWS_WITH(more.push(f, fail), "elements were added or removed");
}

TEST_CASE("a point is out of reach if its clearance is more than the way it may go") {
  const std::vector<Object> objects{half_space(Vector3::Zero(), 0)};
  RememberedQuery over(objects, {0, 0, 0.1});
  const Vector3 query(0.3, -0.7, 0.5), still = Vector3::Zero();
  CHECK_FALSE(over.out_of_reach(query, still, 0.2));  // nothing was asked
  over.at(query);
  // 0.125 m beside the query: clearance 0.5 - 2 * 0.125 = 0.25 m
  const Vector3 p(0.3, -0.575, 0.5);
  CHECK(over.out_of_reach(p, {0, 0.4, 0.3}, 0.49));        // 0.245 m
  CHECK_FALSE(over.out_of_reach(p, {0, 0.4, 0.3}, 0.51));  // 0.255 m
  CHECK(over.out_of_reach(p, {0, 1.6, 1.2}, 0.12));        // 0.24 m
  CHECK_FALSE(over.out_of_reach(p, {0, 1.6, 1.2}, 0.13));  // 0.26 m
  CHECK(over.out_of_reach(p, still, 30));
  // no clearance is not enough, beside the query or inside
  CHECK(over.out_of_reach({0.54, -0.7, 0.5}, still, 0.2));
  CHECK_FALSE(over.out_of_reach({0.56, -0.7, 0.5}, still, 0.2));
  CHECK_FALSE(over.out_of_reach({1.3, -0.7, 0.5}, {0.1, 0, 0}, 0.2));
  over.at({0.3, -0.7, -0.5});
  CHECK_FALSE(over.out_of_reach({0.3, -0.7, -0.5}, {0.1, 0, 0}, 0.2));
  over.at({0.3, -0.7, 7.5});
  CHECK(over.out_of_reach({0.3, -0.7, 7.5}, {3, 0, 0}, 2.4));        // 7.2 m
  CHECK_FALSE(over.out_of_reach({0.3, -0.7, 7.5}, {3, 0, 0}, 2.6));  // 7.8 m
  over.at({0.3, -0.7, std::numeric_limits<double>::infinity()});
  CHECK_FALSE(over.out_of_reach(p, still, 0.2));
  CHECK(RememberedQuery({}, {0, 0, 0.1}).out_of_reach(p, {0.3, 0.2, 0.1}, 0.2));
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
