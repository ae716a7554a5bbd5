#include "cad/shapes/cad_places.h"

#include "base/places/places.h"
#include "cad/shapes/names.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace octafront::cad {

namespace {

using ShapeKind = ShapePlace::Kind;

/// A radius is as asked for within the digits that people type.
constexpr double kSameRadius = 1e-3;
/// Middles that differ by less than this part of the diagonal lie at one end: the triangles, whose boxes they are of,
/// are no truer to curved faces.
constexpr double kSameEnd = 1e-4;
/// Areas and lengths that differ by less, relative, are equally large: they are integrals by numbers.
constexpr double kSameExtent = 1e-4;

bool is_kind(const SurfaceRecord& surface, ShapeKind kind) {
  using Kind = SurfaceRecord::Kind;
  switch (kind) {
    case ShapeKind::kPlanes:
      return surface.kind == Kind::kPlane;
    case ShapeKind::kCylinders:
      return surface.kind == Kind::kCylinder;
    case ShapeKind::kCones:
      return surface.kind == Kind::kCone;
    case ShapeKind::kSpheres:
      return surface.kind == Kind::kSphere;
    case ShapeKind::kTori:
      return surface.kind == Kind::kTorus;
    case ShapeKind::kFreeFaces:
      return surface.kind == Kind::kNurbs || surface.kind == Kind::kNone;
    default:
      return kind == ShapeKind::kFaces;
  }
}

bool is_kind(const CurveRecord& curve, ShapeKind kind) {
  return kind == ShapeKind::kEdges || (kind == ShapeKind::kLines && curve.kind == CurveRecord::Kind::kLine) ||
         (kind == ShapeKind::kCircles && curve.kind == CurveRecord::Kind::kCircle);
}

bool has_radius(const ShapePlace& place, double radius, double unit) {
  return !place.radius || std::abs(radius / unit - *place.radius) <= kSameRadius * *place.radius;
}

double radius_of(const SurfaceRecord& surface) {
  return surface.kind == SurfaceRecord::Kind::kTorus ? surface.minor : surface.radius;
}

Box3 box_of(const CadModel& model, const std::vector<VertexIndex>& vertices) {
  Box3 box;
  for (const VertexIndex v : vertices) box.add(model.points[v]);
  return box;
}

/// The number of "face 12", from 0.
std::uint32_t number_of_face(const std::string& place, std::size_t faces) {
  for (std::uint32_t f = 0; f < faces; ++f)
    if (place == "face " + std::to_string(f + 1)) return f;
  return kNone;
}

}  // namespace

CadPlaces::CadPlaces(const CadModel& model, double unit)
    : model_(model), unit_(unit), names_(face_names(model)), is_there_(model.faces.size(), 0) {
  Box3 box;
  for (const Vec3 p : model.points) box.add(p);
  diagonal_ = box.empty() ? 0 : box.diagonal();
  for (const std::uint32_t f : model.face_of)
    is_there_[f] = model.solids.empty() || model.faces[f].sides != Sides{kNone, kNone};
}

std::vector<std::uint32_t> CadPlaces::faces(const std::string& place) const {
  if (auto named = named_so(names_, place); !named.empty()) return named;
  for (const LabelGroup& group : label_groups(model_))
    if (group.name == place) return group.faces;
  if (auto between = faces_between(model_, place); !between.empty()) return between;
  if (const std::uint32_t f = number_of_face(place, names_.size()); f != kNone) return {f};
  const std::optional<ShapePlace> shape = shape_place_of(place);
  return shape && shape->is_of_faces() ? faces_like(*shape) : std::vector<std::uint32_t>();
}

FoundShapes CadPlaces::find(const std::string& place) const {
  FoundShapes found{faces(place), {}, {}};
  const std::optional<ShapePlace> shape = shape_place_of(place);
  if (!found.parts.empty() || !shape || shape->is_of_faces()) return found;
  if (shape->kind == ShapeKind::kPoints)
    found.points = points_like(*shape);
  else
    found.lines = lines_like(*shape);
  return found;
}

std::vector<char> CadPlaces::faces_of(const std::string& name) const {
  if (name.empty()) return is_there_;
  std::vector<char> is_of(is_there_.size(), 0);
  std::vector<std::uint32_t> solids = named_so(solid_names(model_), name);
  for (const std::uint32_t f : solids.empty() ? faces(name) : named_so(names_, name)) is_of[f] = is_there_[f];
  for (const LabelGroup& group : label_groups(model_))
    if (group.name == name) solids.insert(solids.end(), group.solids.begin(), group.solids.end());
  for (std::uint32_t f = 0; f < is_of.size(); ++f)
    for (const std::uint32_t side : model_.faces[f].sides)
      if (std::ranges::find(solids, side) != solids.end()) is_of[f] = is_there_[f];
  return is_of;
}

std::vector<std::uint32_t> CadPlaces::chosen(std::vector<Candidate> all, const ShapePlace& place) const {
  const auto keep_most = [&](const auto& value, const auto& near) {
    double most = -HUGE_VAL;
    for (const Candidate& c : all) most = std::max(most, value(c));
    std::erase_if(all, [&](const Candidate& c) { return value(c) < most - near(most); });
  };
  const double end = place.at_max ? 1 : -1, way = place.which == ShapePlace::Which::kLargest ? 1 : -1;
  if (place.axis)
    keep_most([&](const Candidate& c) { return end * c.middle[*place.axis]; },
              [&](double) { return kSameEnd * diagonal_; });
  if (place.which != ShapePlace::Which::kAll)
    keep_most([&](const Candidate& c) { return way * c.extent; },
              [](double most) { return kSameExtent * std::abs(most); });
  std::vector<std::uint32_t> numbers;
  for (const Candidate& c : all) numbers.push_back(c.number);
  return numbers;
}

std::vector<std::uint32_t> CadPlaces::faces_like(const ShapePlace& place) const {
  const std::vector<char> of = faces_of(place.of);
  std::vector<Box3> boxes(of.size());
  for (std::size_t t = 0; t < model_.triangles.size(); ++t)
    for (const VertexIndex v : model_.triangles[t]) boxes[model_.face_of[t]].add(model_.points[v]);
  std::vector<Candidate> all;
  for (std::uint32_t f = 0; f < of.size(); ++f) {
    const SurfaceRecord& surface = model_.faces[f].surface;
    if (of[f] && is_kind(surface, place.kind) && has_radius(place, radius_of(surface), unit_))
      all.push_back({f, boxes[f].center(), model_.faces[f].area});
  }
  return chosen(std::move(all), place);
}

bool CadPlaces::is_line_of(const CadEdge& edge, const std::vector<char>& of) const {
  return !edge.is_seam && std::ranges::any_of(edge.faces, [&](std::uint32_t f) { return of[f] != 0; });
}

std::vector<FoundLine> CadPlaces::lines_like(const ShapePlace& place) const {
  const std::vector<char> of = faces_of(place.of);
  std::vector<Candidate> all;
  for (std::uint32_t e = 0; e < model_.edges.size(); ++e) {
    const CadEdge& edge = model_.edges[e];
    if (is_line_of(edge, of) && is_kind(edge.curve, place.kind) && has_radius(place, edge.curve.radius, unit_))
      all.push_back({e, box_of(model_, edge.vertices).center(), edge.length});
  }
  std::vector<FoundLine> lines;
  for (const std::uint32_t e : chosen(std::move(all), place)) {
    FoundLine& line = lines.emplace_back(FoundLine{e, {}, model_.edges[e].faces});
    for (const VertexIndex v : model_.edges[e].vertices) line.points.push_back(model_.points[v] / unit_);
  }
  return lines;
}

std::vector<Vec3> CadPlaces::points_like(const ShapePlace& place) const {
  const std::vector<char> of = faces_of(place.of);
  // Where a closed edge begins is no point of the shape: two edges meet in one.
  std::map<VertexIndex, std::set<std::uint32_t>> edges;
  for (std::uint32_t e = 0; e < model_.edges.size(); ++e)
    if (is_line_of(model_.edges[e], is_there_))
      for (const VertexIndex v : {model_.edges[e].vertices.front(), model_.edges[e].vertices.back()})
        edges[v].insert(e);
  std::vector<Candidate> all;
  for (const auto& [v, here] : edges)
    if (here.size() > 1 && std::ranges::any_of(here, [&](std::uint32_t e) { return is_line_of(model_.edges[e], of); }))
      all.push_back({v, model_.points[v]});
  std::vector<Vec3> points;
  for (const std::uint32_t v : chosen(std::move(all), place)) points.push_back(model_.points[v] / unit_);
  return points;
}

}  // namespace octafront::cad
