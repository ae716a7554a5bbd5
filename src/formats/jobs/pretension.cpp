#include <octafront/error.h>
#include <octafront/split.h>

#include "base/mesh/adjacency.h"
#include "formats/jobs/job_plan.h"

#include <algorithm>
#include <functional>

#include <fmt/core.h>

namespace octafront::io {
namespace {

Triangle face_of_tet(const Tet& tet, int face) {
  Triangle corners{};
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = tet[static_cast<std::size_t>(kTetFaces[static_cast<std::size_t>(face)][k])];
  return corners;
}

class Bolt {
 public:
  Bolt(const MeshParts& mesh, const Part& region, const std::vector<std::uint32_t>& tied)
      : mesh_(mesh), region_(region), across_(half_face_neighbors(mesh.mesh().tets, mesh.mesh().points.size())) {
    is_own_.assign(mesh.tets(), 0);
    for (const std::uint32_t t : region.members) is_own_[t] = 1;
    mark_taken(tied);
  }

  /// The largest of the cylinders that bound it, and those that go on from it, of the same axis and radius.
  std::vector<Cylinder> shank() const {
    std::vector<Cylinder> all = cylinders();
    if (all.empty())
      throw OptionError(
          fmt::format("`pretension`: \"{}\" has no patch that is a cylinder, which would say where its axis is; where "
                      "its faces are one patch, divide them by `patches`",
                      region_.name));
    constexpr double kSameRadius = 0.98;  // facets of other sizes
    const Cylinder largest = all[0];
    std::erase_if(all, [&](const Cylinder& c) {
      const auto [less, more] = std::minmax(c.radius, largest.radius);
      return less < kSameRadius * more || !share_axis(c, largest);
    });
    return all;
  }

  /// The faces between elements on both sides of a plane; empty: a node is taken.
  std::vector<Triangle> section(Vec3 at, Vec3 axis) const {
    std::vector<Triangle> faces;
    for (const std::uint32_t t : region_.members) {
      if (is_beyond(t, at, axis)) continue;
      for (int i = 0; i < 4; ++i) {
        const HalfFace other = across_[4 * HalfFace{t} + static_cast<HalfFace>(i)];
        if (other == kNone || !is_own_[other / 4] || !is_beyond(other / 4, at, axis)) continue;
        const Triangle face = face_of_tet(mesh_.mesh().tets[t], i);
        if (std::ranges::any_of(face, [&](VertexIndex v) { return is_taken_[v]; })) return {};
        faces.push_back(face);
      }
    }
    return faces;
  }

 private:
  bool is_beyond(TetIndex t, Vec3 at, Vec3 axis) const {
    Vec3 sum{};
    for (const VertexIndex v : mesh_.mesh().tets[t]) sum += mesh_.mesh().points[v] - at;
    return dot(sum, axis) > 0;
  }
  /// Largest first.
  std::vector<Cylinder> cylinders() const {
    std::vector<Cylinder> all;
    for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
      if (bounds(patch))
        if (const std::optional<Cylinder> c = cylinder_of(triangles_of(mesh_, patch))) all.push_back(*c);
    std::ranges::stable_sort(all, std::greater<>(), [](const Cylinder& c) { return c.radius * c.half_length; });
    return all;
  }
  bool bounds(const Part& patch) const {
    return std::ranges::all_of(patch.members, [&](std::uint32_t f) {
      const auto& [tet, face] = mesh_.sides()[f];
      const HalfFace other = across_[4 * HalfFace{tet} + static_cast<HalfFace>(face)];
      return is_own_[tet] || (other != kNone && is_own_[other / 4]);
    });
  }
  void mark_taken(const std::vector<std::uint32_t>& tied) {
    is_taken_.assign(mesh_.points(), 0);
    for (TetIndex t = 0; t < mesh_.tets(); ++t)
      if (!is_own_[t])
        for (const VertexIndex v : mesh_.mesh().tets[t]) is_taken_[v] = 1;
    for (std::size_t f = 0; f < mesh_.mesh().boundary.size(); ++f)
      if (std::ranges::find(tied, mesh_.patch_of(f)) != tied.end())
        for (const VertexIndex v : mesh_.face(f)) is_taken_[v] = 1;
  }

  const MeshParts& mesh_;
  const Part& region_;
  std::vector<HalfFace> across_;
  std::vector<char> is_own_, is_taken_;
};

struct Cut {
  std::string region;
  Vec3 middle, axis;
  std::vector<Triangle> faces;  ///< that look along the axis
};

Cut cut_of(const MeshParts& mesh, std::uint32_t region, const std::vector<std::uint32_t>& tied) {
  const auto regions = mesh.parts(Part::Origin::kRegion);
  const Part& part = *std::ranges::find(regions, region, &Part::number);
  const Bolt bolt(mesh, part, tied);
  constexpr int kSteps = 8;  // sections that are tried on each side of a middle
  for (const Cylinder& shank : bolt.shank())
    for (int step = 0; step < 2 * kSteps; ++step) {
      const double t = (step % 2 == 0 ? 0.5 : -0.5) * static_cast<double>(step + step % 2) / kSteps;
      const Vec3 at = shank.middle + shank.axis * (t * shank.half_length);
      std::vector<Triangle> faces = bolt.section(at, shank.axis);
      if (!faces.empty()) return {part.name, at, shank.axis, std::move(faces)};
    }
  throw OptionError(
      fmt::format("`pretension`: every section across the cylinder of \"{}\" meets faces that it shares with other "
                  "parts, or is tied to; let one of them slide (`contacts` split, `friction` 0), or give its hole some "
                  "clearance",
                  part.name));
}

std::string free_name(const TetMesh& mesh, std::string name) {
  const auto is_taken = [&](const std::string& tried) {
    return std::ranges::any_of(mesh.patch_names, [&](const std::string& known) { return known.starts_with(tried); });
  };
  while (is_taken(name)) name += "_2";
  return name;
}

void add_faces_inside(TetMesh& mesh, const std::vector<Triangle>& faces, const std::string& name) {
  std::size_t patches = mesh.patch_names.size();
  mesh.interface_patch.resize(mesh.interfaces.size(), 0);
  for (const auto* list : {&mesh.patch, &mesh.interface_patch})
    for (const std::uint32_t p : *list) patches = std::max<std::size_t>(patches, p + 1);
  mesh.patch_names.resize(std::max<std::size_t>(patches, 1));
  mesh.interfaces.insert(mesh.interfaces.end(), faces.begin(), faces.end());
  mesh.interface_patch.resize(mesh.interfaces.size(), static_cast<std::uint32_t>(mesh.patch_names.size()));
  mesh.patch_names.push_back(name);
}

}  // namespace

std::vector<std::array<Vec3, 3>> triangles_of(const MeshParts& mesh, const Part& part) {
  std::vector<std::array<Vec3, 3>> all;
  const std::vector<Vec3>& p = mesh.mesh().points;
  for (const std::uint32_t f : part.members) {
    const auto& [a, b, c] = mesh.face(f);
    all.push_back({p[a], p[b], p[c]});
  }
  return all;
}

BoltSection open_bolt(TetMesh& mesh, std::uint32_t region, const std::vector<std::uint32_t>& tied) {
  if (!mesh.wide_cells.empty())
    throw OptionError("`pretension`: a section cuts tetrahedra, not the wedges of layers; give them up by `as_tets`");
  const Cut cut = cut_of(MeshParts(mesh), region, tied);
  const std::string name = free_name(mesh, cut.region + " section");
  add_faces_inside(mesh, cut.faces, name);
  split_patches(mesh, {name});
  const auto in_front =
      static_cast<std::uint32_t>(std::ranges::find(mesh.patch_names, name + "_plus") - mesh.patch_names.begin());
  std::erase_if(mesh.opened_contacts,
                [&](const OpenedContact& c) { return c.first == in_front || c.second == in_front; });
  return {.region = region, .middle = cut.middle, .axis = cut.axis, .in_front = in_front};
}

}  // namespace octafront::io
