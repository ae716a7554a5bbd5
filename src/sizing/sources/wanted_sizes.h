#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"
#include "sizing/field/background_grid.h"
#include "sizing/sources/surface_samples.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// Who asks for the base where a source speaks for all places.
inline const char* const kNobody = "nobody";

/// Which source asks for the smallest size on each triangle, for the report.
class SourceShares {
 public:
  /// `face` as it is before any source but the base speaks.
  void begin(std::string base, const std::vector<double>& face);
  /// What changed in `face` since the last call was asked for by that source.
  void changed(const std::string& by, const std::vector<double>& face);
  /// `face` was scaled by all of one.
  void scaled(const std::vector<double>& face) { last_ = face; }
  /// A source that is asked place by place, after all others.
  void add(std::string by, SizeAtPlace at);

  /// Counts "asked by SOURCE, % of the surface" and "made for SOURCE, % of the elements" (about: sizes grow at the
  /// gradation from where they are asked for), and says so in a sentence where `options` name sources beyond one, and
  /// in another where few places make most of the elements. `face`: the sizes of the last call of changed(), `field`:
  /// what came out of all of them, times `factor`.
  void tell(const SurfaceMesh& surface, const std::vector<double>& face, const SizeField& field,
            const SizeOptions& options, const Stage& stage, double factor = 1) const;

 private:
  struct AtPlace {
    std::uint8_t number;
    SizeAtPlace at;
  };
  struct Place {
    PlaceOnSurface on;
    double area;  ///< that it stands for
  };
  struct Asked {
    double size;
    std::uint8_t source;
  };
  static RawVector<Place> places_on(const SurfaceMesh& surface);
  Asked least_at(const Place& place, const std::vector<double>& face) const;
  RawVector<Asked> least_at_all(const RawVector<Place>& places, const std::vector<double>& face) const;
  std::uint8_t number_of(const std::string& name);
  /// What each source asks for, in parts of all.
  struct Part {
    double of_surface = 0, of_elements = 0;
  };
  std::vector<Part> part_of_each(const SurfaceMesh& surface, const std::vector<double>& face, const SizeField& field,
                                 const SizeOptions& options, double factor) const;

  std::vector<std::string> names_;
  std::vector<double> last_;
  std::vector<std::uint8_t> of_face_;
  std::vector<AtPlace> places_;
};

// sizing/sources: what size is wanted where on a surface, and by whom: the user's options, curvature, gaps, feature
// curves, facets, names, points, a callback, triangles that are kept; and the background grid of all that
// (source_grid.h).

/// A size that is given means what it says: what the shape alone asks for does not go below this part of it.
inline constexpr double kLeastOfGiven = 1.0 / 4;

/// What holds of single triangles of a surface, on top of SizeOptions.
struct FaceRules {
  std::span<const double> chord_errors = {};  ///< SizeOptions::chord_error; infinity: nothing; empty: so everywhere
  /// Not 0: nobody knows how the surface bends there, so it asks for no size. Empty: so nowhere.
  std::span<const std::uint8_t> is_invented = {};
  /// Chord errors are what the user asks of volumes: no floor of an automatic choice stops them.
  bool must_hold = false;
  /// Where a size is given, and nothing said of curvature: elements that a full turn of the surface takes, down to
  /// kLeastOfGiven of that size. 0: none.
  double turns = 0;
  /// Elements are to be curved: automatic ones are kSecondOrderEdge times as large, and details as fine.
  bool curved = false;
  /// Where the body is thin it asks for no size below this; 0: there is no such limit.
  double least = 0;
};

/// An edge of second order has a node in its middle, and says as much as two.
inline constexpr double kSecondOrderEdge = 2;
/// The steepest gradation that their spread decides (kSteepestGradation: of first order).
inline constexpr double kSteepestCurved = 0.8;

/// What all sources together want on a surface, before any of it is put into a grid. Input units.
struct WantedSizes {
  std::vector<double> face;        ///< per triangle
  std::vector<SizeSample> points;  ///< at feature curves and the like
  SizeAtPlace at_place;            ///< asked at each sample of the surface; may be empty
  double ceiling = 0;              ///< no size inside rises above this
  bool even = false;               ///< one size everywhere
  bool automatic = false;          ///< the user left the choice to us
  SourceShares sources;            ///< who asks for them

  /// The same with `change` applied to every size.
  WantedSizes with(const std::function<double(double)>& change) const;
};

/// Whether nothing says what the sizes are, so that all are of our own choice, up to a largest one.
bool has_no_size_source(const SizeOptions& options);

/// Asks every source that `options` names; the automatic choice if it names none. Throws OptionError. Refers to the
/// surface, which must outlive it.
WantedSizes wanted_sizes(const KnownSurface& known, const SizeOptions& options, const Stage& stage,
                         const FaceRules& rules = {});

}  // namespace octafront
