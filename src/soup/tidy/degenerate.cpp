#include "base/geometry/predicates.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <queue>
#include <tuple>
#include <unordered_map>

namespace octafront::tidy {
namespace {

bool has_repeated_vertex(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

bool on_a_line(const SurfaceMesh& mesh, const Triangle& t) {
  return collinear(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
}

/// Divides the faces at the longest edge of a flat face at the flat face's middle corner, and drops the flat face:
///
///        s                  s
///       / \                /|\           The point set stays the same, and so does what is closed. A neighbour that
///      /   \              / | \          is flat itself leaves two flat faces, each with a shorter longest edge:
///     p-----q    ->      p--r--q         worked off longest first, this ends.
///      `-r-'              h1 h2
///      h1 h2
class FlatFaces {
 public:
  explicit FlatFaces(Draft& draft) : draft_(draft), mesh_(draft.mesh), dropped_(mesh_.triangles.size(), 0) {
    std::vector<std::uint32_t> flat;
    near_.resize(mesh_.points.size(), 0);
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      if (f % 4096 == 0) draft_.context.check();
      if (!on_a_line(mesh_, mesh_.triangles[f])) continue;
      flat.push_back(f);
      for (const VertexIndex v : mesh_.triangles[f]) near_[v] = 1;
    }
    budget_ = 1000 + 100 * flat.size();
    if (flat.empty()) return;
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) link(f);
    for (const std::uint32_t f : flat) enqueue(f);
  }

  void close_up(Degenerate& done) {
    if (queue_.empty()) return;
    for (; !queue_.empty() && budget_ > 0; --budget_) {
      draft_.context.check();
      const auto [size, order, f, triangle] = queue_.top();
      queue_.pop();
      if (dropped_[f] || mesh_.triangles[f] != triangle) continue;
      done.faces.push_back(draft_.face[f]);
      ++done.removed;
      close_up(f, done);
    }
    drop_marked(draft_, dropped_);
  }

 private:
  static std::uint64_t key(VertexIndex a, VertexIndex b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
  }

  /// Enters or removes face f at its edges between corners of flat faces; no other edge is ever looked up.
  void link(std::uint32_t f, bool enters = true) {
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = mesh_.triangles[f][i], b = mesh_.triangles[f][(i + 1) % 3];
      if (!near_[a] || !near_[b]) continue;
      std::vector<std::uint32_t>& faces = faces_at_[key(a, b)];
      if (enters) faces.push_back(f);
      if (!enters) std::erase(faces, f);
    }
  }
  void unlink(std::uint32_t f) { link(f, false); }

  void enqueue(std::uint32_t f) {
    const auto [p, r, q] = along_line(f);
    queue_.push({squared_length(mesh_.points[q] - mesh_.points[p]), kNone - f, f, mesh_.triangles[f]});
  }

  /// The corners of a flat face in order along their line: points of a line are in lexicographic order.
  Triangle along_line(std::uint32_t f) const {
    Triangle t = mesh_.triangles[f];
    std::sort(t.begin(), t.end(), [&](VertexIndex a, VertexIndex b) {
      const Vec3 u = mesh_.points[a], v = mesh_.points[b];
      return std::tie(u.x, u.y, u.z) < std::tie(v.x, v.y, v.z);
    });
    return t;
  }

  void close_up(std::uint32_t f, Degenerate& done) {
    const auto [p, r, q] = along_line(f);
    unlink(f);
    dropped_[f] = 1;
    std::vector<std::uint32_t> neighbours;
    neighbours.swap(faces_at_[key(p, q)]);
    for (const std::uint32_t g : neighbours) {
      unlink(g);
      Triangle& half = mesh_.triangles[g];
      if (std::find(half.begin(), half.end(), r) != half.end()) {  // lies on f
        dropped_[g] = 1;
        ++done.removed;
        done.faces.push_back(draft_.face[g]);
        continue;
      }
      Triangle other = half;
      std::replace(half.begin(), half.end(), q, r);
      std::replace(other.begin(), other.end(), p, r);
      const std::uint32_t added = append(other, g);
      ++done.divided;
      for (const std::uint32_t h : {g, added}) {
        link(h);
        if (on_a_line(mesh_, mesh_.triangles[h])) enqueue(h);
      }
    }
  }

  std::uint32_t append(const Triangle& t, std::uint32_t like) {
    mesh_.triangles.push_back(t);
    draft_.face.push_back(draft_.face[like]);
    if (!mesh_.patch.empty()) mesh_.patch.push_back(mesh_.patch[like]);
    if (!mesh_.sides.empty()) mesh_.sides.push_back(mesh_.sides[like]);
    dropped_.push_back(0);
    return static_cast<std::uint32_t>(mesh_.triangles.size() - 1);
  }

  Draft& draft_;
  SurfaceMesh& mesh_;
  std::vector<char> near_;     // per vertex: a corner of a flat face
  std::vector<char> dropped_;  // per triangle
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> faces_at_;
  // Longest edge squared, then smaller face first; the triangle tells whether the entry is still true.
  std::priority_queue<std::tuple<double, std::uint32_t, std::uint32_t, Triangle>> queue_;
  std::size_t budget_ = 0;
};

}  // namespace

Degenerate drop_degenerate(Draft& draft) {
  Degenerate done;
  std::vector<char> marked(draft.mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < marked.size(); ++t) {
    if (!has_repeated_vertex(draft.mesh.triangles[t])) continue;
    marked[t] = 1;
    ++done.removed;
    done.faces.push_back(draft.face[t]);
  }
  if (done.removed > 0) drop_marked(draft, marked);
  FlatFaces(draft).close_up(done);
  sort_unique(done.faces);
  return done;
}

}  // namespace octafront::tidy
