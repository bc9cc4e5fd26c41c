// Scenes of the reference as messages of the protocol, and back. Only the parts that a portable
// scene lacks are in its extension; a scene that crosses the pipe is the same to the bit.
#pragma once

#include "reference/scene/scene.h"
#include "verification/subjects/adapters/foldproof_solver.h"
#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

/// The scene as a message, its constants in `extension`. Throws NotOffered for a scene with
/// objects, strain limits, self-collision or sticking: the protocol has no words for them.
PortableScene portable_scene(const Scene& scene);

/// 3 x N of the N x 3 numbers of a message.
PerParticle3 as_columns(const foldproof_solver::Numbers& rows);

/// Where the message's held particles are; no frames if they stay.
MeshSequence held_path(const foldproof_solver::Scene& message);

/// The scene of a message: of its extension, if it has one, else of its material. Bending has then
/// ke = 4 B, exact on equilateral meshes; rest angles and held particles, as at the
/// start, are the message's.
/// Throws InputError for a mesh that is none, or constants outside of their range.
Scene reference_scene(const foldproof_solver::Scene& message);

}  // namespace foldproof
