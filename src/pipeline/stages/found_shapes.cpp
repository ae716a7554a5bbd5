#include "base/geometry/measures.h"
#include "base/mesh/edge_table.h"
#include "base/places/places.h"
#include "pipeline/stages/true_shape.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace octafront {

namespace {

double squared_distance_to(const FoundLine& line, Vec3 p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < line.points.size(); ++k)
    least = std::min(least, squared_distance(p, closest_point_on_segment(p, line.points[k], line.points[k + 1])));
  return least;
}

/// Edges of a mesh between its parts, and the line of the geometry that each lies on.
class EdgesOnLines {
 public:
  EdgesOnLines(const TetMesh& mesh, std::vector<FoundLine> lines) : mesh_(mesh), lines_(std::move(lines)) {
    std::vector<Triangle> faces = mesh.boundary;
    faces.insert(faces.end(), mesh.interfaces.begin(), mesh.interfaces.end());
    const EdgeTable table = make_edge_table(mesh.points.size(), faces);
    for (std::size_t e = 0; e < table.size(); ++e) {
      std::set<std::uint32_t> parts;
      for (const HalfEdge h : table.uses(e)) parts.insert(part_of(h / 3));
      if (parts.size() < 2) continue;
      const auto [a, b] = table.edges[e];
      if (const std::uint32_t line = line_at(parts, 0.5 * (mesh.points[a] + mesh.points[b])); line != kNone)
        edges_.emplace_back(line, table.edges[e]);
    }
  }

  PlacedSet on(const std::string& name, const std::vector<FoundLine>& wanted) const {
    std::set<std::uint32_t> numbers;
    for (const FoundLine& line : wanted) numbers.insert(line.number);
    PlacedSet set{name, NamedSet::Kind::kEdges, {}};
    for (const auto& [line, edge] : edges_)
      if (numbers.contains(line)) set.places.insert(set.places.end(), {mesh_.points[edge[0]], mesh_.points[edge[1]]});
    return set;
  }

 private:
  std::uint32_t part_of(std::size_t face) const {
    const std::size_t outer = mesh_.boundary.size();
    return face < outer ? mesh_.patch[face] : mesh_.interface_patch[face - outer];
  }

  /// The number of the nearest line in which two of the parts meet; kNone: there is none.
  std::uint32_t line_at(const std::set<std::uint32_t>& parts, Vec3 p) const {
    std::pair best{std::numeric_limits<double>::infinity(), kNone};
    for (const FoundLine& line : lines_)
      if (std::ranges::count_if(line.parts, [&](std::uint32_t part) { return parts.contains(part); }) > 1)
        best = std::min(best, std::pair{squared_distance_to(line, p), line.number});
    return best.second;
  }

  const TetMesh& mesh_;
  std::vector<FoundLine> lines_;
  std::vector<std::pair<std::uint32_t, Edge>> edges_;  ///< with the line's number
};

/// The faces by boundary, then interfaces, of these parts.
std::vector<std::uint32_t> faces_of_parts(const TetMesh& mesh, const std::vector<std::uint32_t>& parts) {
  std::vector<std::uint32_t> faces;
  std::uint32_t number = 0;
  for (const auto* list : {&mesh.patch, &mesh.interface_patch})
    for (const std::uint32_t part : *list) {
      if (std::ranges::binary_search(parts, part)) faces.push_back(number);
      ++number;
    }
  return faces;
}

/// Vertices of the geometry are nodes, bit for bit.
std::vector<std::uint32_t> nodes_at(const TetMesh& mesh, const std::vector<Vec3>& points) {
  const auto key = [](Vec3 p) { return std::tuple(p.x, p.y, p.z); };
  std::set<std::tuple<double, double, double>> wanted;
  for (const Vec3 p : points) wanted.insert(key(p));
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v)
    if (wanted.contains(key(mesh.points[v]))) nodes.push_back(v);
  return nodes;
}

}  // namespace

std::vector<std::string> places_without_names(const TrueGeometry& geometry, std::span<const std::string> groups,
                                              const TetMesh& mesh) {
  std::vector<std::string> places;
  for (const std::string& text : groups) {
    const GroupRule rule = group_rule(text);
    const auto* place = std::get_if<std::string>(&rule.where);
    if (place == nullptr || !named_so(geometry.part_names(), *place).empty() ||
        !named_so(mesh.region_names, *place).empty())
      continue;
    const auto is_it = [&](const PartGroup& group) { return group.name == *place; };
    if (std::ranges::none_of(geometry.groups(), is_it) && std::ranges::find(places, *place) == places.end())
      places.push_back(*place);
  }
  return places;
}

std::vector<PlacedSet> add_found_shapes(const TrueGeometry& geometry, std::span<const std::string> places,
                                        TetMesh& mesh) {
  std::vector<PlacedSet> on_lines;
  std::optional<EdgesOnLines> edges;
  for (const std::string& place : places) {
    const FoundShapes found = geometry.find(place);
    if (auto faces = faces_of_parts(mesh, found.parts); !faces.empty())
      mesh.sets.push_back({place, NamedSet::Kind::kFaces, std::move(faces)});
    if (auto nodes = nodes_at(mesh, found.points); !nodes.empty())
      mesh.sets.push_back({place, NamedSet::Kind::kNodes, std::move(nodes)});
    if (found.lines.empty()) continue;
    if (!edges) edges.emplace(mesh, geometry.find("edges").lines);
    if (PlacedSet set = edges->on(place, found.lines); !set.places.empty()) on_lines.push_back(std::move(set));
  }
  return on_lines;
}

}  // namespace octafront
