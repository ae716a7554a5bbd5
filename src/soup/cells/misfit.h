#pragma once

#include <octafront/complex.h>
#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace octafront::cells {

/// Triangles of several bodies in one soup.
struct BodySoup {
  const std::vector<Vec3>& points;
  const std::vector<Triangle>& triangles;
  const std::vector<std::uint32_t>& body;  ///< per triangle; no vertex belongs to two bodies
};

/// What is known of the mesh to come.
struct ElementsToCome {
  std::optional<double> size;            ///< edge length, input units, > 0
  std::optional<std::int64_t> elements;  ///< how many, where there is no size
};

/// What counts as one wall.
struct MisfitLimits {
  /// Nothing farther apart than this is brought together; without a value what facets explain, or a part of the size.
  std::optional<double> tolerance;
  double size = 0;  ///< edge length of the elements to come

  /// Of walls that are not curved.
  double most() const;
};

/// By what is known, and how much there is to fill.
MisfitLimits limits_for(std::optional<double> tolerance, const ElementsToCome& elements, double volume);
MisfitLimits limits_for(const ComplexOptions& options, const ElementsToCome& elements, const std::vector<Body>& bodies);

/// Whether walls with normals n and m, nearest to each other along `way`, may be one wall: nearly parallel, and apart
/// across them rather than along.
bool face_each_other(Vec3 n, Vec3 m, Vec3 way);

/// Whether facets side by side, by their normals, may be of one curved wall: the edge between is not sharp.
bool is_curved(Vec3 n, Vec3 m);

/// How far walls of two bodies that are meant to be one lie apart: a property of their contact. Walls count that are
/// nearly parallel and nearer to each other than the limits say, and than a part of the way through either body.
class Misfits {
 public:
  Misfits(const BodySoup& soup, const MisfitLimits& limits, const RunContext& context);

  /// How far apart are the walls of two bodies that belong together, at most; 0: they have no contact.
  double misfit(std::uint32_t a, std::uint32_t b) const {
    const auto found = misfit_.find({std::min(a, b), std::max(a, b)});
    return found == misfit_.end() ? 0 : found->second;
  }
  const std::map<std::pair<std::uint32_t, std::uint32_t>, double>& all() const { return misfit_; }
  /// What is that near comes together: corners of three walls are farther apart than the walls.
  double reach(std::uint32_t a, std::uint32_t b) const { return std::max(floor_, kOfCorner * misfit(a, b)); }
  double largest() const;
  /// The place of each body if those with the coarsest facets where they meet others come first; else they keep their
  /// order.
  std::vector<std::uint32_t> coarsest_first() const;
  /// The same of bodies with other numbers: number[b] instead of b.
  Misfits renumbered(const std::vector<std::uint32_t>& number) const;
  /// As if no two bodies were in contact.
  Misfits without_contacts() const {
    Misfits none = *this;
    none.misfit_.clear();
    return none;
  }
  /// What is that near is the same for any two bodies; 0: exactly as they are.
  double floor() const { return floor_; }
  std::uint32_t bodies() const { return bodies_; }

 private:
  static constexpr double kOfCorner = 2;

  std::uint32_t bodies_ = 0;
  double floor_ = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> misfit_;  ///< of bodies in contact, the earlier one first
  std::vector<double> sagitta_;  ///< per body: how far facets in contact are from what they stand for, at most
};

}  // namespace octafront::cells
