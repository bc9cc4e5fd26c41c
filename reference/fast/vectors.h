// The passes over particles that a step and its linear solves consist of: v, x, p, q, r are 3 x N,
// masses N. For speed each runs on a team; sums are taken in blocks of a fixed size.
#pragma once

#include "reference/fast/loops.h"
#include "reference/types.h"

namespace foldproof {

/// to = columns, where each column depends only on the same column of other arrays, perhaps `to`
/// itself.
template <class Columns>
void set(const Team& team, PerParticle3& to, const Eigen::MatrixBase<Columns>& columns) {
  to.resize(3, columns.cols());
  for_each_range(team, to.cols(), [&](Eigen::Index first, Eigen::Index count) {
    to.middleCols(first, count) = columns.middleCols(first, count);
  });
}

/// x + h v.
PerParticle3 moved(const Team& team, const PerParticle3& x, double h, const PerParticle3& v);

/// v + s M^{-1} f.
PerParticle3 kicked(const Team& team, const PerParticle3& v, double s, const PerParticle3& f,
                    const PerParticle& inverse_mass);

/// q = 0 where the inverse mass is 0.
void clear_prescribed(const PerParticle& inverse_mass, PerParticle3& q);

/// p.q.
double dot(const Team& team, const PerParticle3& p, const PerParticle3& q);

/// sum |r_i|^2/m_i over free particles, the squared norm of momenta r. The second is the same with
/// sums in larger blocks.
double squared_norm(const Team& team, const PerParticle3& r, const PerParticle& inverse_mass);
double first_squared_norm(const Team& team, const PerParticle3& r, const PerParticle& inverse_mass);

/// sum m_i |v_i|^2 over free particles: the squared norm of the momenta M v.
double squared_momentum(const Team& team, const PerParticle3& v, const PerParticle& mass,
                        const PerParticle& inverse_mass);

}  // namespace foldproof
