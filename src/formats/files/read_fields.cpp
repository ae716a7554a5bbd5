// Fields of the file that a mesh was read from.

#include <octafront/field_files.h>

#include "formats/containers/input.h"
#include "formats/files/size_readers.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/core.h>

namespace octafront {
namespace {

/// A name that no field has: a reader that is asked for it lists all there are.
const std::string kNoField("\0", 1);
/// The quality that our writers put beside every mesh is not known of one that is made of it.
constexpr std::string_view kOwn = "beta";

io::RawMesh read_with(const io::Input& input, const std::string& field) {
  io::Input asked = input;
  asked.field = &field;
  asked.wants_tensors = asked.wants_element_tensors = true;
  return read_with_field(asked);
}

bool are_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Takes what a file has under a name, at points, in tetrahedra or both.
class FieldTaker {
 public:
  FieldTaker(const io::Input& input, const TetMesh& mesh, bool is_strict)
      : input_(input), mesh_(mesh), is_strict_(is_strict) {}

  void take(const std::string& name) {
    io::RawMesh raw = read_with(input_, name);
    require_same(raw);
    const std::size_t before = out.fields.size();
    const std::size_t n = raw.points.empty() ? 0 : raw.field.at_points.size() / raw.points.size();
    const bool has_tets = !raw.field.at_tets.empty();
    const std::size_t of_tet = raw.tets.empty() ? 0 : raw.field.at_tets.size() / raw.tets.size();
    if (n > 0) put_in_order(raw, n);
    if (n == 0 && !has_tets) leave_out(name, "it has not one for each point, or each tetrahedron");
    if (n > 0) add({name, false, n, std::move(raw.field.at_points)}, n * mesh_.points.size());
    if (has_tets) add({name, true, of_tet, std::move(raw.field.at_tets)}, of_tet * mesh_.tets.size());
    if (is_strict_ && out.fields.size() == before)
      input_.fail(fmt::format("the field {} cannot be carried: {}", io::in_quotes(name), why_));
  }

  FieldsOfFile out;

 private:
  void require_same(const io::RawMesh& raw) {
    if (raw.tets.size() == mesh_.tets.size()) {
      if (raw.points == mesh_.points) return;
      if (mesh_.order() > 1 && find_order(raw.points)) return;
    }
    input_.fail(fmt::format("its {} points are not those of the mesh, {}: there are points of no element",
                            raw.points.size(), mesh_.points.size()));
  }

  /// Whether the points are the same in another order: that of the file is kept for corners alone.
  bool find_order(const std::vector<Vec3>& points) {
    const auto ascending = [](const std::vector<Vec3>& of) {
      std::vector<VertexIndex> order(of.size());
      std::iota(order.begin(), order.end(), 0);
      std::sort(order.begin(), order.end(), [&](VertexIndex a, VertexIndex b) {
        return std::tie(of[a].x, of[a].y, of[a].z) < std::tie(of[b].x, of[b].y, of[b].z);
      });
      return order;
    };
    const std::vector<VertexIndex> theirs = ascending(points), ours = ascending(mesh_.points);
    if (points.size() != mesh_.points.size()) return false;
    of_ours_.resize(ours.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
      if (points[theirs[i]] != mesh_.points[ours[i]] || (i > 0 && points[theirs[i]] == points[theirs[i - 1]]))
        return false;
      of_ours_[ours[i]] = theirs[i];
    }
    return true;
  }

  void put_in_order(io::RawMesh& raw, std::size_t components) const {
    if (of_ours_.empty()) return;
    std::vector<double> values;
    for (const VertexIndex v : of_ours_)
      for (std::size_t k = 0; k < components; ++k) values.push_back(raw.field.at_points[v * components + k]);
    raw.field.at_points = std::move(values);
  }

  void add(MeshField field, std::size_t expected) {
    if (field.values.size() != expected) return leave_out(field.name, "it has not one for each");
    if (!are_finite(field.values)) return leave_out(field.name, "it has values that are not finite");
    out.fields.push_back(std::move(field));
  }
  void leave_out(const std::string& name, const char* why) {
    why_ = why;
    out.notes.push_back(fmt::format("the field {} is left out: {}", io::in_quotes(name), why));
  }

  const io::Input& input_;
  const TetMesh& mesh_;
  bool is_strict_;
  std::string why_;
  std::vector<VertexIndex> of_ours_;  ///< per point of the mesh that of the file; empty: the same
};

}  // namespace

FieldsOfFile read_fields(const std::string& file, const TetMesh& mesh, const std::vector<std::string>& names,
                         const RunContext& context) {
  const io::LoadedFile loaded(file, context);
  const io::Input& input = loaded.input();
  std::vector<std::string> there = read_with(input, kNoField).field.names;
  std::erase(there, kOwn);
  for (const std::string& name : names)
    if (std::find(there.begin(), there.end(), name) == there.end()) {
      std::string list;
      for (const std::string& known : there) list += (list.empty() ? "; there are " : ", ") + io::in_quotes(known);
      input.fail(fmt::format("has no field {}{}", io::in_quotes(name), list));
    }
  FieldTaker taker(input, mesh, !names.empty());
  for (const std::string& name : names.empty() ? there : names) taker.take(name);
  return std::move(taker.out);
}

}  // namespace octafront
