#include "cad/shapes/face_groups.h"

#include "base/core/disjoint_sets.h"
#include "cad/shapes/cad_places.h"
#include "cad/shapes/names.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace octafront::cad {

namespace {

bool joins(const CadModel& model, const CadEdge& edge) {
  return edge.is_smooth && !edge.is_seam && edge.faces.size() == 2 &&
         model.faces[edge.faces[0]].sides == model.faces[edge.faces[1]].sides;
}

/// Edges of a face that part at less than this, the cosine of 20 degrees, leave no room for good elements between them.
constexpr double kCusp = 0.94;

/// An end of an edge: where it goes from there.
struct EdgeEnd {
  std::uint32_t edge;
  Vec3 direction;
};

/// Per edge whether it runs into another edge of one of its faces at a sharp angle.
std::vector<char> edges_in_cusps(const CadModel& model) {
  std::map<std::pair<VertexIndex, std::uint32_t>, std::vector<EdgeEnd>> ends;  // by vertex and face
  const auto add = [&](std::uint32_t e, VertexIndex at, VertexIndex next) {
    const Vec3 direction = normalized(model.points[next] - model.points[at]);
    for (const std::uint32_t f : model.edges[e].faces) ends[{at, f}].push_back({e, direction});
  };
  for (std::uint32_t e = 0; e < model.edges.size(); ++e) {
    const std::vector<VertexIndex>& along = model.edges[e].vertices;
    if (along.size() < 2 || model.edges[e].is_seam) continue;
    add(e, along.front(), along[1]), add(e, along.back(), along[along.size() - 2]);
  }
  std::vector<char> in_cusp(model.edges.size(), 0);
  for (const auto& [at, here] : ends)
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t k = i + 1; k < here.size(); ++k)
        if (here[i].edge != here[k].edge && dot(here[i].direction, here[k].direction) > kCusp)
          in_cusp[here[i].edge] = in_cusp[here[k].edge] = 1;
  return in_cusp;
}

FaceGroups groups_of(const CadModel& model, DisjointSets& sets) {
  const std::vector<std::string> names = face_names(model);
  std::vector<char> has_triangles(model.faces.size(), 0);
  for (const std::uint32_t f : model.face_of) has_triangles[f] = 1;
  FaceGroups groups{std::vector<std::uint32_t>(model.faces.size(), kNone), {}};
  std::vector<std::uint32_t> number(model.faces.size(), kNone), largest;
  for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
    if (!has_triangles[f]) continue;
    std::uint32_t& n = number[sets.find(f)];
    if (n == kNone) n = static_cast<std::uint32_t>(largest.size()), largest.push_back(f);
    groups.group_of[f] = n;
    if (model.faces[f].area > model.faces[largest[n]].area) largest[n] = f;
  }
  for (const std::uint32_t f : largest) groups.names.push_back(names[f]);
  groups.names = all_different(std::move(groups.names));
  return groups;
}

/// Per face the first place of `apart`, by number, that it lies at; kNone: none. Faces are only joined with others of
/// the same number, so that sizes asked at these places keep their faces.
std::vector<std::uint32_t> which_of(const CadModel& model, std::span<const std::string> apart, double unit) {
  std::vector<std::uint32_t> which(model.faces.size(), kNone);
  const CadPlaces places(model, unit);
  for (std::uint32_t n = 0; n < apart.size(); ++n)
    for (const std::uint32_t f : places.faces(apart[n])) which[f] = std::min(which[f], n);
  return which;
}

}  // namespace

std::vector<std::uint32_t> faces_at(const CadModel& model, std::span<const std::string> places, double unit) {
  const std::vector<std::uint32_t> which = which_of(model, places, unit);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < which.size(); ++f)
    if (which[f] != kNone) faces.push_back(f);
  return faces;
}

std::vector<double> mean_widths(const CadModel& model) {
  std::vector<double> perimeter(model.faces.size(), 0);
  for (const CadEdge& edge : model.edges)
    if (!edge.is_seam)
      for (const std::uint32_t f : edge.faces) perimeter[f] += edge.length;
  std::vector<double> width;
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    width.push_back(perimeter[f] > 0 ? 2 * model.faces[f].area / perimeter[f] : HUGE_VAL);
  return width;
}

FaceGroups group_faces(const CadModel& model, std::optional<double> size, std::span<const std::string> apart,
                       double unit) {
  const std::vector<std::uint32_t> which = which_of(model, apart, unit);
  const std::vector<double> width = mean_widths(model);
  const std::vector<char> in_cusp = edges_in_cusps(model);
  DisjointSets sets(model.faces.size());
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const CadEdge& edge = model.edges[e];
    if (!joins(model, edge)) continue;
    const auto [a, b] = std::pair(edge.faces[0], edge.faces[1]);
    if (which[a] != which[b]) continue;
    const bool is_narrow = size && (std::min(width[a], width[b]) < *size || edge.length < kTinyOfSize * *size);
    if (is_narrow || in_cusp[e] != 0) sets.join(a, b);
  }
  return groups_of(model, sets);
}

FaceGroups faces_as_they_are(const CadModel& model) {
  DisjointSets sets(model.faces.size());
  return groups_of(model, sets);
}

TinyThings tiny_things(const CadModel& model, double size) {
  TinyThings tiny;
  tiny.shortest_edge = HUGE_VAL;
  for (const CadEdge& edge : model.edges) {
    tiny.edges += edge.length < kTinyOfSize * size;
    tiny.shortest_edge = std::min(tiny.shortest_edge, edge.length);
  }
  for (const Face& face : model.faces) tiny.faces += face.area < kTinyOfSize * size * kTinyOfSize * size;
  for (const double w : mean_widths(model)) tiny.narrow_faces += w < kTinyOfSize * size;
  return tiny;
}

}  // namespace octafront::cad
