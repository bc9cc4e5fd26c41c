// The energies of a state, one term per kind. Every force names the term of its energy.
#pragma once

#include <iterator>

namespace foldproof {

struct Energies {
  double kinetic = 0, stretch = 0, bending = 0, gravity = 0, custom = 0, sticking = 0;  // J

  double total() const;
};

/// All terms, in the order in which they are added up and stored.
inline constexpr double Energies::*energy_terms[] = {&Energies::kinetic, &Energies::stretch,
                                                     &Energies::bending, &Energies::gravity,
                                                     &Energies::custom,  &Energies::sticking};

// Add every new term to the list.
static_assert(sizeof(Energies) == std::size(energy_terms) * sizeof(double));

inline double Energies::total() const {
  double sum = 0;
  for (const auto term : energy_terms) sum += this->*term;
  return sum;
}

}  // namespace foldproof
