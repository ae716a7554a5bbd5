#pragma once

#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace octafront {

/// A plane that takes away what lies beyond it, where its normal points. Elements are taken whole: one stays if a
/// corner of it is not beyond.
struct PictureCut {
  Vec3 normal;                       ///< not zero
  double share = 0.5;                ///< without `through`: the part of the extent along the normal that stays, 0 to 1
  std::optional<Vec3> through = {};  ///< a point of the plane, the unit of the mesh
};

/// What a picture shows, and from where.
struct PictureOptions {
  /// kAuto: of a mesh regions where there are several, else quality; of a surface regions or patches where there are
  /// several, else kPlain: one colour. kSize: the mean edge length of an element.
  enum class Color { kAuto, kQuality, kRegion, kSize, kPatch, kPlain };
  Color color = Color::kAuto;
  /// kAuto: those of elements, or of the triangles of a surface; kFeatures: where patches or regions meet, or faces at
  /// more than 40 degrees, and what lies between is smooth.
  enum class Edges { kAuto, kElements, kFeatures, kOff };
  Edges edges = Edges::kAuto;

  std::optional<PictureCut> cut = {};
  /// From where one looks, not zero. Without a value from (1, -1, 1), where y is up from (1, 1, 1), or where the cut,
  /// or most of what is to be highlighted, is seen.
  std::optional<Vec3> view = {};
  std::optional<Vec3> up = {};     ///< not zero; without a value, and of a look along it, z, or else y
  int width = 1200, height = 900;  ///< pixels, 64 to 8192

  /// Places (docs/use/places.md) that are shown in a colour of their own, all else is grey. What of them lies behind
  /// something shines through it.
  std::vector<std::string> highlight = {};
  bool names = false;  ///< of patches, or of the regions where these are coloured, beside what is seen of them
  bool worst = false;  ///< a close-up of the element of the least beta, its neighbours before it taken away

  bool furniture = true;   ///< axes, scale bar, legend and caption
  std::string title = {};  ///< the caption begins with it
  std::string unit = {};   ///< of the scale bar; empty: not known
};

/// Rows from above, three bytes a pixel: red, green, blue, as sRGB.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
  std::vector<std::string> notes = {};  ///< what is not in the picture, and of a close-up which element it is
};

/// A picture of a mesh: its boundary, or with a cut what is behind the plane. Elements of second order are drawn as
/// they bend, those of a higher order by their corners. The same pixels on every processor and for every number of
/// threads.
///
/// Quality is the radius ratio beta from 0 (dark red) to 1 (light blue) whatever the mesh: the lightness rises all the
/// way, also for colour-blind eyes.
///
/// Requires indices in range. Throws OptionError for options out of range and places that there are not, Cancelled.
Picture draw_picture(const TetMesh& mesh, const PictureOptions& options = {}, const RunContext& context = no_context());

/// A picture of a surface or soup, whatever is wrong with it; the back of a triangle is violet, so holes and turned
/// faces are seen. kQuality is that of triangles, 2 r / R. Throws as above, and OptionError for `worst`.
Picture draw_picture(const SurfaceMesh& surface, const PictureOptions& options = {},
                     const RunContext& context = no_context());

/// The bytes of a PNG file of it.
std::string to_png(const Picture& picture);

/// Bytes as text, by RFC 4648: for pages and messages that hold a picture.
std::string to_base64(std::string_view bytes);

/// What the choices of a picture are called, in their order: "quality", "region", "size", "patch", "none"; "elements",
/// "features", "none". kAuto has no name.
const std::vector<std::pair<std::string, PictureOptions::Color>>& picture_colors();
const std::vector<std::pair<std::string, PictureOptions::Edges>>& picture_edges();

/// Reads "x", "-y", "z=12.5", "x=30%", "NX,NY,NZ" or "NX,NY,NZ:X,Y,Z": the axis or normal beyond which all goes, and
/// where: in the middle, at a coordinate, at a part of the extent, through a point. Throws OptionError.
PictureCut picture_cut(const std::string& text);

/// Reads "X,Y,Z", the direction in which the viewer is, or iso, front (from -y), back, left, right, top or bottom.
/// Throws OptionError.
Vec3 picture_view(const std::string& text);

/// Reads "X,Y,Z", a direction, or x, -y and the like. Throws OptionError.
Vec3 picture_up(const std::string& text);

}  // namespace octafront
