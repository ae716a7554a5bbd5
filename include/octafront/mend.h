#pragma once

#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

// From any soup of triangles to a surface that can be meshed. repair_surface() moves nothing and invents nothing;
// mend_surface() does both, within a tolerance where it can, and says what it did.

/// The patch of what was closed farther from the input than the tolerance.
inline constexpr const char* kClosedByRepair = "closed by repair";

struct MendOptions {
  /// What moves stays within this distance, input units, >= 0. Without a value a thousandth of the diagonal.
  std::optional<double> tolerance = {};
  /// kAuto: what is not broken stays as it is. kWrap: a closed skin at a distance around everything, whatever it is.
  enum class Way { kAuto, kWrap };
  Way way = Way::kAuto;
  /// kWrap: how far the skin lies from the input; input units, > 0. Without a value a hundredth of the diagonal.
  std::optional<double> distance = {};
};

/// Something that was changed, with its place.
struct MendChange {
  enum class Kind {
    kJoined,     ///< open edges that were brought together; size: the largest move
    kClosed,     ///< a hole that was closed; size: area
    kCut,        ///< faces that crossed or overlapped, divided; size: their area
    kTurned,     ///< a part that faced the wrong way; size: area
    kDropped,    ///< a part that bounds nothing, or that nobody sees from outside; size: area
    kFilled,     ///< an enclosed gap narrower than the tolerance; size: volume
    kSeparated,  ///< a vertex where parts touched, drawn apart; size: the move
    kRebuilt,    ///< made anew from a lattice; size: area
    kLaidFlat,   ///< a crumple within the tolerance that crossed itself; size: the largest move of all
  };
  Kind kind;
  Vec3 at;                           ///< where to look
  double size = 0;                   ///< see the kind
  std::uint64_t faces = 0;           ///< triangles concerned
  bool within_tolerance = true;      ///< of a hole: whether all that closes it lies within the tolerance of the input
  std::uint32_t first_face = kNone;  ///< of the input: the lowest one concerned; kNone: none
};

/// "closed", "dropped", ...: the kind as a word.
constexpr const char* name_of(MendChange::Kind kind) {
  using Kind = MendChange::Kind;
  switch (kind) {
    case Kind::kJoined:
      return "joined";
    case Kind::kClosed:
      return "closed";
    case Kind::kCut:
      return "cut";
    case Kind::kTurned:
      return "turned";
    case Kind::kDropped:
      return "dropped";
    case Kind::kFilled:
      return "filled";
    case Kind::kSeparated:
      return "separated";
    case Kind::kRebuilt:
      return "rebuilt";
    case Kind::kLaidFlat:
      return "laid flat";
  }
  return "";
}

/// What mend_surface() did.
struct MendReport {
  bool clean = false;                                    ///< the input needed nothing and came back as it was
  double tolerance = 0;                                  ///< that was kept to, input units
  double diagonal = 0;                                   ///< of the input's box
  double largest_move = 0;                               ///< of any vertex
  std::uint64_t joined_vertices = 0, divided_edges = 0;  ///< to bring open edges together
  std::uint64_t crossing_pairs = 0;                      ///< faces that met elsewhere than in what they share
  std::uint64_t separated_vertices = 0;
  std::uint64_t based_holes = 0;  ///< closed by walls and a flat base, for a lid would have grazed the surface
  double area_before = 0, area_after = 0, volume_before = 0, volume_after = 0;
  std::uint32_t bodies = 0;         ///< of the result
  std::vector<MendChange> changes;  ///< by kind, each in the order of the input's faces
  std::vector<std::string> notes;   ///< a sentence for each kind of change
  std::uint64_t count(MendChange::Kind kind) const;
};

/// The report as one JSON object, each change with its place.
std::string to_json(const MendReport& report);

struct Mended {
  SurfaceMesh surface;  ///< clean; `source` refers to the input's faces
  MendReport report;
  /// Per triangle of `surface` how near a mesh of automatic sizes stays to it, where that is nearer than elsewhere
  /// (input units, > 0): the tolerance, where repair moved something; infinity: no nearer. Empty: so everywhere.
  std::vector<double> bound = {};
};

/// A clean surface from any soup of triangles. Open edges that lie within the tolerance of each other are brought
/// together; holes are closed; faces that cross, overlap or touch are divided exactly where they do; of the cells
/// between, those that the faces wind around are inside (generalised winding number: A. Jacobson, L. Kavan, O.
/// Sorkine-Hornung, 2013; doubtful ones by a minimal cut), and the surface between inside and outside is the result:
/// overlapping parts are united, inner walls and what nobody sees from outside are gone. Where parts touch in edges and
/// points only they are drawn apart, within the tolerance. A clean surface or complex comes back bit for bit.
///
/// Triangles that no defect touches stay as they are, with their patches; what was closed beyond the tolerance is the
/// patch kClosedByRepair. The result is the same on any number of threads.
///
/// Cost: some five times repair_surface() and find_defects(), plus 20 microseconds for each pair of crossing faces.
/// Throws InputError where the soup encloses nothing; OptionError for an argument out of range, or a soup with sides;
/// Cancelled.
Mended mend_surface(const SurfaceMesh& soup, const MendOptions& options = {}, const RunContext& context = no_context());

}  // namespace octafront
