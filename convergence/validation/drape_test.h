// The drape test: a disc of cloth between two smaller plates, its ring free to hang.
#pragma once

#include <vector>

#include "reference/scene/fabrics.h"
#include "verification/oracles/sheets/drape_outline.h"
#include "verification/subject.h"

namespace foldproof {

// ISO 9073-9, BS 5058: the specimen's radius and that of the plates [m]
constexpr double specimen_radius = 0.15, plate_radius = 0.09;
constexpr double gravity = 9.80665;  // m/s^2
constexpr oracles::DrapeRadii drape_radii{specimen_radius, plate_radius};

/// A fabric, as the test needs it.
struct DrapeFabric {
  const char* name;  // as in cases/fabrics.toml
  double rigidity;   // B [N m]
  double density;    // kg/m^2

  bool operator==(const DrapeFabric&) const = default;
};

/// Those of cases/fabrics.toml, with the mean of their two rigidities.
const std::vector<DrapeFabric>& drape_fabrics();

/// A fabric whose drape was measured, too.
struct MeasuredDrape {
  DrapeFabric fabric;
  double shear;        // rigidity in shear [N/m]
  double coefficient;  // of the drape test [1]
};

/// Those of cases/fabrics.toml.
const std::vector<MeasuredDrape>& measured_drapes();

/// (B/(density g))^(1/3) [m]: with the radii, it decides the shape of cloth that does not stretch.
double bending_length(const DrapeFabric& fabric);

/// How a test is run. The ring of cloth around the plates has `rows` and a half rows of nearly
/// equilateral triangles. It starts level, but for waves around it that rise outward.
struct DrapeTest {
  DrapeFabric fabric;
  int rows = 0;
  int waves = 8;
  double stretch = 300;  // Y of the springs over the weight per width of the ring [1]

  bool operator==(const DrapeTest&) const = default;
};

constexpr double least_fold = specimen_radius / 50;  // how far a fold stands out [m]

struct Drape {
  oracles::Outline outline;
  double coefficient;  // shadow beyond the plate over that of the level ring [1]
  int folds;           // that stand out by a fiftieth of the radius
  double unbalanced;   // see Equilibrium [1]
  bool stable;
  long crossings;         // pairs of an edge and a triangle that meet
  double largest_strain;  // of an edge, as a size [1]
};

/// The ring, with rows that are held by the plates up to half a row beyond their rim.
Scene ring_of_cloth(const DrapeTest& test);

/// Lets it settle.
Drape drape(const Subject& subject, const DrapeTest& test);

}  // namespace foldproof
