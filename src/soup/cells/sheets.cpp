#include <octafront/error.h>
#include <octafront/inside.h>
#include <octafront/repair.h>

#include "base/core/utf8.h"
#include "base/core/wording.h"
#include "soup/cells/bodies.h"
#include "soup/cells/cell_steps.h"
#include "soup/cells/labelled.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

using cells::Labelled;

/// The surface, body 0, and the sheets behind it, in one soup.
struct SheetSoup {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> body, patch, source;  ///< per triangle
  std::vector<std::string> patch_names;

  void add(const SurfaceMesh& part, std::uint32_t number) {
    const auto first = static_cast<VertexIndex>(points.size());
    points.insert(points.end(), part.points.begin(), part.points.end());
    for (const auto& [p, q, r] : part.triangles) {
      triangles.push_back({first + p, first + q, first + r});
      body.push_back(number);
    }
  }
};

std::uint32_t patches_of(const SurfaceMesh& surface) {
  auto count = static_cast<std::uint32_t>(std::max<std::size_t>(surface.patch_names.size(), 1));
  for (const std::uint32_t p : surface.patch) count = std::max(count, p + 1);
  return count;
}

SurfaceMesh tidied(const Sheet& sheet, const RunContext& context) {
  try {
    if (sheet.surface.triangles.empty()) throw InputError("there is no triangle in it");
    if (!sheet.surface.sides.empty()) throw InputError("it has regions; a sheet has none");
    return repair_surface(sheet.surface, context).surface;
  } catch (const InputError& error) {
    throw InputError(fmt::format("the sheet {}: {}", sheet.name, error.what()));
  }
}

SheetSoup soup_of_sheets(const SurfaceMesh& surface, const std::vector<Sheet>& sheets, const RunContext& context) {
  SheetSoup all;
  all.add(surface, 0);
  std::uint32_t faces = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    all.patch.push_back(surface.patch_of(t));
    all.source.push_back(surface.source_of(t));
    faces = std::max(faces, surface.source_of(t) + 1);
  }
  all.patch_names = surface.patch_names;
  all.patch_names.resize(patches_of(surface));
  for (std::uint32_t s = 0; s < sheets.size(); ++s) {
    const SurfaceMesh sheet = tidied(sheets[s], context);
    const auto first_patch = static_cast<std::uint32_t>(all.patch_names.size());
    const auto& names = sheets[s].surface.patch_names;
    const std::uint32_t count = patches_of(sheet);
    for (std::uint32_t p = 0; p < count; ++p)
      all.patch_names.push_back(count == 1 ? sheets[s].name
                                : p < names.size() && !names[p].empty()
                                    ? sheets[s].name + "/" + names[p]
                                    : fmt::format("{}/patch_{}", sheets[s].name, p + 1));
    all.add(sheet, s + 1);
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
      all.patch.push_back(first_patch + sheet.patch_of(t));
      all.source.push_back(faces + sheet.source_of(t));
    }
    faces += static_cast<std::uint32_t>(sheets[s].surface.triangles.size());
  }
  return all;
}

/// What an arranged triangle is part of.
class Parts {
 public:
  Parts(const Arrangement& arranged, const cells::ClosedGaps& closed, const SheetSoup& all)
      : arranged_(arranged), closed_(closed), all_(all) {}

  /// Its first origin in the surface (a wall), or in a sheet; null: none.
  const Origin* wall(std::size_t t) const { return first(t, true); }
  const Origin* sheet(std::size_t t) const { return first(t, false); }
  std::uint32_t soup_triangle(const Origin& o) const { return closed_.source[o.triangle]; }

 private:
  const Origin* first(std::size_t t, bool of_surface) const {
    for (const Origin& o : arranged_.origins_of(t))
      if ((all_.body[closed_.source[o.triangle]] == 0) == of_surface) return &o;
    return nullptr;
  }
  const Arrangement& arranged_;
  const cells::ClosedGaps& closed_;
  const SheetSoup& all_;
};

/// The regions of cells by the walls around them; what has sheets only around it is of the region around these.
void label_by_walls(Labelled& labelled, const SurfaceMesh& surface, const Parts& parts) {
  constexpr std::uint32_t kUnknown = kNone - 1;
  labelled.region.assign(labelled.cells.count(), kUnknown);
  labelled.region[0] = kNone;
  std::vector<std::vector<std::uint32_t>> beside(labelled.cells.count());
  for (std::size_t t = 0; t < labelled.arranged.triangles.size(); ++t) {
    const auto [front, back] = labelled.cells.sides_of(t);
    if (const Origin* wall = parts.wall(t)) {
      Sides sides = surface.sides_of(parts.soup_triangle(*wall));
      if (wall->reversed) std::swap(sides[0], sides[1]);
      labelled.region[front] = sides[0];
      labelled.region[back] = sides[1];
    } else {
      beside[front].push_back(back);
      beside[back].push_back(front);
    }
  }
  std::queue<std::uint32_t> queue;
  for (std::uint32_t c = 0; c < labelled.cells.count(); ++c)
    if (labelled.region[c] != kUnknown) queue.push(c);
  for (; !queue.empty(); queue.pop())
    for (const std::uint32_t c : beside[queue.front()])
      if (labelled.region[c] == kUnknown) {
        labelled.region[c] = labelled.region[queue.front()];
        queue.push(c);
      }
}

/// Areas of what became of the faces of one sheet.
struct Fate {
  double inside = 0, on_walls = 0, outside = 0;
  double on_others = 0;  ///< on earlier sheets, which name it
};

std::vector<Fate> fates_of(const Labelled& labelled, const SheetSoup& all, const Parts& parts, std::size_t sheets) {
  std::vector<Fate> fates(sheets);
  for (std::size_t t = 0; t < labelled.arranged.triangles.size(); ++t) {
    const Origin* sheet = parts.sheet(t);
    if (sheet == nullptr) continue;
    const std::uint32_t first = all.body[parts.soup_triangle(*sheet)];
    const auto [a, b, c] = labelled.arranged.triangles[t];
    const auto& p = labelled.arranged.points;
    const double area = length(cross(p[b] - p[a], p[c] - p[a])) / 2;
    const auto [front, back] = labelled.cells.sides_of(t);
    Fate& fate = fates[first - 1];
    const bool outside = labelled.region[front] == kNone && labelled.region[back] == kNone;
    (parts.wall(t) != nullptr ? fate.on_walls : outside ? fate.outside : fate.inside) += area;
    for (const Origin& o : labelled.arranged.origins_of(t)) {
      const std::uint32_t body = all.body[parts.soup_triangle(o)];
      if (body > first) fates[body - 1].on_others += area;
    }
  }
  return fates;
}

void tell_fates(const std::vector<Fate>& fates, const std::vector<Sheet>& sheets, std::vector<std::string>& notes) {
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const auto& [inside, on_walls, outside, on_others] = fates[s];
    if (inside + on_walls + on_others == 0)
      throw InputError(
          fmt::format("the sheet {} lies outside of everything: no part of it would be in the mesh; look "
                      "at its coordinates, or leave it out",
                      sheets[s].name));
    std::string text = fmt::format("the sheet {}: area {:.6g} inside", sheets[s].name, inside);
    if (on_walls > 0) text += fmt::format(", {:.4g} on walls, which get its name", on_walls);
    if (on_others > 0) text += fmt::format(", {:.4g} on earlier sheets, whose names it has", on_others);
    if (outside > 0) text += fmt::format(", {:.4g} outside, cut off", outside);
    notes.push_back(std::move(text));
  }
}

Complex embedded(const SurfaceMesh& surface, const std::vector<Sheet>& sheets, const cells::MisfitLimits& limits,
                 const RunContext& context) {
  if (sheets.empty()) throw OptionError("there is no sheet to embed");
  const SheetSoup all = soup_of_sheets(surface, sheets, context);
  const cells::BodySoup soup{all.points, all.triangles, all.body};
  const cells::Misfits misfits(soup, limits, context);
  const cells::ClosedGaps closed = cells::close_gaps(soup, misfits, cells::Rims::kBend, context);
  const Arrangement arranged = arrange(closed.points, closed.triangles, context);
  const Cells cells(arranged.points, arranged.triangles, context);
  const Parts parts(arranged, closed, all);

  Labelled labelled{arranged, cells, {}, surface.region_names};
  label_by_walls(labelled, surface, parts);
  std::uint32_t regions = 1;
  for (const std::uint32_t r : labelled.region)
    if (r != kNone) regions = std::max(regions, r + 1);
  labelled.names.resize(regions);
  if (regions == 1 && labelled.names[0].empty()) labelled.names[0] = "body";
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const Origin* wall = parts.wall(t);
    const Sides sides = wall ? surface.sides_of(parts.soup_triangle(*wall)) : Sides{0, 0};
    labelled.embedded.push_back(sides[0] == sides[1]);
  }

  std::vector<std::size_t> turned;  // of the complex: faces that look the other way than their sheet
  std::size_t made = 0;
  Complex complex = cells::complex_of(labelled, [&](std::size_t t, Sides) {
    const Origin *wall = parts.wall(t), *sheet = parts.sheet(t);
    if (wall == nullptr && sheet->reversed) turned.push_back(made);
    ++made;
    const std::uint32_t named = parts.soup_triangle(sheet ? *sheet : *wall);
    return cells::Face{all.patch[named], all.source[named]};
  });
  for (const std::size_t t : turned) {
    std::swap(complex.surface.triangles[t][1], complex.surface.triangles[t][2]);
    std::swap(complex.surface.sides[t][0], complex.surface.sides[t][1]);
  }
  complex.surface.patch_names = all.patch_names;
  complex.surface.patch_labels = surface.patch_labels;
  complex.surface.region_labels = surface.region_labels;
  NameCleaning().clean(complex.surface.patch_names);
  std::vector<std::string> notes;
  if (closed.moved > 0)
    notes.push_back(
        fmt::format("{} of sheets that end just before walls moved onto these, by {:.3g} at most; "
                    "`tolerance` 0 leaves them",
                    counted(closed.moved, "vertex", "vertices"), closed.largest_move));
  tell_fates(fates_of(labelled, all, parts, sheets.size()), sheets, notes);
  notes.insert(notes.end(), complex.notes.begin(), complex.notes.end());
  complex.notes = std::move(notes);
  return complex;
}

}  // namespace

Complex embed_sheets(const SurfaceMesh& surface, const std::vector<Sheet>& sheets, const ComplexOptions& options,
                     const RunContext& context) {
  // Single precision keeps seven digits.
  constexpr double kOfDiagonal = 1e-6;
  const double rounding = kOfDiagonal * bounding_box(surface.points).diagonal();
  return embedded(surface, sheets, {options.tolerance.value_or(rounding), 0}, context);
}

Complex cells::embed_sheets(const SurfaceMesh& surface, const std::vector<Sheet>& sheets, const ComplexOptions& options,
                            const ElementsToCome& elements, const RunContext& context) {
  return embedded(surface, sheets, limits_for(options.tolerance, elements, std::abs(enclosed_volume(surface))),
                  context);
}

}  // namespace octafront
