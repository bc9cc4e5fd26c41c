#include "reference/scene/read_strain.h"

#include "reference/scene/key_values.h"

namespace foldproof {

void read_strain_limits(const KeyTable& keys, Scene& scene) {
  const auto table = keys.table("strain_limits");
  if (!table) return;
  if (!scene.stretch)
    throw InputError(table->where() +
                     ": [strain_limits] limits springs; the case needs a [stretch] table");
  StrainLimits limits;
  limits.extension = non_negative_or(*table, "extension", limits.extension);
  limits.compression = non_negative_or(*table, "compression", limits.compression);
  if (!(limits.compression < 1))
    throw InputError(table->where("compression") + ": 'compression' must lie in [0, 1)");
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
