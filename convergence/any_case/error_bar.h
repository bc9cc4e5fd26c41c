// The error of the finest value of a ladder of refinements: order, limit and error bar, or the
// reason why there is none.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace foldproof {

/// One quantity over n levels of refinement, coarse to fine; step or mesh size falls by
/// `ratio` each level.
struct Ladder {
  std::vector<double> values;  // n, of a number; empty for a field, which has only differences
  // n - 1, of neighbouring levels, >= 0; filled from values if empty
  std::vector<double> differences;
  double ratio = 2;         // > 1
  double formal_order = 2;  // of the method, > 0
  // differences at or below it are rounding or solver error, not discretization error
  double floor = 0;
};

enum class Reading { asymptotic, not_asymptotic, inconclusive };

std::string_view name_of(Reading reading);  // "asymptotic", "not asymptotic", "inconclusive"

/// How far the finest value is from the limit.
struct ErrorBar {
  Reading reading = Reading::inconclusive;
  std::string reason;          // why it is not asymptotic, or inconclusive; "" if asymptotic
  bool may_settle = false;     // not asymptotic, and another level may tell more
  std::vector<double> orders;  // n - 2, of neighbouring differences; NaN where there is none
  double order = std::numeric_limits<double>::quiet_NaN();  // observed; NaN if inconclusive
  // Richardson's; NaN without values, or order
  double limit = std::numeric_limits<double>::quiet_NaN();
  double safety = 3;  // 1.25 or 3 [1]
  // of the bar, in the quantity's unit
  double half_width = std::numeric_limits<double>::quiet_NaN();
};

/// The reading, with its reason: "not asymptotic: the order still changes from level to level".
std::string in_words(const ErrorBar& bar);

/// The observed order where the range is asymptotic. NaN elsewhere: two differences that are not
/// yet (or no longer) of one power of the step have a ratio, but no order.
double asymptotic_order(const ErrorBar& bar);

/// Two observed orders closer than this are taken for the same [1].
constexpr double same_order = 0.2;

/// Observed order below which differences are said not to fall [1].
constexpr double least_order = 0.5;

/// An order that has settled further than this below the formal one is of another error than the
/// method's: of a kink, a limit, or a point that holds a membrane [1].
constexpr double far_below_formal = 0.5;

/// So many floors are the least difference that an order is read from: a floor then changes the
/// order of a ratio of 2 by 0.3 at most [1].
constexpr double floors_for_order = 10;

/// Reads a ladder of n >= 3 levels. Orders are
///   p_k = log(d_k / d_(k+1)) / log ratio,  d_k = f_(k+1) - f_k,  none where d changes sign.
/// The range is asymptotic if the last two orders agree within same_order and the last one is not
/// far_below_formal; or if the last one agrees with the formal order, and the one before was
/// farther from it, by far_below_formal at most; with three levels, if the only one agrees with it.
/// The error bar is the grid convergence index (Roache 1994; Celik et al., J. Fluids Eng. 130
/// (2008) 078001, their eq. 7),
///   safety * d / (ratio^p - 1),  p = min(p_last, highest),
/// with a safety of 1.25 and the formal order as the highest in the asymptotic range, else of 3 and
/// 1. Two things are ours, because the index alone misses errors of two terms by up to 250 times:
///   d = max(d_last, d_before / ratio^highest), since a difference near a change of sign is small
///   by accident; and an order that falls is taken to fall once more, p <= 2 p_last - p_before.
/// With four levels, all bars of c1 h^p + c2 h^q with p >= 1 and a method of order p or 2 then hold
/// the error (test_error_bar.cpp). Without an order (differences grow, change sign or have sunk to
/// the floor) the reading is inconclusive, and the bar is three times the largest of the last two
/// differences: a spread, no estimate (Eca and Hoekstra, J. Comput. Phys. 262 (2014) 104, section
/// 3). Quantities that do not change at all have a bar of the floor. Throws InputError for fewer
/// than three levels, or other lengths than promised.
ErrorBar error_bar(const Ladder& ladder);

}  // namespace foldproof
