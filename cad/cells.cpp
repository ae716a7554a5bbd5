#include "cells.h"

#include "measure.h"
#include "pipe.h"

#include <BOPAlgo_Builder.hxx>
#include <BRep_Builder.hxx>
#include <NCollection_IndexedDataMap.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <cmath>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Most that fusing may change a solid's volume, relative: the library can lose nearly all of it and say nothing.
constexpr double kFuseChange = 1e-3;

/// What `before` became; itself if nothing happened to it.
TopTools_ListOfShape images_of(BOPAlgo_Builder& builder, const TopoDS_Shape& before) {
  TopTools_ListOfShape images = builder.Modified(before);
  if (images.IsEmpty() && !builder.IsDeleted(before)) images.Append(before);
  return images;
}

Cells pieces_of(BOPAlgo_Builder& builder, const std::vector<TopoDS_Shape>& solids) {
  Cells out;
  TopTools_IndexedMapOfShape results;
  for (TopExp_Explorer it(builder.Shape(), TopAbs_SOLID); it.More(); it.Next()) {
    if (results.Contains(it.Current())) continue;
    results.Add(it.Current());
    TopoDS_Shape solid = it.Current();
    double volume = volume_of(solid);
    if (volume < 0) solid.Reverse(), volume = -volume;
    out.cells.push_back({solid, volume, {}});
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (const TopoDS_Shape& image : images_of(builder, solids[i]))
      if (const int r = results.FindIndex(image); r > 0) out.cells[static_cast<std::size_t>(r - 1)].owners.push_back(i);
    for (TopExp_Explorer it(solids[i], TopAbs_FACE); it.More(); it.Next())
      for (const TopoDS_Shape& image : images_of(builder, it.Current())) out.faces.emplace_back(it.Current(), image);
  }
  return out;
}

bool keeps_volumes(const Cells& cells, const std::vector<TopoDS_Shape>& solids) {
  std::vector<double> after(solids.size(), 0);
  for (const Cell& cell : cells.cells) {
    if (cell.owners.empty()) return false;
    for (const std::size_t owner : cell.owners) after[owner] += cell.volume;
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const double before = volume_of(solids[i]);
    if (!(std::abs(after[i] - before) <= kFuseChange * before)) return false;
  }
  return true;
}

}  // namespace

std::optional<Cells> cells_of(const std::vector<TopoDS_Shape>& solids, bool only_touch) {
  try {
    BOPAlgo_Builder builder;
    for (const TopoDS_Shape& solid : solids) builder.AddArgument(solid);
    builder.SetNonDestructive(true);
    builder.SetRunParallel(false);
    builder.SetGlue(only_touch ? BOPAlgo_GlueShift : BOPAlgo_GlueOff);
    builder.Perform(progress_of("fusing", fmt::format("{} solids", solids.size())));
    if (builder.HasErrors()) return std::nullopt;
    Cells cells = pieces_of(builder, solids);
    if (!keeps_volumes(cells, solids)) return std::nullopt;
    return cells;
  } catch (const Standard_Failure&) {
    return std::nullopt;
  }
}

TopoDS_Shape united(const std::vector<const Cell*>& cells) {
  if (cells.size() == 1) return cells[0]->solid;
  NCollection_IndexedDataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> times;
  for (const Cell* cell : cells)
    for (TopExp_Explorer it(cell->solid, TopAbs_FACE); it.More(); it.Next())
      if (int* known = times.ChangeSeek(it.Current()))
        ++*known;
      else
        times.Add(it.Current(), 1);
  // One shell, though it may have several pieces: nobody asks for shells any more.
  TopoDS_Shell shell;
  TopoDS_Solid solid;
  BRep_Builder().MakeShell(shell), BRep_Builder().MakeSolid(solid);
  for (int i = 1; i <= times.Extent(); ++i)
    if (times.FindFromIndex(i) == 1) BRep_Builder().Add(shell, times.FindKey(i));
  BRep_Builder().Add(solid, shell);
  return solid;
}

}  // namespace octafront::cad
