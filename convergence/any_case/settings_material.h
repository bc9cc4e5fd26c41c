// The apparent material: the stiffness that cloth seems to have at a solver's settings.
#pragma once

#include "verification/subjects/suite/trial.h"

namespace foldproof {

/// Young's modulus that the cloth seems to have in steps of dt [N/m]: hung at rest from one end of
/// its longest side, in its rest shape and without obstacles, under its weight,
///     Y = density g L^2 / (2 stretch).
/// Throws NotOffered if it does not come to rest in such steps, or the solver holds no particles.
double apparent_young(Trial& trial, PortableScene cloth, double dt);

}  // namespace foldproof
