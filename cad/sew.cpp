#include "measure.h"
#include "pipe.h"
#include "steps.h"
#include "topology.h"

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <optional>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Edges nearer than this part of the diagonal are one.
constexpr double kSewing = 1e-5;

std::optional<TopoDS_Shape> solid_of(const TopoDS_Shape& shell) {
  if (!BRep_Tool::IsClosed(shell)) return std::nullopt;
  BRepBuilderAPI_MakeSolid maker(TopoDS::Shell(shell));
  if (!maker.IsDone()) return std::nullopt;
  TopoDS_Solid solid = maker.Solid();
  if (!BRepLib::OrientClosedSolid(solid)) return std::nullopt;
  return solid;
}

}  // namespace

void sew(Part& part) {
  if (!part.solids.empty() || part.loose.empty()) return;
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const TopoDS_Shape& face : part.loose) BRep_Builder().Add(all, face);
  send_progress("sewing", fmt::format("{} faces", part.loose.size()), 0, all);
  BRepBuilderAPI_Sewing sewing(kSewing * quick_box(all).diagonal());
  for (const TopoDS_Shape& face : part.loose) sewing.Add(face);
  sewing.Perform();
  const TopoDS_Shape sewn = sewing.SewedShape();
  if (sewn.IsNull()) return;
  for (const TopoDS_Shape& face : part.loose)
    if (sewing.IsModified(face)) pass_labels(face, sewing.Modified(face), part.face_labels);
  const std::size_t faces = part.loose.size();
  part.loose.clear();
  for (TopExp_Explorer it(sewn, TopAbs_SHELL); it.More(); it.Next()) {
    if (const std::optional<TopoDS_Shape> solid = solid_of(it.Current())) {
      part.solids.push_back({*solid, {}});
    } else {
      for (TopExp_Explorer face(it.Current(), TopAbs_FACE); face.More(); face.Next())
        part.loose.push_back(face.Current());
    }
  }
  for (TopExp_Explorer it(sewn, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) part.loose.push_back(it.Current());
  part.notes.push_back(
      fmt::format("the file has no solids: of {} faces, sewn where edges lie within {:g} of the diagonal, came {} "
                  "solid{} and {} face{} that belong to none",
                  faces, kSewing, part.solids.size(), part.solids.size() == 1 ? "" : "s", part.loose.size(),
                  part.loose.size() == 1 ? "" : "s"));
}

}  // namespace octafront::cad
