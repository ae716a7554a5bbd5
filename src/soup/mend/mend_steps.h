#pragma once

// The steps of mending, in order.

#include <octafront/ids.h>
#include <octafront/mend.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"
#include "soup/tidy/steps.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

struct Welded {
  std::uint64_t joined = 0, divided = 0;  ///< vertices; open edges
  double largest_move = 0;
  std::vector<Vec3> places;  ///< of vertices that were joined, or put into an edge
};

/// Brings open edges together: the ends of edges that fit become one vertex in their middle, and edges are divided at
/// vertices of open edges beside them. Nothing moves farther than the tolerance, no triangle loses a corner, and what
/// lies together in small triangles is not mistaken for a gap: edges fit if they differ by less than their length.
Welded weld_open_edges(tidy::Draft& draft, double tolerance);

/// A hole and the triangles over it.
struct Hole {
  std::vector<Triangle> cap;
  std::vector<Vec3> inner;             ///< points of the cap that are not on the rim, in the order of their vertices
  std::uint32_t rim_triangle = kNone;  ///< of the draft
  double area = 0;                     ///< of the cap before it was made smooth or set off
  bool has_base = false;               ///< the cap keeps off the surface, which a lid would graze
};

struct ClosedHoles {
  std::vector<Hole> holes;
  std::vector<char> is_sheet;  ///< per triangle of the draft
  bool is_one_sheet = false;   ///< all hangs together, and caps would be nearly as large as the rest
};

/// Caps for the holes of all parts that nearly enclose something, and none for sheets: parts whose caps would be too
/// large a share of themselves, or that would enclose a volume thinner than the tolerance. Where some parts are closed
/// already, open ones must be nearly so too, and fins (triangles_of_fins()) are sheets. Where the surface around a hole
/// bends, its cap goes on so; where a lid would graze the surface, walls and a flat base close the hole. The points
/// that this takes come behind those of the draft.
ClosedHoles close_holes(tidy::Draft& draft, double tolerance);

struct LaidFlat {
  std::uint64_t faces = 0;  ///< taken away
  double largest_move = 0;
  std::vector<Vec3> places;
};

/// Where a sheet crosses nothing but itself, and all that within the tolerance, its faces there give way to those over
/// their rim that bend least: folds that crossed would stay as layers with clefts between them, which no element fits.
/// Only discs are taken, whose caps lie within the tolerance of them, both ways, and cross nothing. Requires that
/// neighbouring triangles agree.
LaidFlat lay_crumples_flat(tidy::Draft& draft, double tolerance);

/// Pieces of the soup that was arranged: neighbours in one piece agree on their outer side.
struct PieceOf {
  std::vector<std::uint32_t> piece;  ///< per triangle of the soup
  std::uint32_t count = 0;
  std::vector<char> is_sheet = {};  ///< per piece: it winds around nothing, whatever it looks like from nearby
};

struct Labels {
  std::vector<char> inside;            ///< per cell
  std::vector<char> turned;            ///< per piece: it faces the wrong way
  std::vector<double> winding;         ///< per cell, in the mean; not a number where a cell is too thin to look into
  std::uint64_t doubtful = 0;          ///< cells that the cut decided
  std::vector<std::uint32_t> filled;   ///< enclosed cells outside, thinner than the tolerance, that are inside now
  std::vector<std::uint32_t> emptied;  ///< cells inside of bodies thinner than the tolerance, that are outside now
};

/// Which cells are inside: those that the walls wind around more than half. A piece that shows its back to the
/// unbounded cell is turned before. Cells in doubt go where the least area of walls comes to lie between inside and
/// outside.
Labels label_cells(const Arrangement& arranged, const Cells& cells, const PieceOf& pieces, double tolerance,
                   const RunContext& context);

/// The surface between inside and outside: walls of an arrangement.
struct Skin {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;  ///< the outside in front
  std::vector<std::uint32_t> wall;  ///< per triangle: that of the arrangement which it is
  double wall_area = 0;             ///< of all walls
  double idle_area = 0;             ///< of walls with outside on both sides
};

/// By cells of the arrangement. Faces of which nothing is missing are in it as they were `given` to be arranged.
Skin skin_of_cells(const Arrangement& arranged, const std::vector<Triangle>& given, const Cells& cells,
                   const Labels& labels, const RunContext& context);

/// A surface that a lattice found, and how much of it lies away from the walls.
struct LatticeSkin {
  SurfaceMesh surface;       ///< clean; `source`: the nearest wall of each triangle
  std::vector<char> is_far;  ///< per triangle: farther from the walls than an edge of the lattice
};

/// The boundary of what the walls wind around more than half, by isosurface stuffing with edges of this length at the
/// walls: always there, whatever the walls are, near them by about half an edge, closed and manifold. Throws
/// MeshingError if nothing is as large as an edge.
LatticeSkin skin_of_lattice(const SurfaceMesh& walls, double edge, const RunContext& context);

/// The outer boundary of all that lies within `distance` of the walls: a closed skin around anything.
LatticeSkin wrap_of(const SurfaceMesh& walls, double distance, const RunContext& context);

struct Separated {
  std::vector<Vec3> places;   ///< of the vertices that were there more than once
  std::vector<double> moves;  ///< how far the farthest copy of each went
  bool done = true;           ///< false: some copies find no place of their own; the surface is as it was
};

/// Draws apart what touches itself in edges and vertices only: each part gets vertices of its own, whose tips move away
/// from each other, by no more than `most`; tips that have no way to go are cut off. Requires triangles that meet in
/// shared vertices and edges only, with the outside in front.
Separated separate_contacts(SurfaceMesh& surface, double most, const RunContext& context);

/// Takes out triangles that are lower than `reach`, which cuts that nearly meet leave: their short edges shrink to a
/// point, or their long edges are turned to pass through the vertex beside them. What cannot be taken out without
/// folding the surface stays. Nothing moves by more than a few times `reach`; whether it crosses itself then is for the
/// caller to see. Requires a clean surface. Returns the number of triangles that were there in excess or turned.
std::uint64_t drop_dust(SurfaceMesh& surface, double reach);

// What was done, entered into the report.

/// Input triangles that were divided or lie double, by places that hang together.
void note_cuts(MendReport& report, const Arrangement& arranged, const std::vector<std::uint32_t>& face);

/// Faces of the draft of which nothing is left, by what hangs together of them.
void note_dropped(MendReport& report, tidy::Draft& draft, const std::vector<char>& used);

/// Faces that were turned to agree with their neighbours, and pieces that faced the wrong way.
void note_turned(MendReport& report, const tidy::Draft& draft, const std::vector<std::uint32_t>& piece,
                 const std::vector<char>& turned, const tidy::InputFaces& faces);

void note_filled(MendReport& report, const Arrangement& arranged, const Cells& cells,
                 const std::vector<std::uint32_t>& filled);

/// Sums, and a sentence for each kind of change.
void finish_report(MendReport& report, const SurfaceMesh& result, const RunContext& context);

}  // namespace octafront::mend
