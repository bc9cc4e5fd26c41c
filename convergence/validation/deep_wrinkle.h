// One wave of a stretched sheet whose compression across is prescribed, beyond the onset.
#pragma once

#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// Equilateral triangles with rows of edges across the tension, clamped at both ends as in
/// wrinkled_sheet.h. The sheet is endless across, and all waves are alike: each is its own mirror
/// image about its crest and about its trough.
struct DeepWrinkleSheet {
  double rigidity = 0;     // D of the mesh [J]
  double tension = 0;      // T, per width [N/m]
  double young = 0;        // Y of the springs [N/m]
  double length = 0;       // L [m]
  double compression = 0;  // Delta/W, beyond what the tension narrows the sheet by [1]
  int rows = 0;            // of triangles over the length
  int edges = 0;           // in a wave, even
};

double wavelength_of(const DeepWrinkleSheet& sheet);  // of the flat sheet at rest [m]

struct DeepWrinkle {
  // of each row's wave: half the height of a crest over a trough, of its first harmonic [m]
  std::vector<double> amplitudes;  // held rows too
  double amplitude = 0;            // halfway between the clamps [m]
  double unbalanced = 0;           // largest force over the tension on an edge [1]
  bool stable = false;             // against waves like these
};

/// Lets half a wave settle. One clamp may move along the tension, which is a force.
DeepWrinkle deep_wrinkle(const Subject& subject, const DeepWrinkleSheet& sheet);

}  // namespace foldproof
