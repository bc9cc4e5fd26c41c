// A stretched sheet at the compression across under which it wrinkles: from the
// subject's forces alone.
#pragma once

#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// Equilateral triangles, with rows of edges across the tension. The sheet is clamped at both ends:
/// two rows of particles are held there. It is endless across.
struct StretchedSheet {
  double rigidity = 0;  // D of the mesh [J]
  double tension = 0;   // T, per width [N/m]
  double length = 0;    // L, from halfway between the two held rows of each end [m]
  int rows = 0;         // of triangles over that length, at least 6
};

struct WrinkledSheet {
  double wavelength = 0;   // m
  double compression = 0;  // b, force per length across [N/m]
  // displacement of each row, the held ones of the length too; most: 1
  std::vector<double> profile;
  double unfinished = 0;  // relative change of b in the last turn [1]
};

double edge_of(const StretchedSheet& sheet);  // m

/// A wave across the flat sheet moves row m by X_m cos(k x). Its forces are K(k) X, with K read
/// from the forces on all particles when one particle a row moves. K is that under T alone plus b
/// times its change with b; the flat state of T and b is strained as an equilateral sheet's moduli
/// ask. The sheet wrinkles with the k for which the least b that makes K singular is least.
WrinkledSheet wrinkled(const Subject& subject, const StretchedSheet& sheet);

}  // namespace foldproof
