#include <octafront/error.h>
#include <octafront/poly_mesh.h>
#include <octafront/run_context.h>

#include "base/core/index_range.h"
#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/dual/dual_faces.h"
#include "base/dual/poly_faults.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace octafront {
namespace {

constexpr std::size_t kVerticesAtOnce = 2048;

/// Faces of ranges of vertices, in the order of these.
std::vector<dual::DualFaces> all_faces(const dual::Primal& primal, const dual::DualCells& cells,
                                       const dual::DualPoints& points) {
  const std::size_t vertices = primal.mesh.points.size();
  std::vector<dual::DualFaces> ranges((vertices + kVerticesAtOnce - 1) / kVerticesAtOnce);
  parallel_for(
      ranges.size(),
      [&](std::size_t r) {
        ranges[r] = faces_of_vertices(primal, cells, points, static_cast<VertexIndex>(r * kVerticesAtOnce),
                                      static_cast<VertexIndex>(std::min(vertices, (r + 1) * kVerticesAtOnce)));
      },
      Split::kSingly);
  return ranges;
}

/// Where a face is: in which range, which one, and where its points begin.
struct FacePlace {
  dual::DualFace face;
  std::uint32_t range, first_point;

  bool is_outside() const { return face.neighbour == kNone; }
};

/// In the order of PolyMesh.
std::vector<FacePlace> in_order(const std::vector<dual::DualFaces>& ranges) {
  std::vector<FacePlace> order;
  for (std::uint32_t r = 0; r < ranges.size(); ++r) {
    std::uint32_t first = 0;
    for (const dual::DualFace& f : ranges[r].faces) {
      order.push_back({f, r, first});
      first += f.points;
    }
  }
  parallel_sort(order, [](const FacePlace& a, const FacePlace& b) {
    const auto key = [](const FacePlace& p) {
      return std::tuple(p.is_outside(), p.is_outside() ? p.face.patch : 0, p.face.owner, p.face.neighbour, p.range,
                        p.first_point);
    };
    return key(a) < key(b);
  });
  return order;
}

/// Numbers those points that faces have. Returns what they are in DualPoints.
std::vector<std::uint32_t> number_points(PolyMesh& mesh, const dual::DualPoints& points) {
  std::vector<std::uint32_t> number(points.size(), kNone);
  for (const VertexIndex p : mesh.face_points) number[p] = 0;
  std::vector<std::uint32_t> used;
  for (std::uint32_t p = 0; p < number.size(); ++p) {
    if (number[p] == kNone) continue;
    number[p] = static_cast<std::uint32_t>(used.size());
    used.push_back(p);
  }
  parallel_for(mesh.face_points.size(), [&](std::size_t i) { mesh.face_points[i] = number[mesh.face_points[i]]; });
  return used;
}

/// Faces that lean by more against the edge that they stand for have their points centred: 60 degrees.
constexpr double kLeastUpright = 0.5;

bool leans(const PolyMesh& mesh, std::size_t f, const std::vector<Vec3>& vertices) {
  const VertexIndex from = mesh.vertex[mesh.owner[f]], to = mesh.vertex[mesh.neighbour[f]];
  if (from == to) return false;
  const auto points = mesh.face(f);
  Vec3 area;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    area += double_area_normal(mesh.points[points[0]], mesh.points[points[i]], mesh.points[points[i + 1]]);
  return dot(normalized(area), normalized(vertices[to] - vertices[from])) < kLeastUpright;
}

void place_points(PolyMesh& mesh, dual::DualPoints& points, const std::vector<Vec3>& vertices) {
  const std::vector<std::uint32_t> used = number_points(mesh, points);
  mesh.points.resize(used.size());
  parallel_for(used.size(), [&](std::size_t i) { mesh.points[i] = points.place(used[i]); });
  const auto leaning = parallel_select(
      mesh.inner_faces(), [&](std::uint32_t f) { return leans(mesh, f, vertices); }, kVerticesAtOnce);
  for (const std::uint32_t f : leaning)
    for (const VertexIndex p : mesh.face(f)) {
      if (!points.is_movable(used[p])) continue;
      points.centre(used[p]);
      mesh.points[p] = points.place(used[p]);
    }
}

PolyMesh made_with(const dual::Primal& primal, const std::vector<dual::Ridges>& ridges, const RunContext& context) {
  dual::DualCells cells = make_cells(primal, ridges);
  dual::DualPoints points(primal, cells);
  context.check();
  PolyMesh mesh;
  {
    const std::vector<dual::DualFaces> ranges = all_faces(primal, cells, points);
    context.check();
    for (const FacePlace& place : in_order(ranges)) {
      const auto first = ranges[place.range].points.begin() + place.first_point;
      mesh.face_points.insert(mesh.face_points.end(), first, first + place.face.points);
      mesh.face_begin.push_back(mesh.face_points.size());
      mesh.owner.push_back(place.face.owner);
      if (!place.is_outside()) mesh.neighbour.push_back(place.face.neighbour);
      mesh.patch.push_back(place.face.patch);
    }
  }
  mesh.region = std::move(cells.region);
  mesh.vertex = std::move(cells.vertex);
  place_points(mesh, points, primal.mesh.points);
  return mesh;
}

/// With a vertex its whole column is divided, or not: else layers of either kind would stand on each other.
void choose_by_column(const dual::LayerCells& layers, const std::vector<dual::Ridges>& before,
                      std::vector<dual::Ridges>& ridges) {
  for (bool again = true; again;) {
    again = false;
    for (const auto& [lower, upper] : layers.uprights())
      for (const auto& [from, to] : {std::pair(lower, upper), {upper, lower}})
        if (ridges[from] != before[from] && ridges[to] != ridges[from]) ridges[to] = ridges[from], again = true;
  }
}

/// Of cells at fault: those that are divided are to be left whole, or others to be divided at all features.
std::vector<dual::Ridges> chosen_otherwise(const PolyMesh& mesh, std::span<const std::uint32_t> cells, bool divided,
                                           std::vector<dual::Ridges> ridges) {
  for (const std::uint32_t c : cells) {
    const auto is_beside = [&](std::size_t other) {
      return other < mesh.cells() && mesh.vertex[other] == mesh.vertex[c] && mesh.region[other] == mesh.region[c];
    };
    const bool is_divided = (c > 0 && is_beside(c - std::size_t{1})) || is_beside(c + std::size_t{1});
    if (is_divided == divided) ridges[mesh.vertex[c]] = divided ? dual::Ridges::kNone : dual::Ridges::kFeatures;
  }
  return ridges;
}

/// Where cells are to be divided is a guess: if some are at fault it is tried otherwise, both ways by turns, so often.
constexpr int kTries = 4;

}  // namespace

PolyMesh dual_mesh(const TetMesh& mesh, const RunContext& context) {
  require_in_range(mesh.tets.size(), kMostTetsWithHalfFaces / 2, "tetrahedra");
  const ThreadLimit limit(context.threads);
  const dual::Primal primal(mesh);
  context.check();
  std::vector<dual::Ridges> ridges(mesh.points.size(), dual::Ridges::kSharp);
  PolyMesh best = made_with(primal, ridges, context);
  dual::PolyFaults faults = dual::faults_of(best);
  for (int i = 0; i < kTries && !faults.cells.empty(); ++i) {
    std::vector<dual::Ridges> others = chosen_otherwise(best, faults.cells, i % 2 != 0, ridges);
    choose_by_column(primal.layers, ridges, others);
    if (others == ridges) continue;
    PolyMesh other = made_with(primal, others, context);
    dual::PolyFaults of_other = dual::faults_of(other);
    if (!of_other.is_less(faults)) continue;
    best = std::move(other);
    faults = std::move(of_other);
    ridges = std::move(others);
  }
  if (const auto defect = first_defect(best, context)) throw MeshingError("the dual is not sound: " + *defect);
  return best;
}

}  // namespace octafront
