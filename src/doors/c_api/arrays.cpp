#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/octafront_c.h>
#include <octafront/quality.h>
#include <octafront/report.h>
#include <octafront/vec.h>

#include "doors/c_api/c_api.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

/// The numbers of which an element of a list consists.
template <class Element>
struct Layout {
  static constexpr std::uint32_t kType = OCTAFRONT_U32, kColumns = sizeof(Element) / sizeof(std::uint32_t);
};
template <>
struct Layout<Vec3> {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  static constexpr std::uint32_t kType = OCTAFRONT_F64, kColumns = 3;
};
template <>
struct Layout<std::array<Vec3, 3>> {
  static_assert(sizeof(std::array<Vec3, 3>) == 9 * sizeof(double));
  static constexpr std::uint32_t kType = OCTAFRONT_F64, kColumns = 9;
};
template <>
struct Layout<double> {
  static constexpr std::uint32_t kType = OCTAFRONT_F64, kColumns = 1;
};

template <class Element>
octafront_array array_of(const std::vector<Element>& list) {
  return {list.data(), list.size(), Layout<Element>::kColumns, Layout<Element>::kType};
}

template <class Element>
void assign(std::vector<Element>& list, const void* data, std::size_t rows) {
  list.resize(rows);
  if (rows > 0) std::memcpy(list.data(), data, rows * sizeof(Element));
}

/// Calls visit(list) for the list of that name. One place says what the arrays of a surface are called...
template <class Surface, class Visit>
void visit_surface_array(Surface& surface, std::string_view name, const Visit& visit) {
  auto& mesh = surface.domain.surface;
  if (name == "points") return visit(mesh.points);
  if (name == "triangles") return visit(mesh.triangles);
  if (name == "patch") return visit(mesh.patch);
  if (name == "source") return visit(mesh.source);
  if (name == "sides") return visit(mesh.sides);
  if (name == "bound") return visit(surface.domain.bound);
  throw OptionError(fmt::format("a surface has no array \"{}\"", name));
}

/// ... and those of a mesh.
template <class Mesh, class Visit>
void visit_mesh_array(Mesh& mesh, std::string_view name, const Visit& visit) {
  if (name == "points") return visit(mesh.points);
  if (name == "tets") return visit(mesh.tets);
  if (name == "region") return visit(mesh.region);
  if (name == "boundary") return visit(mesh.boundary);
  if (name == "patch") return visit(mesh.patch);
  if (name == "source") return visit(mesh.source);
  if (name == "interfaces") return visit(mesh.interfaces);
  if (name == "interface_patch") return visit(mesh.interface_patch);
  if (name == "curve_edges") return visit(mesh.curve_edges);
  if (name == "curve") return visit(mesh.curve);
  if (name == "mid_nodes") return visit(mesh.mid_nodes);
  if (name == "high_nodes") return visit(mesh.high_nodes);
  if (name == "wide_cells") return visit(mesh.wide_cells);
  if (name == "wide_faces") return visit(mesh.wide_faces);
  if (name == "split_faces") return visit(mesh.split_faces);
  if (name == "opened_contacts") return visit(mesh.opened_contacts);
  if (name == "periods") return visit(mesh.periods);
  if (name == "period_rotations") return visit(mesh.period_rotations);
  if (name == "periodic_nodes") return visit(mesh.periodic_nodes);
  throw OptionError(fmt::format("a mesh has no array \"{}\"", name));
}

template <class Mesh>
auto& names_of(Mesh& mesh, std::string_view list) {
  if (list == "patch_names") return mesh.patch_names;
  if (list == "region_names") return mesh.region_names;
  if constexpr (requires { mesh.curve_names; })
    if (list == "curve_names") return mesh.curve_names;
  throw OptionError(fmt::format("there is no list of names \"{}\"", list));
}

template <class Mesh>
const char* name_in_list(const Mesh& mesh, const char* list, std::size_t i, std::size_t* length) {
  const char* found = nullptr;
  guarded([&] {
    const auto& names = names_of(mesh, list);
    if (i >= names.size()) return;
    *length = names[i].size();
    found = names[i].c_str();
  });
  return found;
}

void require_length(std::size_t length, std::size_t wanted, const char* list, const char* owner) {
  if (length != 0 && length != wanted)
    throw InputError(
        fmt::format("{} has {} values for {} {}: give one for each, or none", list, length, wanted, owner));
}

template <class Element>
void require_range(const std::vector<Element>& list, std::size_t points, const char* what) {
  for (std::size_t i = 0; i < list.size(); ++i)
    for (const VertexIndex v : list[i])
      if (v >= points)
        throw InputError(
            fmt::format("{} {} names point {}, but there are {} points, counted from 0", what, i, v, points));
}

/// Wedges, pyramids and quadrilaterals name tetrahedra, faces and points that there are.
void require_wide_range(const TetMesh& m) {
  const auto require = [](bool is_there, const char* what, std::size_t i) {
    if (!is_there) throw InputError(fmt::format("row {} of {} names what there is not", i, what));
  };
  for (std::size_t i = 0; i < m.wide_cells.size(); ++i) {
    const WideCell& cell = m.wide_cells[i];
    const std::size_t count = cell.tet_count;
    require((count == 2 || count == 3) && count <= m.tets.size() && cell.first <= m.tets.size() - count, "wide_cells",
            i);
    for (std::size_t k = 0; k < count + 3; ++k) require(cell.nodes[k] < m.points.size(), "wide_cells", i);
  }
  for (std::size_t i = 0; i < m.wide_faces.size(); ++i) {
    require(m.boundary.size() >= 2 && m.wide_faces[i].first <= m.boundary.size() - 2, "wide_faces", i);
    for (const VertexIndex v : m.wide_faces[i].nodes) require(v < m.points.size(), "wide_faces", i);
  }
}

/// By how many high nodes there are.
std::uint32_t high_order_of(const TetMesh& m) {
  const std::size_t each = m.tets.empty() ? 0 : m.high_nodes.size() / m.tets.size();
  if (m.high_nodes.empty()) return 0;
  if ((each != 16 && each != 31) || each * m.tets.size() != m.high_nodes.size())
    throw InputError(
        fmt::format("high_nodes has {} values for {} tets, which come first: give 16 each (order 3), or 31 "
                    "(order 4)",
                    m.high_nodes.size(), m.tets.size()));
  return each == 16 ? 3 : 4;
}

void require_finite_points(const std::vector<Vec3>& points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_finite(points[i]))
      throw InputError(fmt::format("point {} has coordinates ({}, {}, {}): they must be finite", i, points[i].x,
                                   points[i].y, points[i].z));
}

}  // namespace

void require_indices(const SurfaceMesh& s) {
  require_finite_points(s.points);
  require_range(s.triangles, s.points.size(), "triangle");
  require_length(s.patch.size(), s.triangles.size(), "patches", "triangles");
  require_length(s.source.size(), s.triangles.size(), "sources", "triangles");
  require_length(s.sides.size(), s.triangles.size(), "sides", "triangles");
}

void require_indices(const TetMesh& m) {
  require_finite_points(m.points);
  require_range(m.tets, m.points.size(), "tet");
  require_range(m.boundary, m.points.size(), "face");
  require_range(m.interfaces, m.points.size(), "interface");
  require_range(m.curve_edges, m.points.size(), "curve edge");
  require_range(m.mid_nodes, m.points.size(), "row of mid_nodes");
  for (const VertexIndex v : m.high_nodes)
    if (v >= m.points.size()) throw InputError(fmt::format("high_nodes names point {} of {}", v, m.points.size()));
  require_wide_range(m);
  for (const auto& [period, copy, original] : m.periodic_nodes)
    if (period >= m.periods.size() || copy >= m.points.size() || original >= m.points.size())
      throw InputError("periodic_nodes names a period or a point that there is not");
  require_length(m.period_rotations.size(), m.periods.size(), "period_rotations", "periods");
  require_length(m.region.size(), m.tets.size(), "regions", "tets");
  require_length(m.mid_nodes.size(), m.tets.size(), "mid_nodes", "tets");
  require_length(m.patch.size(), m.boundary.size(), "patches", "faces");
  require_length(m.source.size(), m.boundary.size(), "sources", "faces");
  require_length(m.interface_patch.size(), m.interfaces.size(), "interface patches", "interfaces");
  require_length(m.curve.size(), m.curve_edges.size(), "curves", "curve edges");
}

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_surface* octafront_surface_new() {
  return new octafront_surface;
}

void octafront_surface_free(octafront_surface* surface) {
  delete surface;
}

int octafront_surface_array(const octafront_surface* surface, const char* name, octafront_array* out) {
  return guarded([&] { visit_surface_array(*surface, name, [&](const auto& list) { *out = array_of(list); }); });
}

int octafront_surface_set_array(octafront_surface* surface, const char* name, const void* data, size_t rows) {
  return guarded([&] { visit_surface_array(*surface, name, [&](auto& list) { assign(list, data, rows); }); });
}

int octafront_surface_add_name(octafront_surface* surface, const char* list, const char* name, size_t length) {
  return guarded([&] { names_of(surface->domain.surface, list).emplace_back(name, length); });
}

const char* octafront_surface_name(const octafront_surface* surface, const char* list, size_t i, size_t* length) {
  return name_in_list(surface->domain.surface, list, i, length);
}

double octafront_surface_voxel(const octafront_surface* surface) {
  return surface->domain.voxel_spacing;
}

void octafront_surface_set_voxel(octafront_surface* surface, double spacing) {
  surface->domain.voxel_spacing = spacing;
}

octafront_mesh* octafront_mesh_new() {
  return new octafront_mesh;
}

void octafront_mesh_free(octafront_mesh* mesh) {
  delete mesh;
}

int octafront_mesh_array(const octafront_mesh* mesh, const char* name, octafront_array* out) {
  return guarded([&] {
    const std::string_view asked(name);
    if (asked == "old_of_new" || asked == "old_tet_of_new")
      *out = array_of(asked == "old_of_new" ? mesh->old_of_new : mesh->old_tet_of_new);
    else
      visit_mesh_array(mesh->mesh, asked, [&](const auto& list) { *out = array_of(list); });
  });
}

int octafront_mesh_set_array(octafront_mesh* mesh, const char* name, const void* data, size_t rows) {
  return guarded([&] {
    visit_mesh_array(mesh->mesh, name, [&](auto& list) { assign(list, data, rows); });
    if (std::string_view(name) == "high_nodes") mesh->mesh.high_order = high_order_of(mesh->mesh);
  });
}

int octafront_mesh_add_name(octafront_mesh* mesh, const char* list, const char* name, size_t length) {
  return guarded([&] { names_of(mesh->mesh, list).emplace_back(name, length); });
}

const char* octafront_mesh_name(const octafront_mesh* mesh, const char* list, size_t i, size_t* length) {
  return name_in_list(mesh->mesh, list, i, length);
}

namespace {

NamedSet::Kind kind_of(int kind) {
  if (kind < OCTAFRONT_NODES || kind > OCTAFRONT_ELEMENTS) throw OptionError(fmt::format("no kind of set is {}", kind));
  return static_cast<NamedSet::Kind>(kind);
}

}  // namespace

size_t octafront_mesh_sets(const octafront_mesh* mesh) {
  return mesh->mesh.sets.size();
}

int octafront_mesh_set(const octafront_mesh* mesh, size_t i, int* kind, const char** name, size_t* length,
                       octafront_array* members) {
  return guarded([&] {
    const NamedSet& set = mesh->mesh.sets.at(i);
    *kind = static_cast<int>(set.kind);
    *name = set.name.c_str();
    *length = set.name.size();
    *members = array_of(set.members);
  });
}

int octafront_mesh_add_set(octafront_mesh* mesh, int kind, const char* name, size_t length, const uint32_t* members,
                           size_t count) {
  return guarded([&] {
    NamedSet set{std::string(name, length), kind_of(kind), {}};
    assign(set.members, members, count);
    const std::size_t most = mesh->mesh.count(set.kind);
    if (std::adjacent_find(set.members.begin(), set.members.end(), std::greater_equal<>()) != set.members.end())
      throw OptionError("the members of a set are ascending, each once");
    if (!set.members.empty() && set.members.back() >= most)
      throw OptionError(fmt::format("the set names {}, but there are {}, counted from 0", set.members.back(), most));
    mesh->mesh.sets.push_back(std::move(set));
  });
}

int octafront_mesh_add_group(octafront_mesh* mesh, int kind, const char* name, size_t length, const double* box,
                             const double* ball, const char* const* patches, size_t patch_count, const char** note) {
  return guarded([&] {
    GroupRule rule{std::string(name, length), kind_of(kind), {}};
    if (box != nullptr) rule.where = Box3{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    if (ball != nullptr) rule.where = GroupRule::Sphere{{ball[0], ball[1], ball[2]}, ball[3]};
    if (patches != nullptr) rule.where = std::vector<std::string>(patches, patches + patch_count);
    *note = kept(add_group(mesh->mesh, rule));
  });
}

int octafront_mesh_quality(const octafront_mesh* mesh, double* beta, double* least, double* largest) {
  return guarded([&] {
    require_indices(mesh->mesh);
    const std::vector<Vec3>& p = mesh->mesh.points;
    for (std::size_t i = 0; i < mesh->mesh.tets.size(); ++i) {
      const auto& [a, b, c, d] = mesh->mesh.tets[i];
      if (beta != nullptr) beta[i] = radius_ratio(p[a], p[b], p[c], p[d]);
      if (least == nullptr && largest == nullptr) continue;
      const auto angles = dihedral_angles(p[a], p[b], p[c], p[d]);
      if (least != nullptr) least[i] = *std::min_element(angles.begin(), angles.end());
      if (largest != nullptr) largest[i] = *std::max_element(angles.begin(), angles.end());
    }
  });
}

int octafront_carry_field(const octafront_mesh* before, const octafront_mesh* adapted, int of_elements,
                          size_t components, const double* values, double* out) {
  return guarded([&] {
    require_indices(before->mesh);
    if (adapted->old_of_new.size() != adapted->mesh.points.size() ||
        adapted->old_tet_of_new.size() != adapted->mesh.tets.size())
      throw InputError("fields are carried to meshes that octafront_adapt() made");
    const std::size_t count = of_elements != 0 ? before->mesh.tets.size() : before->mesh.points.size();
    MeshField field{"values", of_elements != 0, components, {}};
    field.values.assign(values, values + count * components);
    const MeshField made = carried(field, before->mesh, adapted->mesh, adapted->old_of_new, adapted->old_tet_of_new);
    std::copy(made.values.begin(), made.values.end(), out);
  });
}

const char* octafront_mesh_summary(const octafront_mesh* mesh) {
  const char* text = nullptr;
  guarded([&] {
    require_indices(mesh->mesh);
    Report report;
    report.tets = mesh->mesh.tets.size();
    report.quality = summarize_quality(mesh->mesh);
    text = kept(nlohmann::ordered_json::parse(to_json(report))["quality"].dump());
  });
  return text;
}
