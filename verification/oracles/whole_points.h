// Points whose coordinates are doubles, taken as exact numbers: whole numbers times
// one power of two.
#pragma once

#include <initializer_list>

#include "reference/types.h"
#include "verification/oracles/scalars.h"
#include "verification/oracles/triple.h"

namespace foldproof::oracles {

using Exact = Triple<Whole>;

inline int sign_of(const Whole& value) { return value.sign(); }

/// The exponent of the largest power of two that divides all coordinates, which must be finite; 0
/// if all are zero.
int common_exponent(std::initializer_list<Vector3> points);

/// value / 2^exponent, where that is a whole number.
Whole whole(double value, int exponent);

Exact exact(const Vector3& p, int exponent);

}  // namespace foldproof::oracles
