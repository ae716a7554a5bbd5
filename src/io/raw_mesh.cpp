#include "io/raw_mesh.h"

#include "geometry/predicates.h"
#include "io/boundary.h"
#include "mesh/renumber.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// From references of a file to numbers from 0.
class Numbering {
 public:
  explicit Numbering(const std::vector<std::int64_t>& refs) {
    // Consecutive elements mostly share a reference: equal neighbours are passed over before sorting.
    for (const std::int64_t r : refs)
      if (sorted_.empty() || sorted_.back() != r) sorted_.push_back(r);
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
    constexpr std::int64_t kMostKept = 1 << 20;  // what follows may keep a table of them
    keeps_ = sorted_.empty() || (sorted_.front() >= 1 && sorted_.back() <= kMostKept);
  }

  std::uint32_t number(std::int64_t ref) const {
    if (keeps_) return static_cast<std::uint32_t>(ref - 1);
    return static_cast<std::uint32_t>(std::lower_bound(sorted_.begin(), sorted_.end(), ref) - sorted_.begin());
  }
  bool has(std::int64_t ref) const { return std::binary_search(sorted_.begin(), sorted_.end(), ref); }
  std::uint32_t unused() const { return sorted_.empty() ? 0 : number(sorted_.back()) + 1; }

  /// Empty if all are 0.
  std::vector<std::uint32_t> numbers(const std::vector<std::int64_t>& refs) const {
    std::vector<std::uint32_t> all;
    all.reserve(refs.size());
    for (const std::int64_t r : refs) all.push_back(number(r));
    if (std::all_of(all.begin(), all.end(), [](std::uint32_t n) { return n == 0; })) all.clear();
    return all;
  }

 private:
  std::vector<std::int64_t> sorted_;
  bool keeps_;
};

void drop_unused_points(RawMesh& raw) {
  std::vector<VertexIndex> new_of_old(raw.points.size(), kNone);
  for (const Tet& t : raw.tets)
    for (const VertexIndex v : t) new_of_old[v] = 0;
  if (std::find(new_of_old.begin(), new_of_old.end(), kNone) == new_of_old.end()) return;
  keep_numbered(raw.points, new_of_old);
  renumber(raw.tets, new_of_old);
  // Triangles at dropped points bound no tetrahedron; they go with what does not match the boundary.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < raw.triangles.size(); ++i) {
    Triangle t = raw.triangles[i];
    for (VertexIndex& v : t) v = new_of_old[v];
    if (std::find(t.begin(), t.end(), kNone) != t.end()) continue;
    raw.triangles[kept] = t;
    raw.triangle_ref[kept] = raw.triangle_ref[i];
    if (!raw.triangle_source.empty()) raw.triangle_source[kept] = raw.triangle_source[i];
    ++kept;
  }
  raw.triangles.resize(kept);
  raw.triangle_ref.resize(kept);
  if (!raw.triangle_source.empty()) raw.triangle_source.resize(kept);
}

/// The triangles of the file where they are faces of the boundary, in their order, then what is missing.
void order_boundary(const RawMesh& raw, const Numbering& patches, TetMesh& mesh) {
  std::vector<Triangle> faces = boundary_of(mesh.tets, mesh.points.size());
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  // boundary_of() yields the faces sorted by vertices already.
  std::vector<bool> taken(faces.size(), false);
  std::vector<std::int64_t> refs;
  for (std::size_t i = 0; i < raw.triangles.size(); ++i) {
    const Triangle key = sorted(raw.triangles[i]);
    const auto at = std::lower_bound(faces.begin(), faces.end(), key,
                                     [&](const Triangle& f, const Triangle& k) { return sorted(f) < k; });
    if (at == faces.end() || sorted(*at) != key) continue;
    const auto f = static_cast<std::size_t>(at - faces.begin());
    if (taken[f]) continue;
    taken[f] = true;
    // Keep the corner that the file has first, so that a triangle that faces outward already stays as it is.
    while ((*at)[0] != raw.triangles[i][0]) std::rotate(at->begin(), at->begin() + 1, at->end());
    mesh.boundary.push_back(*at);
    mesh.patch.push_back(patches.number(raw.triangle_ref[i]));
    if (!raw.triangle_source.empty()) mesh.source.push_back(raw.triangle_source[i]);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (taken[f]) continue;
    mesh.boundary.push_back(faces[f]);
    mesh.patch.push_back(patches.unused());
    if (!raw.triangle_source.empty()) mesh.source.push_back(kNone);
  }
  if (std::all_of(mesh.patch.begin(), mesh.patch.end(), [](std::uint32_t p) { return p == 0; })) mesh.patch.clear();
}

}  // namespace

TetMesh ordered_mesh(RawMesh raw, const Input& input) {
  if (raw.tets.empty())
    input.fail(raw.other_elements + raw.triangles.size() > 0
                   ? fmt::format("holds no linear tetrahedra, only {} triangles and {} elements of other kinds",
                                 raw.triangles.size(), raw.other_elements)
                   : "holds no elements");
  input.context.check();
  drop_unused_points(raw);
  input.context.check();
  TetMesh mesh;
  mesh.points = std::move(raw.points);
  mesh.tets = std::move(raw.tets);
  for (auto& [a, b, c, d] : mesh.tets)
    if (orient3d(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) < 0) std::swap(c, d);
  mesh.region = Numbering(raw.tet_ref).numbers(raw.tet_ref);
  const Numbering patches(raw.triangle_ref);
  input.context.check();
  order_boundary(raw, patches, mesh);
  for (const auto& [ref, name] : raw.surface_names) {
    if (!patches.has(ref)) continue;
    const std::uint32_t patch = patches.number(ref);
    if (patch >= mesh.patch_names.size()) mesh.patch_names.resize(patch + 1);
    mesh.patch_names[patch] = name;
  }
  return mesh;
}

}  // namespace octafront::io
