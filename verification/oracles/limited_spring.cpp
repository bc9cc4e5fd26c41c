#include "verification/oracles/limited_spring.h"

#include <algorithm>

#include "verification/oracles/scalars.h"
#include "verification/oracles/triple.h"

namespace foldproof::oracles {

namespace {

using Vector = Triple<Digits50>;

Vector exact(const Vector3& v) { return {Digits50(v.x()), Digits50(v.y()), Digits50(v.z())}; }

Vector3 nearest(const Vector& v) {
  return {v.x.convert_to<double>(), v.y.convert_to<double>(), v.z.convert_to<double>()};
}

}  // namespace

LimitedSpringAnswer limited_spring(const LimitedSpringInput& input) {
  const Vector d = exact(input.x_b) - exact(input.x_a), u = exact(input.v_b) - exact(input.v_a);
  const Digits50 h = input.step;
  const Vector predicted = d + h * u, along = unit(d);
  const Digits50 before = dot(predicted, along), length_before = length(predicted);
  LimitedSpringAnswer answer{input.v_a, input.v_b, length_before.convert_to<double>()};
  answer.is_violated = length_before > input.longest || length_before < input.shortest;
  if (!answer.is_violated) return answer;

  const Digits50 limit = length_before > input.longest ? input.longest : input.shortest;
  const Vector across = predicted - before * along;
  const Digits50 leg = limit * limit - dot(across, across);
  answer.is_reachable = leg >= 0;
  const Digits50 after = answer.is_reachable ? Digits50(sqrt(leg)) : Digits50(0);
  const Digits50 gained = (after - before) / h;  // of the velocity of b past a along d
  const Digits50 wa = input.inverse_mass_a, wb = input.inverse_mass_b;
  answer.v_a = nearest(exact(input.v_a) - (gained * wa / (wa + wb)) * along);
  answer.v_b = nearest(exact(input.v_b) + (gained * wb / (wa + wb)) * along);
  answer.length = length(after * along + across).convert_to<double>();
  if (after > 0) answer.sensitivity = std::max(1.0, Digits50(limit / after).convert_to<double>());
  return answer;
}

}  // namespace foldproof::oracles
