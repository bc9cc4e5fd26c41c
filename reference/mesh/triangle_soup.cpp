#include "reference/mesh/triangle_soup.h"

#include <algorithm>
#include <utility>

#include "reference/mesh/mesh_locations.h"

namespace foldproof {

TriangleSoup without_unused_vertices(TriangleSoup soup) {
  std::vector<int> place(size_t(soup.rest.cols()), -1), kept, lines, numbers;
  for (const Triangle& t : soup.triangles)
    for (const int v : t) place[size_t(v)] = 0;
  if (std::ranges::find(place, -1) == place.end()) return soup;
  for (size_t v = 0; v < place.size(); ++v) {
    if (place[v] < 0) continue;
    place[v] = int(kept.size());
    kept.push_back(int(v));
    if (!soup.origin.vertex_lines.empty()) lines.push_back(soup.origin.vertex_lines[v]);
    numbers.push_back(number_of(soup.origin, int(v)));
  }
  soup.origin.vertex_numbers = std::move(numbers);
  soup.origin.vertex_lines = std::move(lines);
  soup.rest = PerParticle3(soup.rest(Eigen::all, kept));
  for (Triangle& t : soup.triangles)
    for (int& v : t) v = place[size_t(v)];
  return soup;
}

}  // namespace foldproof
