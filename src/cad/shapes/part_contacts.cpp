#include "cad/shapes/part_contacts.h"

#include "cad/shapes/names.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

using Kind = SurfaceRecord::Kind;

/// Parts nearly touch where less than this part of what the thinner one is thick lies between them: clearances are
/// fractions of a bolt.
constexpr double kNearOfThickness = 0.2;
/// Faces are parallel where the cosine of their angle is no less: a thousandth of a radian, and no distance is far off.
constexpr double kFaceToFace = 1 - 5e-7;
/// Gaps that differ by less, relative, are one: faces of one surface have numbers of their own.
constexpr double kSameGap = 1e-6;

/// A face with one solid behind it, as a plane or cylinder: which way its front looks along the normal, or from the
/// axis.
struct OneSided {
  std::uint32_t face, solid;
  double sign;  ///< 1: along the frame's z, or away from the axis
};

std::optional<OneSided> one_sided(const CadModel& model, std::uint32_t f) {
  const Face& face = model.faces[f];
  const auto [front, behind] = face.sides;
  if ((front == kNone) == (behind == kNone)) return std::nullopt;
  if (face.surface.kind != Kind::kPlane && face.surface.kind != Kind::kCylinder) return std::nullopt;
  const Frame& frame = face.surface.frame;
  const bool is_right_handed = dot(cross(frame.x, frame.y), frame.z) > 0;
  // Of a plane u x v is x x y; of a cylinder it looks away from the axis where its frame is right-handed.
  double sign = is_right_handed != face.is_turned ? 1 : -1;
  if (front != kNone) sign = -sign;
  return OneSided{f, front == kNone ? behind : front, sign};
}

/// Two ranges have this much in common.
double shared_length(double low, double high, double other_low, double other_high) {
  return std::max(0.0, std::min(high, other_high) - std::max(low, other_low));
}

/// Planes that look at each other: how far they are apart, and what of them lies face to face, by their boxes.
std::optional<std::pair<double, double>> gap_of_planes(const CadModel& model, OneSided a, OneSided b) {
  const Face &one = model.faces[a.face], &other = model.faces[b.face];
  const Vec3 n = a.sign * one.surface.frame.z;
  if (dot(n, b.sign * other.surface.frame.z) > -kFaceToFace) return std::nullopt;
  const Frame &at = one.surface.frame, &to = other.surface.frame;
  Box3 box;
  for (const double u : {other.low.u, other.high.u})
    for (const double v : {other.low.v, other.high.v}) {
      const Vec3 d = to.origin + u * to.x + v * to.y - at.origin;
      box.add(Vec3{dot(d, at.x), dot(d, at.y), 0});
    }
  const double shared = shared_length(one.low.u, one.high.u, box.lo.x, box.hi.x) *
                        shared_length(one.low.v, one.high.v, box.lo.y, box.hi.y);
  return std::pair{dot(to.origin - at.origin, n), std::min({shared, one.area, other.area})};
}

/// The same of a shaft in a hole.
std::optional<std::pair<double, double>> gap_of_cylinders(const CadModel& model, OneSided a, OneSided b) {
  if (a.sign < b.sign) std::swap(a, b);
  const Face &shaft = model.faces[a.face], &hole = model.faces[b.face];
  const Frame &in = shaft.surface.frame, &around = hole.surface.frame;
  const double along = dot(in.z, around.z);
  if (a.sign == b.sign || std::abs(along) < kFaceToFace) return std::nullopt;
  const Vec3 d = around.origin - in.origin;
  const double aside = length(d - dot(d, in.z) * in.z), rise = dot(d, in.z), way = along > 0 ? 1 : -1;
  const double low = rise + way * (along > 0 ? hole.low.v : hole.high.v),
               high = rise + way * (along > 0 ? hole.high.v : hole.low.v);
  const double turn = std::min(shaft.high.u - shaft.low.u, hole.high.u - hole.low.u);
  const double height = shared_length(shaft.low.v, shaft.high.v, low, high);
  return std::pair{hole.surface.radius - shaft.surface.radius - aside, shaft.surface.radius * turn * height};
}

class ContactFinder {
 public:
  explicit ContactFinder(const CadModel& model) : model_(model) {
    find_shared(), find_near(), find_overlaps();
    std::ranges::stable_sort(all_, {}, [](const Contact& c) { return c.solids; });
  }
  std::vector<Contact> take() { return std::move(all_); }

 private:
  using Pair = std::array<std::uint32_t, 2>;

  void find_shared() {
    const std::vector<std::string> names = face_names(model_);
    std::map<std::pair<Pair, std::string>, std::size_t> known;
    for (std::uint32_t f = 0; f < model_.faces.size(); ++f) {
      const auto [a, b] = std::minmax(model_.faces[f].sides[0], model_.faces[f].sides[1]);
      if (a == b || b == kNone) continue;
      const auto at = known.try_emplace({Pair{a, b}, names[f]}, all_.size()).first->second;
      if (at == all_.size()) all_.push_back({Pair{a, b}, {}});
      all_[at].faces.push_back(f), all_[at].area += model_.faces[f].area;
      touching_.insert({a, b});
    }
  }

  double reach(std::uint32_t a, std::uint32_t b) const {
    const auto thickness = [&](const Solid& solid) { return solid.area > 0 ? 2 * solid.volume / solid.area : 0; };
    return kNearOfThickness * std::min(thickness(model_.solids[a]), thickness(model_.solids[b]));
  }

  void find_near() {
    std::vector<OneSided> planes, cylinders;
    for (std::uint32_t f = 0; f < model_.faces.size(); ++f)
      if (const auto found = one_sided(model_, f))
        (model_.faces[f].surface.kind == Kind::kPlane ? planes : cylinders).push_back(*found);
    add_near(planes, gap_of_planes), add_near(cylinders, gap_of_cylinders);
  }

  template <class GapOf>
  void add_near(const std::vector<OneSided>& faces, const GapOf& gap_of) {
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (std::size_t k = i + 1; k < faces.size(); ++k) {
        if (faces[i].solid == faces[k].solid) continue;
        const auto found = gap_of(model_, faces[i], faces[k]);
        const auto [a, b] = std::minmax(faces[i].solid, faces[k].solid);
        if (found && found->first > 0 && found->first <= reach(a, b) && found->second > 0)
          take_near(Pair{a, b}, {faces[i].face, faces[k].face}, found->first, found->second);
      }
  }

  /// Halves of cylinders and the like are one.
  void take_near(Pair solids, std::initializer_list<std::uint32_t> faces, double gap, double area) {
    const Kind kind = model_.faces[*faces.begin()].surface.kind;
    const auto is_it = [&](const Contact& c) {
      return c.solids == solids && c.gap > 0 && std::abs(c.gap - gap) <= kSameGap * gap &&
             model_.faces[c.faces[0]].surface.kind == kind;
    };
    auto known = std::ranges::find_if(all_, is_it);
    if (known == all_.end()) known = all_.insert(known, {solids, {}, 0, gap});
    for (const std::uint32_t f : faces)
      if (std::ranges::find(known->faces, f) == known->faces.end()) known->faces.push_back(f);
    known->area = std::min(known->area + area, std::min(area_of(*known, solids[0]), area_of(*known, solids[1])));
  }

  double area_of(const Contact& contact, std::uint32_t solid) const {
    double area = 0;
    for (const std::uint32_t f : contact.faces)
      if (std::ranges::count(model_.faces[f].sides, solid) > 0) area += model_.faces[f].area;
    return area;
  }

  /// Those that touch by a fit say so at the patches that they share.
  void find_overlaps() {
    for (const SharedSpace& space : model_.shared) {
      if (!touching_.contains(space.solids)) all_.push_back({space.solids, {}});
      for (Contact& contact : all_)
        if (contact.solids == space.solids && contact.gap == 0)
          contact.volume = space.volume, contact.depth = space.depth;
    }
  }

  const CadModel& model_;
  std::vector<Contact> all_;
  std::set<Pair> touching_;
};

std::string kind_in_words(const SurfaceRecord& surface, double unit) {
  switch (surface.kind) {
    case Kind::kPlane:
      return "plane";
    case Kind::kCylinder:
      return fmt::format("cylinder of radius {:.6g}", surface.radius / unit);
    case Kind::kCone:
      return "cone";
    case Kind::kSphere:
      return fmt::format("sphere of radius {:.6g}", surface.radius / unit);
    case Kind::kTorus:
      return fmt::format("torus of radius {:.6g}", surface.minor / unit);
    case Kind::kNurbs:
    case Kind::kNone:
      break;
  }
  return "free face";
}

}  // namespace

std::vector<Contact> contacts_of(const CadModel& model) {
  return ContactFinder(model).take();
}

std::string shape_in_words(const CadModel& model, const std::vector<std::uint32_t>& faces, double unit) {
  std::string words;
  std::set<std::string> told;
  for (const std::uint32_t f : faces)
    if (const std::string kind = kind_in_words(model.faces[f].surface, unit); told.insert(kind).second)
      words += (words.empty() ? "" : " and ") + kind;
  return words;
}

}  // namespace octafront::cad
