#include "reference/scene/read_strain.h"

#include "reference/scene/key_values.h"

namespace foldproof {

void read_strain_range(const KeyTable& keys, StrainRange& range) {
  range.extension = non_negative_or(keys, "extension", range.extension);
  range.compression = non_negative_or(keys, "compression", range.compression);
  if (!(range.compression < 1))
    throw InputError(keys.where("compression") + ": 'compression' must lie in [0, 1)");
}

void read_strain_limits(const KeyTable& keys, Scene& scene) {
  const auto table = keys.table("strain_limits");
  if (!table) return;
  if (!scene.stretch)
    throw InputError(table->where() +
                     ": [strain_limits] limits springs; the case needs a [stretch] table");
  StrainLimits limits;
  read_strain_range(*table, limits);
  limits.order = choice<SweepOrder>(*table, "order",
                                    {{"gauss_seidel", SweepOrder::gauss_seidel},
                                     {"alternating", SweepOrder::alternating},
                                     {"coloured", SweepOrder::coloured},
                                     {"jacobi", SweepOrder::jacobi}});
  limits.sweeps = int(count_or(*table, "sweeps", limits.sweeps));
  limits.tolerance = positive_or(*table, "tolerance", limits.tolerance);
  scene.strain_limits = limits;
}

}  // namespace foldproof
