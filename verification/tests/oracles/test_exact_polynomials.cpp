// Polynomials with whole coefficients: products of known factors.
#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "verification/oracles/whole_polynomial.h"

using namespace foldproof;
using namespace foldproof::oracles;

TEST_CASE("polynomials are added, subtracted and multiplied, and have signs at fractions of two") {
  const Polynomial p({3, -5, 7}), q({-2, 0, 0, 11});
  CHECK((p + q).c == std::vector<Whole>{1, -5, 7, 11});
  CHECK((p - q).c == std::vector<Whole>{5, -5, 7, -11});
  CHECK((p * q).c == std::vector<Whole>{-6, 10, -14, 33, -55, 77});
  CHECK((p - p).degree() == -1);
  CHECK((Polynomial() * p).is_zero());
  CHECK(Polynomial({4, 0, 0}).degree() == 0);
  const Polynomial roots({3, -16, 16});  // (4 t - 1)(4 t - 3)
  for (const auto& [numerator, halvings, sign] :
       {std::array{1, 2, 0}, {3, 2, 0}, {1, 1, -1}, {7, 3, 1}, {3, 4, 1}, {5, 4, -1}})
    CHECK(sign_at(roots, Dyadic{numerator, halvings}) == sign);
  CHECK(sign_at(Polynomial(), Dyadic{5, 4}) == 0);
}

TEST_CASE("signs at roots that no fraction is") {
  const Polynomial p({-1, 0, 2});  // 2 t^2 - 1
  REQUIRE(roots_within(p).size() == 1);
  const Root root = roots_within(p)[0];
  CHECK(sign_at(Polynomial({-707106781, 1000000000}), root) == 1);
  CHECK(sign_at(Polynomial({-707106782, 1000000000}), root) == -1);
  CHECK(sign_at(p * Polynomial({3, 5}), root) == 0);
  CHECK(sign_at(Polynomial({-7}), root) == -1);
  CHECK(roots_within(Polynomial({1, 0, 1})).empty());
  // roots at the ends are not between them, repeated ones count once, fractions of two are found
  const Polynomial t({0, 1}), rest({1, -1}), half({-1, 2}), quarter({-1, 4});
  CHECK(roots_within(t * rest).empty());
  CHECK(roots_within(t * t * rest * half).size() == 1);
  const std::vector<Root> roots = roots_within(half * quarter * Polynomial({-3, 4}) * p * p);
  REQUIRE(roots.size() == 4);  // 1/4, 1/2, .707, 3/4
  CHECK(sign_at(quarter, roots[0]) == 0);
  CHECK(sign_at(half, roots[1]) == 0);
  CHECK(sign_at(p, roots[2]) == 0);
  CHECK(sign_at(p, roots[3]) == 1);
}

TEST_CASE("the hull of Bernstein's coefficients says plain signs only") {
  struct Row {
    std::vector<Whole> c;
    int sign;
  };
  for (const auto& [c, sign] : {Row{{}, 0}, Row{{-3}, -1}, Row{{1, -1}, 0},  // vanishes at 1
                                Row{{0, 1}, 0},                              // and at 0
                                Row{{3, -2}, 1}, Row{{-3, 2}, -1},
                                // coefficients 1, 1 + c/2, 1 + c + d: zero in the middle at c = -2
                                Row{{2, -3, 3}, 1}, Row{{2, -4, 3}, 0},
                                // of a cubic: a, a + b/3, a + 2 b/3 + c/3, a + b + c + d
                                Row{{3, -8, 9, -3}, 1},   // 3, 1/3, 2/3, 1
                                Row{{3, -9, 14, -3}, 0},  // 3, 0, ...
                                Row{{3, -6, 5, 4}, 1},    // 3, 1, 2/3, 6
                                Row{{3, -6, 3, 4}, 0},    // third: 0
                                Row{{-3, 8, -9, 4}, 0}})  // last: 0
    CHECK(definite_sign(Polynomial(c)) == sign);
  CHECK_THROWS_AS(definite_sign(Polynomial({1, 1, 1, 1, 1})), std::invalid_argument);
  CHECK_THROWS_AS(roots_within(Polynomial()), std::invalid_argument);
}
