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
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Most that fusing may change a solid's volume, relative: the library can lose nearly all of it and say nothing.
constexpr double kFuseChange = 1e-3;
/// A line in which two solids touch is longer than this part of the smaller one; so many shorter ones are crumbs.
constexpr double kCrumb = 0.01;
constexpr int kFewestCrumbs = 3;

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

std::vector<Crumbs> crumbs_of(const Cells& cells) {
  // Inside of a face lie only lines in which other solids touch it.
  NCollection_IndexedDataMap<TopoDS_Shape, std::vector<std::size_t>, TopTools_ShapeMapHasher> inside;
  std::vector<double> size;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    size.push_back(quick_box(cells.cells[c].solid).diagonal());
    for (TopExp_Explorer face(cells.cells[c].solid, TopAbs_FACE); face.More(); face.Next())
      for (TopExp_Explorer it(face.Current().Oriented(TopAbs_FORWARD), TopAbs_EDGE); it.More(); it.Next()) {
        if (it.Current().Orientation() != TopAbs_INTERNAL) continue;
        if (!inside.Contains(it.Current())) inside.Add(it.Current(), {});
        inside.ChangeFromKey(it.Current()).push_back(c);
      }
  }
  std::map<std::pair<std::size_t, std::size_t>, Crumbs> found;
  for (int i = 1; i <= inside.Extent(); ++i) {
    const std::vector<std::size_t>& of = inside.FindFromIndex(i);
    if (of.size() != 2 || of[0] == of[1]) continue;
    const double length = length_of(inside.FindKey(i));
    if (length > kCrumb * std::min(size[of[0]], size[of[1]])) continue;
    Crumbs& crumbs = found.try_emplace({of[0], of[1]}, Crumbs{of[0], of[1], 0, length, {}}).first->second;
    if (crumbs.pieces++ == 0 || length < crumbs.shortest) {
      const Box3 box = quick_box(inside.FindKey(i));
      crumbs.shortest = length, crumbs.at = 0.5 * (box.lo + box.hi);
    }
  }
  std::vector<Crumbs> all;
  for (const auto& [pair, crumbs] : found)
    if (crumbs.pieces >= kFewestCrumbs) all.push_back(crumbs);
  return all;
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
