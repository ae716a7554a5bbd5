#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "sizing/sources/surface_samples.h"

#include <cstdint>
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

}  // namespace octafront
