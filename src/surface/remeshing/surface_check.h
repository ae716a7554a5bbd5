#pragma once

// Whether a surface that came out is clean (closed, outward, manifold, free of self-intersections),
// and of the same kind as the one that went in. Takes both, leaves the first defect as a sentence.

#include <octafront/no_context.h>
#include <octafront/vec.h>

#include "base/mesh/edge_table.h"

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// The first way in which `result` fails to be a clean surface of the same kind as `input`, as a sentence with ids and
/// coordinates; nullopt if it is one:
///   - indices in range, coordinates finite, no vertex unused, no face without area
///   - closed, 2-manifold, consistently oriented, outward (shells inside an odd number of others inward)
///   - no self-intersection, exactly
///   - as many shells as `input`, of the same genus and nested as deep
/// Requires that `input` is clean. Cost: O(n log n), about 1.5 s per million triangles of `result`.
std::optional<std::string> first_surface_defect(const SurfaceMesh& result, const SurfaceMesh& input,
                                                const RunContext& context = no_context());

/// The first way in which a complex that came out is not one, but for crossings, as a sentence: edges around which the
/// regions do not agree, parts in another region than they say. About 2 s per million triangles. `places` gets the
/// first ones of each kind, where they are known.
std::optional<std::string> first_complex_defect_but_crossings(const SurfaceMesh& complex, const RunContext& context,
                                                              std::vector<Vec3>* places = nullptr);

/// The same in parts, for callers that check several surfaces made from one input, and know their self-intersections.
class SurfaceKind {
 public:
  SurfaceKind(const SurfaceMesh& input, const EdgeTable& edges);
  /// The first defect of `result` but for self-intersections. About 0.5 s per million triangles. `places` gets the
  /// vertices of the shells that are not as they should be, if that is the defect.
  std::optional<std::string> first_defect_but_crossings(const SurfaceMesh& result, const RunContext& context,
                                                        std::vector<Vec3>* places = nullptr) const;

 private:
  struct Shell {
    std::uint32_t depth = 0;  ///< number of shells around it
    std::int64_t genus = 0;
    int sign = 0;             ///< of the volume it encloses
    std::uint32_t piece = 0;  ///< its number
    Vec3 at;                  ///< a vertex of it

    auto key() const { return std::tuple{depth, genus, sign}; }
    bool faces_right() const { return sign == (depth % 2 == 0 ? 1 : -1); }
  };
  struct Shells {
    std::vector<Shell> sorted;  ///< by their keys
    std::vector<std::uint32_t> piece_of_triangle;
  };
  static Shells shells_of(const SurfaceMesh& surface, const EdgeTable& edges);
  static std::string words(const Shell& shell);
  std::vector<std::uint8_t> wrong_pieces(const std::vector<Shell>& made) const;

  std::vector<Shell> wanted_;
};

}  // namespace octafront
