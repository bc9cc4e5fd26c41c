#include "reference/mesh/triangle_soup.h"

#include <algorithm>
#include <set>
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

SortedTriangles sorted_triangles(const TriangleSoup& soup) {
  SortedTriangles sorted;
  std::set<Triangle> seen;  // corners in order
  for (int t = 0; t < int(soup.triangles.size()); ++t) {
    Triangle corners = soup.triangles[size_t(t)];
    std::ranges::sort(corners);
    (!has_area(soup.rest, corners) ? sorted.without_area
     : seen.insert(corners).second ? sorted.sound
                                   : sorted.repeated)
        .push_back(t);
  }
  return sorted;
}

std::string flaws_in_words(const SortedTriangles& sorted, const MeshOrigin& origin) {
  std::string words;
  const auto add = [&](const std::vector<int>& flawed, const char* what) {
    if (!flawed.empty())
      words += (words.empty() ? "" : "; ") + triangle_location(origin, flawed.front()) + what +
               ", the first of " + std::to_string(flawed.size()) + "; remove it";
  };
  add(sorted.without_area, "a face without area");
  add(sorted.repeated, "a face given twice, with the three corners of an earlier one");
  return words;
}

}  // namespace foldproof
