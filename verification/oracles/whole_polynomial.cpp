#include "verification/oracles/whole_polynomial.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace foldproof::oracles {

namespace {

Polynomial derivative(const Polynomial& p) {
  std::vector<Whole> c;
  for (std::size_t k = 1; k < p.c.size(); ++k) c.push_back(p.c[k] * Whole(k));
  return Polynomial(std::move(c));
}

/// -remainder of p over q, times a positive number that keeps it whole. q is not zero.
Polynomial minus_remainder(Polynomial p, const Polynomial& q) {
  const Whole& lead = q.c.back();
  while (p.degree() >= q.degree()) {
    const std::size_t shift = p.c.size() - q.c.size();
    const Whole top = lead.sign() > 0 ? p.c.back() : Whole(-p.c.back());
    for (Whole& coefficient : p.c) coefficient *= abs(lead);
    for (std::size_t k = 0; k < q.c.size(); ++k) p.c[shift + k] -= top * q.c[k];
    p = Polynomial(std::move(p.c));  // without the top coefficient, which is zero now
  }
  for (Whole& coefficient : p.c) coefficient = -coefficient;
  return p;
}

/// p, p'q, and so on: each minus the remainder of the two before it, up to the last
/// that is not zero.
std::vector<Polynomial> signed_remainders(const Polynomial& p, const Polynomial& q) {
  std::vector<Polynomial> all{p};
  Polynomial next = derivative(p) * q;
  while (!next.is_zero()) {
    all.push_back(std::move(next));
    next = minus_remainder(all[all.size() - 2], all.back());
  }
  return all;
}

int sign_changes(const std::vector<Polynomial>& sequence, const Dyadic& t) {
  int changes = 0, before = 0;
  for (const Polynomial& p : sequence) {
    const int sign = sign_at(p, t);
    if (sign * before < 0) ++changes;
    if (sign != 0) before = sign;
  }
  return changes;
}

/// A number between the two that is not a root: one of the fractions 1/2, 1/4, 3/4, 1/8, ... of the
/// interval, only a few of them being roots.
Dyadic between(const Polynomial& p, const Dyadic& low, const Dyadic& high) {
  for (int halvings = 1;; ++halvings) {
    const int common = std::max(low.halvings, high.halvings);
    const Whole from = low.numerator << unsigned(common - low.halvings);
    const Whole to = high.numerator << unsigned(common - high.halvings);
    for (int part = 1; part < 1 << halvings; part += 2) {
      const Dyadic t{(from << unsigned(halvings)) + part * (to - from), common + halvings};
      if (sign_at(p, t) != 0) return t;
    }
  }
}

void isolate(const std::vector<Polynomial>& sturm, const Dyadic& low, const Dyadic& high,
             std::vector<Root>& roots) {
  const int count = sign_changes(sturm, low) - sign_changes(sturm, high);
  if (count == 0) return;
  if (count == 1) {
    roots.push_back({sturm.front(), low, high});
    return;
  }
  const Dyadic middle = between(sturm.front(), low, high);
  isolate(sturm, low, middle, roots);
  isolate(sturm, middle, high, roots);
}

/// p divided by t and by 1 - t as often as possible: the same roots between 0 and 1, none at
/// either.
Polynomial without_ends(Polynomial p) {
  while (sign_at(p, {0, 0}) == 0) p.c.erase(p.c.begin());
  while (sign_at(p, {1, 0}) == 0) {  // p = (1 - t) q: q_0 = p_0, q_k = p_k + q_{k-1}
    for (std::size_t k = 1; k < p.c.size(); ++k) p.c[k] += p.c[k - 1];
    p = Polynomial(std::move(p.c));
  }
  return p;
}

}  // namespace

Polynomial::Polynomial(std::vector<Whole> coefficients) : c(std::move(coefficients)) {
  while (!c.empty() && c.back() == 0) c.pop_back();
}

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
  std::vector<Whole> c(std::max(p.c.size(), q.c.size()));
  for (std::size_t k = 0; k < p.c.size(); ++k) c[k] += p.c[k];
  for (std::size_t k = 0; k < q.c.size(); ++k) c[k] += q.c[k];
  return Polynomial(std::move(c));
}

Polynomial operator-(const Polynomial& p, const Polynomial& q) {
  std::vector<Whole> c(std::max(p.c.size(), q.c.size()));
  for (std::size_t k = 0; k < p.c.size(); ++k) c[k] += p.c[k];
  for (std::size_t k = 0; k < q.c.size(); ++k) c[k] -= q.c[k];
  return Polynomial(std::move(c));
}

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  if (p.is_zero() || q.is_zero()) return {};
  std::vector<Whole> c(p.c.size() + q.c.size() - 1);
  for (std::size_t i = 0; i < p.c.size(); ++i)
    for (std::size_t k = 0; k < q.c.size(); ++k) c[i + k] += p.c[i] * q.c[k];
  return Polynomial(std::move(c));
}

// sum_k c_k n^k / 2^(h k), times 2^(h degree)
int sign_at(const Polynomial& p, const Dyadic& t) {
  Whole sum = 0;
  for (std::size_t k = p.c.size(); k-- > 0;)
    sum = sum * t.numerator + (p.c[k] << unsigned(t.halvings) * unsigned(p.c.size() - 1 - k));
  return sum.sign();
}

std::vector<Root> roots_within(const Polynomial& p) {
  if (p.is_zero()) throw std::invalid_argument("the zero polynomial has all numbers as roots");
  const Polynomial inner = without_ends(p);
  std::vector<Root> roots;
  isolate(signed_remainders(inner, Polynomial({1})), {0, 0}, {1, 0}, roots);
  return roots;
}

int sign_at(const Polynomial& q, const Root& root) {
  if (q.is_zero()) return 0;
  if (const int sign = q.degree() <= 3 ? definite_sign(q) : 0) return sign;  // the quick answer
  const std::vector<Polynomial> sequence = signed_remainders(root.of, q);
  return sign_changes(sequence, root.low) - sign_changes(sequence, root.high);
}

// The coefficients are b_i = sum_{k <= i} C(i, k) / C(d, k) c_k, here times 6.
int definite_sign(const Polynomial& p) {
  constexpr int choose[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  const std::size_t d = p.c.size() - 1;
  if (p.is_zero()) return 0;
  if (d > 3) throw std::invalid_argument("plain_sign is for degrees up to 3");
  const int first = p.c[0].sign();
  for (std::size_t i = 1; i <= d; ++i) {
    Whole b = 0;
    for (std::size_t k = 0; k <= i; ++k) b += (6 * choose[i][k] / choose[d][k]) * p.c[k];
    if (b.sign() != first) return 0;
  }
  return first;
}

}  // namespace foldproof::oracles
