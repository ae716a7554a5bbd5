#include <octafront/error.h>
#include <octafront/repair.h>

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/winding_number.h"
#include "doors/intake/cell.h"
#include "doors/intake/intake.h"
#include "soup/cells/bodies.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace octafront::intake {

namespace {

/// Lengths of the body from it to the faces of a box that nobody gave; beside a body of little length, at least so many
/// times its width or height.
constexpr double kBefore = 5, kBehind = 10, kBeside = 5;
constexpr std::array kPatches{"inlet", "outlet", "side_right", "side_left", "ground", "top"};
constexpr const char* kTunnelName = "tunnel";

Box3 box_around(const Box3& body, bool on_ground) {
  const Vec3 extent = body.hi - body.lo;
  const double l = std::max({extent.x, extent.y, extent.z});
  Box3 box{body.lo - Vec3{kBefore * l, kBeside * l, kBeside * l},
           body.hi + Vec3{kBehind * l, kBeside * l, kBeside * l}};
  if (on_ground) box.lo.z = body.lo.z;
  return box;
}

Box3 tunnel_of(std::string text, const Box3& body) {
  if (text == "auto" || text == "ground") return box_around(body, text == "ground");
  std::ranges::replace(text, ':', ',');
  try {
    return box_of_option(text);
  } catch (const OptionError&) {
    throw OptionError(fmt::format(
        "`wind_tunnel` is \"{}\": write auto, ground or X0,Y0,Z0:X1,Y1,Z1, the low corner and the high one", text));
  }
}

/// The box as a body, with its patches.
Body tunnel_body(const Box3& box) {
  Body body = box_body(kTunnelName, box);
  body.surface.patch = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  body.surface.patch_names.assign(kPatches.begin(), kPatches.end());
  return body;
}

/// The walls toward the outside, facing it.
SurfaceMesh outer_walls(const SurfaceMesh& surface) {
  SurfaceMesh walls;
  walls.points = surface.points, walls.patch_names = surface.patch_names;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Sides sides = surface.sides_of(t);
    if ((sides[0] == kNone) == (sides[1] == kNone)) continue;
    Triangle triangle = surface.triangles[t];
    if (sides[1] == kNone) std::swap(triangle[1], triangle[2]);
    walls.triangles.push_back(triangle);
    walls.patch.push_back(surface.patch_of(t));
  }
  return walls;
}

SurfaceMesh of_triangles(const SurfaceMesh& all, const std::vector<std::uint32_t>& triangles) {
  SurfaceMesh part;
  part.patch_names = all.patch_names;
  std::map<VertexIndex, VertexIndex> number;
  for (const std::uint32_t t : triangles) {
    Triangle triangle = all.triangles[t];
    for (VertexIndex& v : triangle) {
      const auto [at, is_new] = number.emplace(v, static_cast<VertexIndex>(part.points.size()));
      if (is_new) part.points.push_back(all.points[v]);
      v = at->second;
    }
    part.triangles.push_back(triangle);
    part.patch.push_back(all.patch_of(t));
  }
  return part;
}

/// The shells of walls: triangles by what is joined by vertices.
std::vector<std::vector<std::uint32_t>> shells_of(const SurfaceMesh& walls) {
  DisjointSets sets(walls.points.size());
  for (const auto& [a, b, c] : walls.triangles) sets.join(a, b), sets.join(b, c);
  std::map<std::uint32_t, std::vector<std::uint32_t>> shells;
  for (std::uint32_t t = 0; t < walls.triangles.size(); ++t) shells[sets.find(walls.triangles[t][0])].push_back(t);
  std::vector<std::vector<std::uint32_t>> list;
  for (auto& [root, triangles] : shells) list.push_back(std::move(triangles));
  return list;
}

/// Without cavities, and what lies in them: no flow gets there.
SurfaceMesh without_cavities(const SurfaceMesh& walls, std::size_t& left_out) {
  std::vector<std::vector<std::uint32_t>> solid;
  const auto shells = shells_of(walls);
  for (const auto& shell : shells)
    if (enclosed_volume(of_triangles(walls, shell)) > 0) solid.push_back(shell);
  std::vector<std::uint32_t> kept;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    const Vec3 p = walls.points[walls.triangles[solid[i].front()][0]];
    const bool is_inside = std::ranges::any_of(solid, [&](const auto& other) {
      if (&other == &solid[i]) return false;
      const SurfaceMesh around = of_triangles(walls, other);
      const Box3 box = bounding_box(around.points);
      if (p.x < box.lo.x || p.y < box.lo.y || p.z < box.lo.z || p.x > box.hi.x || p.y > box.hi.y || p.z > box.hi.z)
        return false;
      return WindingNumber(around).at(p) > 0.5;
    });
    if (is_inside) continue;
    kept.insert(kept.end(), solid[i].begin(), solid[i].end()), ++taken;
  }
  left_out = shells.size() - taken;
  std::ranges::sort(kept);
  return of_triangles(walls, kept);
}

/// With one vertex where triangles meet, as files may not have it.
SurfaceMesh closed(const SurfaceMesh& walls) {
  RepairedSurface repaired = repair_surface(walls);
  const SurfaceDefects defects = find_defects(repaired);
  if (walls.triangles.empty() || defects.open_edges.count > 0)
    throw InputError(fmt::format("what lies in a wind tunnel must be closed, and {}: `octafront repair` closes holes",
                                 walls.triangles.empty()
                                     ? "nothing here is"
                                     : counted(defects.open_edges.count, "edge") + " of it belong to one face alone"));
  return std::move(repaired.surface);
}

bool lies_within(const Box3& body, const Box3& box) {
  bool within = true;
  for (int axis = 0; axis < 3; ++axis) within = within && box.lo[axis] < body.lo[axis] && body.hi[axis] < box.hi[axis];
  return within;
}

bool lies_apart(const Box3& body, const Box3& box) {
  bool apart = false;
  for (int axis = 0; axis < 3; ++axis) apart = apart || body.hi[axis] <= box.lo[axis] || box.hi[axis] <= body.lo[axis];
  return apart;
}

/// Patches of the body first, as its geometry numbers them, then those of the box; and the region.
void name_places(SurfaceMesh& fluid, std::size_t body_patches, const std::vector<std::string>& of_body) {
  fluid.patch_names = of_body;
  fluid.patch_names.resize(body_patches);
  if (body_patches == 1 && fluid.patch_names[0].empty()) fluid.patch_names[0] = "wall";
  const auto own = [&](std::string name) {
    while (std::ranges::find(of_body, name) != of_body.end()) name = "tunnel_" + name;
    return name;
  };
  for (const char* name : kPatches) fluid.patch_names.push_back(own(name));
  fluid.region_names = {own("flow")};  // without a name it would be called body, as patches may be
}

/// A body that touches no face of the box: its triangles stay as they are, seen from the other side.
SurfaceMesh around_floating(const SurfaceMesh& walls, const Body& box, std::size_t body_patches) {
  SurfaceMesh fluid = walls;
  for (Triangle& t : fluid.triangles) std::swap(t[1], t[2]);
  const auto first = static_cast<VertexIndex>(fluid.points.size());
  fluid.points.insert(fluid.points.end(), box.surface.points.begin(), box.surface.points.end());
  for (std::size_t t = 0; t < box.surface.triangles.size(); ++t) {
    const auto& [a, b, c] = box.surface.triangles[t];
    fluid.triangles.push_back({first + a, first + b, first + c});
    fluid.patch.push_back(static_cast<std::uint32_t>(body_patches + box.surface.patch[t]));
  }
  return fluid;
}

/// One that touches some or sticks out: it is cut by the box.
SurfaceMesh around_cut(const SurfaceMesh& walls, const Body& box, std::size_t body_patches,
                       const IntakeOptions& options, const RunContext& context) {
  ComplexOptions how;
  how.overlap = ComplexOptions::Overlap::kLater, how.within_first = true, how.tolerance = 0;
  const Complex joined = cells::join_bodies({box, {"body", walls}}, how, elements_to_come(options), context);
  const auto& names = joined.surface.region_names;
  const auto region = static_cast<std::uint32_t>(std::ranges::find(names, kTunnelName) - names.begin());
  SurfaceMesh only;
  only.points = joined.surface.points;
  const std::size_t of_box = box.surface.triangles.size();
  for (std::size_t t = 0; t < joined.surface.triangles.size(); ++t) {
    const Sides sides = joined.surface.sides[t];
    if ((sides[0] == region) == (sides[1] == region)) continue;
    Triangle triangle = joined.surface.triangles[t];
    if (sides[0] == region) std::swap(triangle[1], triangle[2]);
    only.triangles.push_back(triangle);
    const std::size_t source = joined.surface.source_of(t);
    only.patch.push_back(source < of_box ? static_cast<std::uint32_t>(body_patches + box.surface.patch[source])
                                         : walls.patch_of(source - of_box));
  }
  std::vector<std::uint32_t> all(only.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  return of_triangles(only, all);
}

std::string corner(const Vec3& p) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", p.x, p.y, p.z);
}

}  // namespace

Domain in_tunnel(Domain domain, const IntakeOptions& options, const RunContext& context) {
  if (options.wind_tunnel.empty()) return domain;
  if (asks_for_cell(options)) throw OptionError("`wind_tunnel` and `box` are two boxes: give one of them");
  context.report("wind tunnel", -1);
  std::size_t left_out = 0;
  const SurfaceMesh walls = without_cavities(closed(outer_walls(domain.surface)), left_out);
  const Box3 body = bounding_box(walls.points), box = tunnel_of(options.wind_tunnel, body);
  if (lies_apart(body, box))
    throw OptionError(fmt::format("the wind tunnel {}:{} does not reach the body, which lies in {}:{}", corner(box.lo),
                                  corner(box.hi), corner(body.lo), corner(body.hi)));
  const bool floats = lies_within(body, box);
  std::size_t patches = std::max<std::size_t>(1, domain.surface.patch_names.size());
  for (const std::uint32_t p : walls.patch) patches = std::max<std::size_t>(patches, p + 1);
  const Body around = tunnel_body(box);
  SurfaceMesh fluid =
      floats ? around_floating(walls, around, patches) : around_cut(walls, around, patches, options, context);
  name_places(fluid, patches, domain.surface.patch_names);
  note(domain, options, "wind tunnel",
       fmt::format("box {}:{} around a body of {:.6g} along x, {}{}", corner(box.lo), corner(box.hi),
                   body.hi.x - body.lo.x,
                   floats ? "which touches none of its faces" : "which is cut where it reaches the box",
                   left_out > 0 ? fmt::format("; {} inside of the body left out", counted(left_out, "shell")) : ""));
  domain.surface = std::move(fluid);
  domain.volumes.clear(), domain.true_volumes.clear(), domain.chord_depths.clear(), domain.bound.clear();
  domain.found_clean = 0;
  domain.body_patches = patches, domain.body_length = body.hi.x - body.lo.x;
  return domain;
}

}  // namespace octafront::intake
