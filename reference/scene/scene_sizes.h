// Sizes of a scene in words, and slips that they betray: files in centimetres, densities in grams.
#pragma once

#include <string>

#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// "cloth 1 x 0.5 x 0 m, 0.5 m^2, 0.1 kg; object 'body' 0.4 x 1.7 x 0.3 m".
std::string sizes_in_words(const Scene& scene);

/// Notes what a flat pattern makes of the cloth, if it has one: panels, area, seams and their ease,
/// how far the start stretches it.
void note_pattern(Scene& scene);

/// Notes by which factor 'fit' scales each mesh, of_cloth that of the cloth, and warns where it
/// scales a cloth and a body given by --set differently. keys: of the whole case.
void note_scales(const KeyTable& keys, double of_cloth, Scene& scene);

/// Adds to scene.warnings a line for each: a cloth longer than 20 m or shorter than 5 mm; a cloth
/// and a mesh body of which one is seven times as long as the other, or more; a density beyond 5 or
/// below 0.01 kg/m^2; border vertices of a mesh file that lie on or near others, so that the
/// cloth is cut there. unit: of the mesh file [m].
void warn_of_sizes(const KeyTable& cloth, double unit, Scene& scene);

/// A start that will not work, in a line: triangles without area, or, without [self_collision] and
/// open seams, a cloth that crosses itself (not looked for where it is flat); "" if it is none.
std::string warning_of_start(const Scene& scene, const State& s);

/// A fixed step beyond the elastic limit at this state, which bounds from below what is stable, in
/// a line; "" if it is not, and for fully implicit integrators.
std::string warning_of_step(const Scene& scene, const System& system, const State& s);

}  // namespace foldproof
