#pragma once

#include "base/geometry/true_geometry.h"
#include "base/places/shape_place.h"
#include "cad/model/cad_model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::cad {

/// The places of a model, whose parts are its faces. Refers to it.
class CadPlaces {
 public:
  /// `unit`: of the radii that are given, in the model's.
  explicit CadPlaces(const CadModel& model, double unit = 1);

  /// The faces that are meant, ascending: by their names; by those of colours, layers and contacts; "face 12" whatever
  /// it is called; by what they are like.
  std::vector<std::uint32_t> faces(const std::string& place) const;
  /// Faces, or edges or vertices by what they are like. Points count in `unit`.
  FoundShapes find(const std::string& place) const;

 private:
  /// Something that may be meant: where its middle is, and how large it is.
  struct Candidate {
    std::uint32_t number;
    Vec3 middle;
    double extent = 0;
  };

  std::vector<std::uint32_t> faces_like(const ShapePlace& place) const;
  std::vector<FoundLine> lines_like(const ShapePlace& place) const;
  std::vector<Vec3> points_like(const ShapePlace& place) const;
  /// Per face, whether it is of what is called so; all, if nothing is asked.
  std::vector<char> faces_of(const std::string& name) const;
  std::vector<std::uint32_t> chosen(std::vector<Candidate> all, const ShapePlace& place) const;
  bool is_line_of(const CadEdge& edge, const std::vector<char>& of) const;

  const CadModel& model_;
  double unit_, diagonal_;
  std::vector<std::string> names_;
  std::vector<char> is_there_;  ///< per face: it has triangles
};

}  // namespace octafront::cad
