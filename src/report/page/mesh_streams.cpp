#include "report/page/mesh_streams.h"

#include <octafront/quality.h>
#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// Vertices in the order in which elements meet them.
struct Renumbered {
  std::vector<VertexIndex> old;  ///< by new number
  Bytes tets;
};

Renumbered renumbered(const TetMesh& mesh) {
  Renumbered made;
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (const Tet& tet : mesh.tets)
    for (const VertexIndex v : tet) {
      made.tets.number(number[v] == kNone ? 0 : made.old.size() - number[v]);
      if (number[v] != kNone) continue;
      number[v] = static_cast<VertexIndex>(made.old.size());
      made.old.push_back(v);
    }
  return made;
}

/// Fine against the shortest edge, so that no element changes its looks; and what 30 bits can count.
double step_for(const TetMesh& mesh, double extent) {
  constexpr double kPartsOfEdge = 2000, kMostSteps = 1 << 30, kStepsWithoutEdges = 1 << 20;
  double shortest = HUGE_VAL;
  for (const Tet& tet : mesh.tets)
    for (const auto& [i, j] : kTetEdges) {
      const double edge = distance(mesh.points[tet[i]], mesh.points[tet[j]]);
      if (edge > 0) shortest = std::min(shortest, edge);
    }
  if (!(extent > 0)) return 1;
  return std::max(std::isfinite(shortest) ? shortest / kPartsOfEdge : extent / kStepsWithoutEdges, extent / kMostSteps);
}

Bytes point_stream(const TetMesh& mesh, const std::vector<VertexIndex>& old, Vec3 origin, double step) {
  Bytes bytes;
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t last = 0;
    for (const VertexIndex v : old) {
      const std::int64_t q = std::llround((mesh.points[v][axis] - origin[axis]) / step);
      bytes.difference(q - last);
      last = q;
    }
  }
  return bytes;
}

/// Edges that leave their straight line by half a step or more.
Bytes bend_stream(const TetMesh& mesh, double step) {
  Bytes bytes;
  std::vector<bool> seen(mesh.points.size(), false);
  std::uint64_t last = 0;
  for (std::size_t t = 0; t < mesh.mid_nodes.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const VertexIndex mid = mesh.mid_nodes[t][e];
      if (seen[mid]) continue;
      seen[mid] = true;
      const auto& [i, j] = kTetEdges[e];
      const Vec3 bend = (mesh.points[mid] - 0.5 * (mesh.points[mesh.tets[t][i]] + mesh.points[mesh.tets[t][j]])) / step;
      const std::array<std::int64_t, 3> steps{std::llround(bend.x), std::llround(bend.y), std::llround(bend.z)};
      if (steps == std::array<std::int64_t, 3>{}) continue;
      bytes.number(6 * t + e - last);
      last = 6 * t + e;
      for (const std::int64_t n : steps) bytes.difference(n);
    }
  return bytes;
}

struct Shape {
  double beta, min_dihedral, max_dihedral, size_ratio;
};

Shape shape_of(const TetMesh& mesh, const Tet& tet, const SizeField* sizes) {
  const Vec3 a = mesh.points[tet[0]], b = mesh.points[tet[1]], c = mesh.points[tet[2]], d = mesh.points[tet[3]];
  const auto angles = dihedral_angles(a, b, c, d);
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  double ratio = 1;
  if (sizes != nullptr) {
    double sum = 0;
    for (const auto& [i, j] : kTetEdges) sum += distance(mesh.points[tet[i]], mesh.points[tet[j]]);
    ratio = sum / 6 / sizes->at((a + b + c + d) / 4);
  }
  return {radius_ratio(a, b, c, d), *least, *most, ratio};
}

void add_shapes(const TetMesh& mesh, const SizeField* sizes, const RunContext& context, MeshStreams& streams) {
  const std::size_t n = mesh.tets.size();
  std::vector<std::array<std::uint8_t, 4>> values(n);
  parallel_for(n, [&](std::size_t t) {
    if (t % 4096 == 0) context.check();
    const Shape s = shape_of(mesh, mesh.tets[t], sizes);
    values[t] = {kBetaScale(s.beta), kMinDihedralScale(s.min_dihedral), kMaxDihedralScale(s.max_dihedral),
                 kSizeRatioScale(std::log2(s.size_ratio))};
  });
  const char* names[] = {"beta", "min_dihedral", "max_dihedral", "size_ratio"};
  for (std::size_t k = 0; k < (sizes == nullptr ? 3 : 4); ++k) {
    Bytes bytes;
    for (const auto& of_tet : values) bytes.byte(of_tet[k]);
    streams.all.emplace_back(names[k], std::move(bytes));
  }
}

/// A face as one or two half-faces, and a number that goes with it.
struct Face {
  HalfFace low = kNone, high = kNone;
  std::uint64_t number = 0;
  friend bool operator<(const Face& a, const Face& b) { return a.low < b.low; }
};

Bytes face_stream(std::vector<Face>& faces, bool two_sided) {
  std::sort(faces.begin(), faces.end());
  Bytes bytes;
  HalfFace last = 0;
  for (const Face& f : faces) {
    bytes.number(f.low - last);
    last = f.low;
    if (two_sided) bytes.number(f.high - f.low);
    bytes.number(f.number);
  }
  return bytes;
}

std::vector<Face> boundary_faces(const TetMesh& mesh, const FaceTable& table) {
  std::vector<Face> faces;
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    for (const FaceTable::Entry& side : table.group_of(mesh.boundary[f]))
      faces.push_back({side.face, kNone, mesh.patch.empty() ? 0 : mesh.patch[f]});
  return faces;
}

/// Per element at a wall its part of the most layers anywhere; others are full.
Bytes layer_stream(const TetMesh& mesh, const FaceTable& table) {
  std::vector<std::uint8_t> values(mesh.tets.size(), kLayersScale(1));
  std::uint32_t most = 1;
  for (const std::uint32_t n : mesh.face_layers)
    if (n != kNone) most = std::max(most, n);
  for (std::size_t f = 0; f < mesh.face_layers.size(); ++f) {
    const bool is_outer = f < mesh.boundary.size();
    const Triangle& face = is_outer ? mesh.boundary[f] : mesh.interfaces[f - mesh.boundary.size()];
    if (mesh.face_layers[f] == kNone) continue;
    for (const FaceTable::Entry& side : table.group_of(face))
      values[side.face / 4] = kLayersScale(static_cast<double>(mesh.face_layers[f]) / most);
  }
  Bytes bytes;
  for (const std::uint8_t value : values) bytes.byte(value);
  return bytes;
}

std::vector<Face> walls(const TetMesh& mesh, const FaceTable& table) {
  std::vector<Face> faces;
  const auto region = [&](HalfFace h) { return mesh.region.empty() ? 0 : mesh.region[h / 4]; };
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f) {
    const auto sides = table.group_of(mesh.interfaces[f]);
    const std::uint64_t patch = mesh.interface_patch.empty() ? 0 : mesh.interface_patch[f];
    if (sides.size() == 2) faces.push_back({sides[0].face, sides[1].face, patch + 1});
  }
  // Files may say where the regions are, and nothing of the faces between them.
  const std::size_t named = faces.size();
  std::sort(faces.begin(), faces.end());
  if (!mesh.region.empty())
    table.for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> sides) {
      if (sides.size() != 2 || region(sides[0].face) == region(sides[1].face)) return;
      const Face face{sides[0].face, sides[1].face, 0};
      if (!std::binary_search(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(named), face))
        faces.push_back(face);
    });
  return faces;
}

Bytes region_stream(const TetMesh& mesh) {
  Bytes bytes;
  for (const std::uint32_t region : mesh.region) bytes.number(region);
  return bytes;
}

}  // namespace

std::uint8_t ByteScale::operator()(double value) const {
  const double share = (value - low) / (high - low);
  return share > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, share))) : 0;  // not a number: 0
}

MeshStreams mesh_streams(const TetMesh& mesh, const SizeField* sizes, const RunContext& context) {
  MeshStreams streams;
  Renumbered vertices = renumbered(mesh);
  context.check();
  const Box3 box = bounding_box(mesh.points);
  streams.points = vertices.old.size();
  streams.has_sizes = sizes != nullptr;
  streams.has_layers = !mesh.face_layers.empty();
  if (!mesh.points.empty()) {
    streams.origin = box.lo;
    const Vec3 extent = box.hi - box.lo;
    streams.step = step_for(mesh, std::max({extent.x, extent.y, extent.z}));
  }
  streams.all.emplace_back("tets", std::move(vertices.tets));
  streams.all.emplace_back("points", point_stream(mesh, vertices.old, streams.origin, streams.step));
  if (mesh.is_second_order()) streams.all.emplace_back("bends", bend_stream(mesh, streams.step));
  add_shapes(mesh, sizes, context, streams);
  streams.all.emplace_back("region", region_stream(mesh));
  const FaceTable table = half_face_table(mesh.tets, mesh.points.size());
  context.check();
  if (streams.has_layers) streams.all.emplace_back("layers", layer_stream(mesh, table));
  std::vector<Face> faces = boundary_faces(mesh, table);
  streams.all.emplace_back("boundary", face_stream(faces, false));
  faces = walls(mesh, table);
  streams.all.emplace_back("walls", face_stream(faces, true));
  return streams;
}

}  // namespace octafront
