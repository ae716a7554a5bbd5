#include "base/core/wording.h"
#include "measure.h"
#include "pipe.h"
#include "steps.h"
#include "topology.h"

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Vertex.hxx>
#include <optional>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Edges nearer than this part of the diagonal are one.
constexpr double kSewing = 1e-5;
/// Where more of the area than this part stays open, what did close is not the model: all faces go to repair.
constexpr double kMostOpen = 0.1;

std::optional<TopoDS_Shape> solid_of(const TopoDS_Shape& shell) {
  if (!BRep_Tool::IsClosed(shell)) return std::nullopt;
  BRepBuilderAPI_MakeSolid maker(TopoDS::Shell(shell));
  if (!maker.IsDone()) return std::nullopt;
  TopoDS_Solid solid = maker.Solid();
  if (!BRepLib::OrientClosedSolid(solid)) return std::nullopt;
  return solid;
}

/// By its first vertex that lies on no face of the outer one.
bool lies_in(const TopoDS_Shape& inner, const TopoDS_Shape& outer) {
  for (TopExp_Explorer it(inner, TopAbs_VERTEX); it.More(); it.Next()) {
    const TopoDS_Vertex vertex = TopoDS::Vertex(it.Current());
    const BRepClass3d_SolidClassifier place(outer, BRep_Tool::Pnt(vertex), BRep_Tool::Tolerance(vertex));
    if (place.State() == TopAbs_IN) return true;
    if (place.State() == TopAbs_OUT) return false;
  }
  return false;
}

/// Of closed shells, each a solid: the smallest one around each; itself if there is none.
std::vector<std::size_t> around(const std::vector<TopoDS_Shape>& solids) {
  std::vector<double> volume;
  std::vector<Box3> box;
  for (const TopoDS_Shape& solid : solids) volume.push_back(volume_of(solid)), box.push_back(quick_box(solid));
  std::vector<std::size_t> outer(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    outer[i] = i;
    for (std::size_t k = 0; k < solids.size(); ++k)
      if (volume[k] > volume[i] && box[k].overlaps(box[i]) && (outer[i] == i || volume[k] < volume[outer[i]]) &&
          lies_in(solids[i], solids[k]))
        outer[i] = k;
  }
  return outer;
}

/// Shells in shells are cavities, those in cavities solids again: faces alone do not say which side is filled.
std::vector<TopoDS_Shape> with_cavities(const std::vector<TopoDS_Shape>& solids) {
  const std::vector<std::size_t> outer = around(solids);
  const auto is_cavity = [&](std::size_t i) {
    bool odd = false;
    for (; outer[i] != i; i = outer[i]) odd = !odd;
    return odd;
  };
  std::vector<TopoDS_Shape> made;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (is_cavity(i)) continue;
    TopoDS_Solid solid;
    BRep_Builder().MakeSolid(solid);
    for (std::size_t k = 0; k < solids.size(); ++k)
      if (k == i || outer[k] == i)
        for (TopExp_Explorer shell(solids[k], TopAbs_SHELL); shell.More(); shell.Next())
          BRep_Builder().Add(solid, k == i ? shell.Current() : shell.Current().Reversed());
    made.push_back(solid);
  }
  return made;
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
  std::vector<TopoDS_Shape> closed;
  for (TopExp_Explorer it(sewn, TopAbs_SHELL); it.More(); it.Next()) {
    if (const std::optional<TopoDS_Shape> solid = solid_of(it.Current())) {
      closed.push_back(*solid);
    } else {
      for (TopExp_Explorer face(it.Current(), TopAbs_FACE); face.More(); face.Next())
        part.loose.push_back(face.Current());
    }
  }
  for (TopExp_Explorer it(sewn, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) part.loose.push_back(it.Current());
  double open_area = 0, area = 0;
  for (const TopoDS_Shape& face : part.loose) open_area += area_of(face);
  for (TopExp_Explorer it(sewn, TopAbs_FACE); it.More(); it.Next()) area += area_of(it.Current());
  if (open_area > kMostOpen * area) {
    part.loose.clear();
    for (TopExp_Explorer it(sewn, TopAbs_FACE); it.More(); it.Next()) part.loose.push_back(it.Current());
    part.notes.push_back(
        fmt::format("the file has no solids, and {:.0f} % of the area of its faces bounds none when they "
                    "are sewn where edges lie within {:g} of the diagonal: they are taken as triangles",
                    100 * open_area / area, kSewing));
    return;
  }
  for (const TopoDS_Shape& solid : with_cavities(closed)) part.solids.push_back({solid, {}});
  std::string came = counted(part.solids.size(), "solid");
  if (const std::size_t cavities = closed.size() - part.solids.size(); cavities > 0)
    came += " with " + counted(cavities, "cavity", "cavities");
  part.notes.push_back(fmt::format(
      "the file has no solids: of {}, sewn where edges lie within {:g} of the diagonal, came {} and {} that "
      "belong{} to none",
      counted(faces, "face"), kSewing, came, counted(part.loose.size(), "face"), part.loose.size() == 1 ? "s" : ""));
}

}  // namespace octafront::cad
