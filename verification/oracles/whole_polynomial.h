// Polynomials with whole coefficients, and the signs of some at the roots of others, decided
// without rounding.
#pragma once

#include <vector>

#include "verification/oracles/scalars.h"

namespace foldproof::oracles {

/// sum_k c[k] t^k; the last coefficient is not zero, and the zero polynomial has none.
struct Polynomial {
  std::vector<Whole> c;

  Polynomial() = default;
  explicit Polynomial(std::vector<Whole> coefficients);

  bool is_zero() const { return c.empty(); }
  int degree() const { return int(c.size()) - 1; }  // -1 of zero

  friend Polynomial operator+(const Polynomial& p, const Polynomial& q);
  friend Polynomial operator-(const Polynomial& p, const Polynomial& q);
  friend Polynomial operator*(const Polynomial& p, const Polynomial& q);
};

/// The number numerator / 2^halvings.
struct Dyadic {
  Whole numerator;
  int halvings;
};

int sign_at(const Polynomial& p, const Dyadic& t);

/// The only root of `of` strictly between low and high, which are not roots.
struct Root {
  Polynomial of;
  Dyadic low, high;
};

/// The roots strictly between 0 and 1, ascending, each once. p is not zero.
std::vector<Root> roots_within(const Polynomial& p);

/// By Sturm and Tarski: the sum of the signs of q at the roots of p between `low` and `high` is the
/// drop in sign changes of the signed remainders of p and p'q from `low` to `high` (Basu, Pollack
/// and Roy 2006, theorem 2.61). Here there is one root.
int sign_at(const Polynomial& q, const Root& root);

/// +1 or -1 if the hull of the Bernstein coefficients shows that sign on all of [0, 1], else 0.
/// Degree at most 3.
int definite_sign(const Polynomial& p);

}  // namespace foldproof::oracles
