// Sewing: panels whose vertices coincide become one cloth.
#pragma once

#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// Every vertex that lies within `distance` [m] of one that comes before it, and that is itself no
/// such vertex, becomes that one: of several the first. So no vertex moves by more than `distance`,
/// and none twice. Triangles keep their numbers and places in the file; vertices that are left keep
/// theirs in the file, and are numbered anew in their order. Throws InputError "FILE:LINE: ..." for
/// a distance that is not > 0 or not finite, coordinates that are not finite, and a triangle of
/// which two corners become one.
TriangleSoup close_seams(TriangleSoup panels, double distance);

}  // namespace foldproof
