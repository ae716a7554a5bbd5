#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <map>

#include <fmt/core.h>

namespace octafront {

using Kind = MendChange::Kind;

namespace mend {
namespace {

Vec3 middle_of(const std::vector<Vec3>& points, const Triangle& t) {
  return centroid(points[t[0]], points[t[1]], points[t[2]]);
}

/// Triangles gathered into changes by the number of what they belong to.
class Gathered {
 public:
  explicit Gathered(Kind kind) : kind_(kind) {}

  void add(std::uint32_t number, Vec3 at, double area, std::uint32_t face) {
    const auto [place, is_new] = change_.try_emplace(number, MendChange{kind_, at, 0, 0, true, face});
    MendChange& change = place->second;
    change.size += area;
    ++change.faces;
    change.first_face = std::min(change.first_face, face);
  }

  void move_to(MendReport& report) const {
    for (const auto& [number, change] : change_) report.changes.push_back(change);
  }

 private:
  Kind kind_;
  std::map<std::uint32_t, MendChange> change_;
};

}  // namespace

void note_cuts(MendReport& report, const Arrangement& arranged, const std::vector<std::uint32_t>& face) {
  if (arranged.crossing_pairs == 0) return;
  std::vector<std::uint32_t> parts(arranged.origins.size() + 1, 0);
  std::uint32_t most = 0;
  for (const Origin& o : arranged.origins) most = std::max(most, o.triangle);
  parts.assign(most + 1, 0);
  for (const Origin& o : arranged.origins) ++parts[o.triangle];
  const auto is_cut = [&](std::size_t t) {
    const auto origins = arranged.origins_of(t);
    return origins.size() > 1 || parts[origins[0].triangle] > 1;
  };
  DisjointSets groups(arranged.points.size());
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t)
    if (is_cut(t))
      for (const VertexIndex v : arranged.triangles[t]) groups.join(arranged.triangles[t][0], v);
  Gathered cuts(Kind::kCut);
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    if (!is_cut(t)) continue;
    std::uint32_t first = kNone;
    for (const Origin& o : arranged.origins_of(t))
      if (o.triangle < face.size()) first = std::min(first, face[o.triangle]);
    cuts.add(groups.find(arranged.triangles[t][0]), middle_of(arranged.points, arranged.triangles[t]),
             triangle_area(arranged.points, arranged.triangles[t]), first);
  }
  cuts.move_to(report);
}

void note_dropped(MendReport& report, tidy::Draft& draft, const std::vector<char>& used) {
  const EdgeTable& table = draft.edges();
  DisjointSets parts(draft.mesh.triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e) {
    std::uint32_t first = kNone;
    for (const HalfEdge h : table.uses(e)) {
      if (used[h / 3]) continue;
      if (first != kNone) parts.join(first, h / 3);
      first = h / 3;
    }
  }
  Gathered dropped(Kind::kDropped);
  for (std::uint32_t t = 0; t < used.size(); ++t) {
    if (used[t]) continue;
    dropped.add(parts.find(t), middle_of(draft.mesh.points, draft.mesh.triangles[t]),
                triangle_area(draft.mesh.points, draft.mesh.triangles[t]), draft.face[t]);
  }
  dropped.move_to(report);
}

void note_turned(MendReport& report, const tidy::Draft& draft, const std::vector<std::uint32_t>& piece,
                 const std::vector<char>& turned, const tidy::InputFaces& faces) {
  Gathered all(Kind::kTurned);
  for (std::uint32_t t = 0; t < draft.mesh.triangles.size(); ++t) {
    const bool before = std::binary_search(faces.begin(), faces.end(), draft.face[t]);
    if (before == static_cast<bool>(turned[piece[t]])) continue;
    all.add(piece[t], middle_of(draft.mesh.points, draft.mesh.triangles[t]),
            triangle_area(draft.mesh.points, draft.mesh.triangles[t]), draft.face[t]);
  }
  all.move_to(report);
}

void note_filled(MendReport& report, const Arrangement& arranged, const Cells& cells,
                 const std::vector<std::uint32_t>& filled) {
  if (filled.empty()) return;
  const std::vector<double> volumes = cells.volumes();
  std::vector<Vec3> at(cells.count());
  std::vector<std::uint64_t> walls(cells.count(), 0);
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t)
    for (const std::uint32_t c : cells.sides_of(t)) {
      at[c] = middle_of(arranged.points, arranged.triangles[t]);
      ++walls[c];
    }
  for (const std::uint32_t c : filled) report.changes.push_back({Kind::kFilled, at[c], volumes[c], walls[c]});
}

namespace {

struct Sum {
  std::uint64_t changes = 0, faces = 0;
  double size = 0, largest = 0;
};

Sum sum_of(const MendReport& report, Kind kind) {
  Sum sum;
  for (const MendChange& c : report.changes) {
    if (c.kind != kind) continue;
    ++sum.changes;
    sum.faces += c.faces;
    sum.size += c.size;
    sum.largest = std::max(sum.largest, c.size);
  }
  return sum;
}

void note_closed(MendReport& report) {
  const Sum holes = sum_of(report, Kind::kClosed);
  if (holes.changes == 0) return;
  const auto beyond = std::count_if(report.changes.begin(), report.changes.end(),
                                    [](const MendChange& c) { return c.kind == Kind::kClosed && !c.within_tolerance; });
  report.notes.push_back(
      fmt::format("{} closed, of area {:.4g} in all, the largest {:.4g}{}.", counted(holes.changes, "hole"), holes.size,
                  holes.largest,
                  beyond == 0 ? ", all within the tolerance"
                              : fmt::format("; {} beyond the tolerance: patch \"{}\"", beyond, kClosedByRepair)));
  if (report.based_holes > 0)
    report.notes.push_back(fmt::format("{} closed by walls and a flat base, for a lid would have grazed the surface.",
                                       counted(report.based_holes, "hole")));
}

/// A dropped part of the surface's area that may have been meant: an inner wall, a crack.
constexpr double kWorthKeeping = 1e-3;

void note_lost(MendReport& report) {
  const Sum dropped = sum_of(report, Kind::kDropped);
  if (dropped.changes == 0) return;
  const bool may_matter = dropped.largest > kWorthKeeping * report.area_before;
  report.notes.push_back(fmt::format("{} dropped ({}, area {:.4g}): inside of others, or bounding nothing{}.",
                                     counted(dropped.changes, "part"), counted(dropped.faces, "face"), dropped.size,
                                     may_matter ? "; `cells` regions keeps inner walls and cracks" : ""));
}

void write_notes(MendReport& report) {
  auto& notes = report.notes;
  if (report.joined_vertices + report.divided_edges > 0)
    notes.push_back(fmt::format("open edges brought together: {} joined, {} divided.",
                                counted(report.joined_vertices, "vertex", "vertices"),
                                counted(report.divided_edges, "edge")));
  if (const Sum turned = sum_of(report, Kind::kTurned); turned.changes > 0)
    notes.push_back(fmt::format("{} turned, in {}.", counted(turned.faces, "face"), counted(turned.changes, "part")));
  if (const Sum flat = sum_of(report, Kind::kLaidFlat); flat.changes > 0)
    notes.push_back(
        fmt::format("{} that crossed themselves within the tolerance laid flat.", counted(flat.changes, "crumple")));
  note_closed(report);
  if (report.crossing_pairs > 0)
    notes.push_back(fmt::format("{} of faces that crossed, overlapped or touched resolved, in {}.",
                                counted(report.crossing_pairs, "pair"),
                                counted(sum_of(report, Kind::kCut).changes, "place")));
  if (const Sum filled = sum_of(report, Kind::kFilled); filled.changes > 0)
    notes.push_back(fmt::format("{} narrower than the tolerance filled.", counted(filled.changes, "enclosed gap")));
  note_lost(report);
  if (report.separated_vertices > 0)
    notes.push_back(
        fmt::format("parts that touched drawn apart at {}.", counted(report.separated_vertices, "vertex", "vertices")));
  if (const Sum rebuilt = sum_of(report, Kind::kRebuilt); rebuilt.changes > 0)
    notes.push_back(fmt::format("the surface was made anew on a lattice: {}.", counted(rebuilt.faces, "face")));
  const auto change = [](double before, double after) { return before > 0 ? 100 * (after / before - 1) : 0.0; };
  notes.push_back(fmt::format("nothing moved by more than {:.3g} (tolerance {:.3g}); area {:+.2f} %, volume {:+.2f} %.",
                              report.largest_move, report.tolerance, change(report.area_before, report.area_after),
                              change(report.volume_before, report.volume_after)));
}

/// Vertices at one place are one: a clean surface comes back as it is.
std::uint32_t parts_of(const SurfaceMesh& surface, const RunContext& context) {
  tidy::Draft draft{{surface.points, surface.triangles, {}, {}, {}}, {}, context};
  tidy::merge_vertices(draft);
  const SurfaceMesh& joined = draft.mesh;
  DisjointSets sets(joined.points.size());
  for (const auto& [a, b, c] : joined.triangles) sets.join(a, b), sets.join(a, c);
  std::uint32_t parts = 0;
  for (std::uint32_t v = 0; v < joined.points.size(); ++v) parts += sets.find(v) == v;
  return parts;
}

}  // namespace

void finish_report(MendReport& report, const SurfaceMesh& result, const RunContext& context) {
  report.area_after = area(result);
  report.volume_after = std::abs(enclosed_volume(result));
  report.bodies = parts_of(result, context);
  std::stable_sort(report.changes.begin(), report.changes.end(),
                   [](const MendChange& a, const MendChange& b) { return a.kind < b.kind; });
  if (!report.clean) write_notes(report);
}

}  // namespace mend

std::uint64_t MendReport::count(Kind kind) const {
  return static_cast<std::uint64_t>(
      std::count_if(changes.begin(), changes.end(), [kind](const MendChange& c) { return c.kind == kind; }));
}

}  // namespace octafront
