#include "convergence/contact/section_profile.h"

#include <algorithm>
#include <array>

namespace foldproof {

namespace {

/// The edges that a plane cuts, and which two of them each triangle holds.
struct Cut {
  std::vector<Crossing> of_edge;                // one an edge; t < 0: not cut
  std::vector<std::array<int, 2>> of_triangle;  // edges, -1: none
};

Cut cut_by(const TriangleMesh& mesh, int axis, double height) {
  Cut cut{{}, std::vector<std::array<int, 2>>(mesh.triangles.size(), {-1, -1})};
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Edge& edge = mesh.edges[e];
    const double a = mesh.rest(axis, edge.a) - height, b = mesh.rest(axis, edge.b) - height;
    cut.of_edge.push_back({edge.a, edge.b, (a < 0) != (b < 0) ? a / (a - b) : -1});
    if (cut.of_edge.back().t < 0) continue;
    for (int t : edge.triangles) {
      if (t < 0) continue;
      std::array<int, 2>& held = cut.of_triangle[std::size_t(t)];
      (held[0] < 0 ? held[0] : held[1]) = int(e);
    }
  }
  return cut;
}

/// The line from this edge on, through the triangle first, until it ends or closes; marks the edges
/// that it passes.
std::vector<int> walk(const TriangleMesh& mesh, const Cut& cut, int edge, int triangle,
                      std::vector<bool>& passed) {
  std::vector<int> line = {edge};
  passed[std::size_t(edge)] = true;
  while (triangle >= 0) {
    const std::array<int, 2>& held = cut.of_triangle[std::size_t(triangle)];
    edge = held[0] == edge ? held[1] : held[0];
    line.push_back(edge);
    if (passed[std::size_t(edge)]) break;  // closed
    passed[std::size_t(edge)] = true;
    const std::array<int, 2>& sides = mesh.edges[std::size_t(edge)].triangles;
    triangle = sides[0] == triangle ? sides[1] : sides[0];
  }
  return line;
}

Vector3 place(const TriangleMesh& mesh, const Crossing& crossing) {
  return (1 - crossing.t) * mesh.rest.col(crossing.a) + crossing.t * mesh.rest.col(crossing.b);
}

MeshSection section_along(const TriangleMesh& mesh, const Cut& cut, const std::vector<int>& line) {
  MeshSection section;
  for (int edge : line) {
    const Crossing& crossing = cut.of_edge[std::size_t(edge)];
    const double step =
        section.crossings.empty()
            ? 0
            : (place(mesh, crossing) - place(mesh, section.crossings.back())).norm();
    section.length.push_back(section.length.empty() ? 0 : section.length.back() + step);
    section.crossings.push_back(crossing);
  }
  return section;
}

}  // namespace

MeshSection section_of(const TriangleMesh& mesh, int axis) {
  const double low = mesh.rest.row(axis).minCoeff(), high = mesh.rest.row(axis).maxCoeff();
  const double size = (mesh.rest.rowwise().maxCoeff() - mesh.rest.rowwise().minCoeff()).maxCoeff();
  if (!(high - low > 1e-6 * size)) return {};  // flat along this axis
  const Cut cut = cut_by(mesh, axis, (low + high) / 2 + 1e-9 * (high - low));
  MeshSection longest;
  std::vector<bool> passed(mesh.edges.size(), false);
  for (const bool from_border : {true, false}) {  // open lines from their ends, then closed ones
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      const bool is_border = mesh.edges[e].triangles[1] < 0;
      if (cut.of_edge[e].t < 0 || passed[e] || (from_border && !is_border)) continue;
      MeshSection found =
          section_along(mesh, cut, walk(mesh, cut, int(e), mesh.edges[e].triangles[0], passed));
      if (longest.length.empty() || found.length.back() > longest.length.back())
        longest = std::move(found);
    }
  }
  return longest;
}

std::vector<double> along(const MeshSection& section, const PerParticle& values, int count) {
  std::vector<double> samples;
  std::size_t next = 1;
  for (int k = 0; k < count && section.length.size() >= 2; ++k) {
    const double s = section.length.back() * k / (count - 1);
    while (next + 1 < section.length.size() && section.length[next] < s) ++next;
    const auto at = [&](const Crossing& c) { return (1 - c.t) * values[c.a] + c.t * values[c.b]; };
    const double from = section.length[next - 1], to = section.length[next];
    const double part = to > from ? std::clamp((s - from) / (to - from), 0.0, 1.0) : 0;
    samples.push_back((1 - part) * at(section.crossings[next - 1]) +
                      part * at(section.crossings[next]));
  }
  return samples;
}

}  // namespace foldproof
