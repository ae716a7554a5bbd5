#include "soup/cells/labelled.h"

#include "base/core/renumber.h"
#include "base/core/utf8.h"
#include "base/core/wording.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront::cells {
namespace {

/// A triangle with one cell on both sides is where a wall may have a hole.
bool has_open_wall(const Labelled& labelled, std::uint32_t cell) {
  for (std::size_t t = 0; t < labelled.arranged.triangles.size(); ++t)
    if (labelled.cells.sides_of(t) == std::array{cell, cell}) return true;
  return false;
}

[[noreturn]] void fail_outside(const Labelled& labelled, Vec3 at, const std::string& what) {
  if (!has_open_wall(labelled, 0))
    throw InputError(fmt::format("{} at {} lies outside of everything; give a point inside", what, at_point(at)));
  throw LeakError(fmt::format("{} at {} leaks: from there a way leads outside without going through a wall; close the "
                              "hole, or move the point if it was meant to lie elsewhere",
                              what, at_point(at)),
                  labelled.cells.way(at, std::nullopt));
}

/// A seed, or a void.
struct Claim {
  std::string what, name;
  Vec3 at;
  bool empty;
};

std::vector<Claim> claims_of(const ComplexOptions& options) {
  std::vector<Claim> claims;
  for (const RegionSeed& r : options.regions)
    claims.push_back({fmt::format("the point of region \"{}\"", r.name), r.name, r.at, false});
  for (const Vec3 v : options.voids) claims.push_back({"the point of a void", "", v, true});
  return claims;
}

}  // namespace

std::uint32_t cell_of_seed(const Cells& cells, Vec3 at, const std::string& what) {
  const auto cell = cells.at(at);
  if (!cell) throw InputError(fmt::format("{} at {} lies on a face; give a point inside", what, at_point(at)));
  return *cell;
}

void apply_seeds(Labelled& labelled, const ComplexOptions& options) {
  std::vector<const Claim*> owner(labelled.cells.count(), nullptr);
  const std::vector<Claim> claims = claims_of(options);
  for (const Claim& claim : claims) {
    const std::uint32_t cell = cell_of_seed(labelled.cells, claim.at, claim.what);
    if (cell == 0 && claim.empty) continue;
    if (cell == 0) fail_outside(labelled, claim.at, claim.what);
    const Claim*& known = owner[cell];
    if (known != nullptr && (known->empty != claim.empty || known->name != claim.name))
      throw LeakError(fmt::format("{} at {} and {} at {} lie in one cell: no wall between them closes", known->what,
                                  at_point(known->at), claim.what, at_point(claim.at)),
                      labelled.cells.way(known->at, claim.at));
    known = &claim;
    if (claim.empty) {
      labelled.region[cell] = kNone;
      continue;
    }
    const auto at = std::find(labelled.names.begin(), labelled.names.end(), claim.name);
    labelled.region[cell] = static_cast<std::uint32_t>(at - labelled.names.begin());
    if (at == labelled.names.end()) labelled.names.push_back(claim.name);
  }
}

namespace {

/// "region_2", or with a higher number if somebody called another one so.
std::string free_name(const std::vector<std::string>& taken, std::uint32_t& number) {
  for (;;) {
    std::string name = fmt::format("region_{}", ++number);
    if (std::find(taken.begin(), taken.end(), name) == taken.end()) return name;
  }
}

/// Numbers regions anew, without those that have no cell; enters names and volumes.
std::vector<std::uint32_t> number_regions(const Labelled& labelled, Complex& complex) {
  std::vector<char> used(labelled.names.size(), 0);
  for (const std::uint32_t r : labelled.region)
    if (r != kNone) used[r] = 1;
  std::vector<std::uint32_t> number(labelled.names.size(), kNone);
  std::uint32_t nameless = 0;
  for (std::size_t r = 0; r < used.size(); ++r) {
    if (!used[r]) continue;
    number[r] = static_cast<std::uint32_t>(complex.surface.region_names.size());
    const std::string& name = labelled.names[r];
    complex.surface.region_names.push_back(name.empty() ? free_name(labelled.names, nameless) : name);
    if (r < labelled.labels.size()) complex.surface.region_labels.push_back(labelled.labels[r]);
  }
  complex.volumes.assign(complex.surface.region_names.size(), 0);
  const std::vector<double> volumes = labelled.cells.volumes();
  for (std::size_t c = 0; c < volumes.size(); ++c)
    if (labelled.region[c] != kNone) complex.volumes[number[labelled.region[c]]] += volumes[c];
  return number;
}

}  // namespace

Complex complex_of(const Labelled& labelled, const std::function<Face(std::size_t, Sides)>& face_of) {
  Complex complex;
  SurfaceMesh& surface = complex.surface;
  const std::vector<std::uint32_t> number = number_regions(labelled, complex);
  PointsTaken taken(labelled.arranged.points);
  std::uint64_t sheets = 0, vanished = 0;
  for (std::size_t t = 0; t < labelled.arranged.triangles.size(); ++t) {
    const auto [front, back] = labelled.cells.sides_of(t);
    Sides sides{labelled.region[front], labelled.region[back]};
    for (std::uint32_t& r : sides)
      if (r != kNone) r = number[r];
    const bool embedded = !labelled.embedded.empty() && labelled.embedded[t];
    const bool is_sheet =
        ((front == back && labelled.has_sheets) || embedded) && sides[0] == sides[1] && sides[0] != kNone;
    vanished += sides[0] == sides[1] && !is_sheet && !embedded;
    if (sides[0] == sides[1] && !is_sheet) continue;
    sheets += is_sheet;
    Triangle triangle = taken.take(labelled.arranged.triangles[t], surface.points);
    if (sides[1] == kNone) {
      std::swap(triangle[1], triangle[2]);
      std::swap(sides[0], sides[1]);
    }
    const auto [patch, source] = face_of(t, sides);
    surface.triangles.push_back(triangle);
    surface.sides.push_back(sides);
    surface.patch.push_back(patch);
    surface.source.push_back(source);
  }
  NameCleaning names;
  names.clean(surface.region_names);
  names.tell(complex.notes);
  if (sheets > 0)
    complex.notes.push_back(fmt::format("{} with one region on both sides {} as sheets", counted(sheets, "face"),
                                        sheets == 1 ? "stays" : "stay"));
  if (vanished > 0)
    complex.notes.push_back(fmt::format("{} that no two regions lie beside left out", counted(vanished, "face")));
  return complex;
}

}  // namespace octafront::cells
