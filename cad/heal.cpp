#include "measure.h"
#include "pipe.h"
#include "steps.h"
#include "topology.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Most that healing may change a volume, relative.
constexpr double kVolumeChange = 1e-3;

using Faces = std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>>;  // before, after

struct Healed {
  TopoDS_Shape solid;
  Faces faces;
  bool valid = false;
};

bool is_valid(const TopoDS_Shape& shape) {
  return BRepCheck_Analyzer(shape).IsValid();
}

/// Nothing: healing does more harm than good.
std::optional<Healed> healed(const TopoDS_Shape& solid) {
  // The healer changes tolerances of what it is given.
  BRepBuilderAPI_Copy copy(solid, false);
  ShapeFix_Shape fixer(copy.Shape());
  fixer.Perform();
  const TopoDS_Shape result = fixer.Shape();
  int solids = 0;
  Healed out;
  for (TopExp_Explorer it(result, TopAbs_SOLID); it.More(); it.Next(), ++solids) out.solid = it.Current();
  if (solids != 1) return std::nullopt;
  const double before = std::abs(volume_of(solid));
  if (!(std::abs(std::abs(volume_of(out.solid)) - before) <= kVolumeChange * before)) return std::nullopt;
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Shape face = fixer.Context()->Apply(copy.ModifiedShape(it.Current()));
    if (face.IsNull()) {
      const double tolerance = tolerance_of(it.Current());
      if (area_of(it.Current()) > tolerance * tolerance) return std::nullopt;
    }
    for (TopExp_Explorer part(face, TopAbs_FACE); !face.IsNull() && part.More(); part.Next())
      out.faces.emplace_back(it.Current(), part.Current());
  }
  // What was turned before must not be turned again.
  if (volume_of(out.solid) * volume_of(solid) < 0) out.solid.Reverse();
  out.valid = is_valid(out.solid);
  return out;
}

void take_healed(const Healed& better, const TopLoc_Location& place, Body& body, FaceLabels& labels) {
  body.solid = better.solid.Moved(place, false).Oriented(body.solid.Orientation());
  for (const auto& [before, after] : better.faces)
    pass_labels(before.Moved(place, false), after.Moved(place, false), labels);
}

}  // namespace

void heal(Part& part) {
  // Instances of one product are healed once.
  std::unordered_map<const TopoDS_TShape*, std::optional<Healed>> known;
  int faulty = 0, mended = 0, taken_back = 0;
  for (std::size_t i = 0; i < part.solids.size(); ++i) {
    Body& body = part.solids[i];
    send_progress("healing", in_words(part, i), static_cast<double>(i) / part.solids.size(), body.solid);
    const TopLoc_Location place = body.solid.Location();
    const TopoDS_TShape* key = body.solid.TShape().get();
    if (!known.contains(key)) {
      const TopoDS_Shape at_origin = body.solid.Located(TopLoc_Location()).Oriented(TopAbs_FORWARD);
      std::optional<Healed> better;
      if (is_valid(at_origin)) {
        better = Healed{};
      } else {
        try {
          better = healed(at_origin);
        } catch (const Standard_Failure&) {
        }
      }
      known.emplace(key, std::move(better));
    }
    const std::optional<Healed>& better = known[key];
    if (better && better->solid.IsNull()) continue;
    ++faulty;
    if (better)
      take_healed(*better, place, body, part.face_labels), mended += better->valid;
    else
      ++taken_back;
  }
  if (faulty > 0)
    part.notes.push_back(fmt::format(
        "{} of {} solids are not valid; healing made {} of them valid{}", faulty, part.solids.size(), mended,
        taken_back > 0 ? fmt::format(", and was taken back in {}, where it lost volume or faces", taken_back) : ""));
}

void turn_outward(Part& part) {
  // A solid without a boundary is all of space, and swallows the others when they are fused.
  const std::size_t read = part.solids.size();
  std::erase_if(part.solids, [](const Body& body) { return std::abs(volume_of(body.solid)) == 0; });
  if (part.solids.size() < read)
    part.notes.push_back(
        fmt::format("{} of {} solids enclose nothing, and are left out", read - part.solids.size(), read));
  int turned = 0;
  for (Body& body : part.solids)
    if (volume_of(body.solid) < 0) body.solid.Reverse(), ++turned;
  if (turned > 0)
    part.notes.push_back(fmt::format("{} of {} solids were inside out, and are turned", turned, part.solids.size()));
}

}  // namespace octafront::cad
