#include "verification/files/grid_content.h"

#include <algorithm>
#include <cmath>

#include "verification/files/content_key.h"

namespace foldproof {

namespace {

/// Raise this whenever the same input gives a different grid.
constexpr int grid_version = 2;

void require(bool is_met, const char* what) {
  if (!is_met) throw InputError(std::string("grid: ") + what);
}

}  // namespace

std::string input_key(const TriangleSoup& soup, const GridMethod& method, Repair repair) {
  ContentKey key;
  key.add(grid_version);
  key.add(soup.triangles);
  key.add(std::uint64_t(soup.rest.cols()));
  key.add(soup.rest.data(), std::size_t(soup.rest.size()));
  key.add(method.cells);
  key.add(method.margin);
  key.add(method.band);
  key.add(int(method.order));
  key.add(int(repair));
  return key.text();
}

std::string content_key(const Grid& grid) {
  ContentKey key;
  key.add(grid.lattice.origin.data(), 3);
  key.add(grid.lattice.spacing);
  key.add(grid.lattice.nodes.data(), 3);
  key.add(grid.phi);
  return key.text();
}

void require_valid_content(const Grid& grid) {
  const Lattice& lattice = grid.lattice;
  require(lattice.origin.allFinite() && std::isfinite(lattice.spacing) && lattice.spacing > 0,
          "its lattice has no place or no spacing");
  require(*std::min_element(lattice.nodes.begin(), lattice.nodes.end()) >= 2,
          "its lattice has no cells");
  require(grid.phi.size() == std::size_t(lattice.size()),
          "its values are not as many as its nodes");
  require(
      std::all_of(grid.phi.begin(), grid.phi.end(), [](double phi) { return std::isfinite(phi); }),
      "a value is not finite");
}

}  // namespace foldproof
