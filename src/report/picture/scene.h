#pragma once

#include <octafront/ids.h>
#include <octafront/picture.h>

#include "report/picture/colours.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

/// What is drawn along an edge of a triangle.
enum class EdgeLine : std::uint8_t { kAbsent, kThin, kStrong };

/// A face of what is shown: of its triangles, of which one of second order has several.
struct SceneFace {
  Rgb front, back;
  std::uint32_t part = kNone;  ///< by whose name it may be called: Scene::part_names
  std::uint32_t mark = kNone;  ///< the place of PictureOptions::highlight that it belongs to
};

struct SceneTriangle {
  std::array<Vec3, 3> at;
  std::uint32_t face = 0;
  std::array<EdgeLine, 3> lines{};  ///< of the edges from corner i to the next
};

/// A bar of the legend, or a list of swatches.
struct Legend {
  std::string title;
  std::vector<Rgb> bar;                               ///< colours from low to high; empty: none
  std::vector<std::pair<double, std::string>> ticks;  ///< at parts of the bar
  std::vector<std::uint64_t> counts;                  ///< elements by equal parts of the bar; empty: not known
  std::vector<std::pair<std::string, Rgb>> swatches;
};

/// What a picture is of, before it is looked at from anywhere.
struct Scene {
  std::vector<SceneFace> faces;
  std::vector<SceneTriangle> triangles;
  /// One per triangle, of its corners, of length 1; empty: triangles are flat.
  std::vector<std::array<Vec3, 3>> normals;
  bool is_closed = false;  ///< backs of triangles are never seen
  std::vector<std::string> part_names;
  Legend legend;
  std::vector<std::string> caption;
  /// Curves and nodes to highlight, over everything, by place.
  std::vector<std::pair<std::uint32_t, std::vector<Vec3>>> marked_lines;
  std::size_t marks = 0;  ///< places to highlight
};

inline constexpr Rgb kGrey{0xd4, 0xd7, 0xdc}, kInk{0x1a, 0x20, 0x2c}, kInside{0x8d, 0x7a, 0xa6},
    kSoftInk{0x5b, 0x65, 0x77};
/// Of the places to highlight, in turn; none is on a scale.
Rgb colour_of_mark(std::uint32_t place);

/// Whether a point is beyond the plane of a cut.
class CutPlane {
 public:
  /// `box`: of what is cut, from which parts of the extent are taken. REQUIRES points.
  CutPlane(const PictureCut& cut, const std::vector<Vec3>& points);
  bool beyond(Vec3 p) const { return dot(normal_, p) > offset_; }

 private:
  Vec3 normal_;
  double offset_ = 0;
};

/// Edges of the triangles where faces of different parts meet, or at more than 40 degrees, become strong; others stay.
/// `corner_of[t]`: its vertices by number; `parts[t]`: of its face; only triangles of `is_outer` meet at angles.
void find_features(Scene& scene, const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& parts,
                   const std::vector<char>& is_outer);

/// Normals of the corners: of all triangles at a vertex that meet the corner's own at less than 40 degrees.
void smooth_normals(Scene& scene, const std::vector<Triangle>& corners);

/// The scenes of a mesh, around an element, and of a surface.
Scene scene_of(const TetMesh& mesh, const PictureOptions& options, const RunContext& context);
Scene scene_of(const SurfaceMesh& surface, const PictureOptions& options, const RunContext& context);

}  // namespace octafront
