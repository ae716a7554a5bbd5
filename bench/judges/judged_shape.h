#pragma once

// A CAD file as OpenCASCADE has it, for judges: nothing of octafront-cad or of the mesher has a part in it.

#include <octafront/vec.h>

#include <TopoDS_Shape.hxx>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace octafront {

/// Reads STEP, IGES or BREP, by the ending; lengths in millimetres, of BREP as they are. Throws std::runtime_error.
TopoDS_Shape shape_of(const std::string& file);

/// The shape itself if it has solids, else its faces, sewn where they meet within its tolerance.
TopoDS_Shape sewn(const TopoDS_Shape& shape);

/// What OpenCASCADE says of the solids of a shape, or of all faces where there is none.
struct ShapeMeasures {
  std::size_t solids = 0, faces = 0;  ///< each once; an instance elsewhere is another
  double area = 0;                    ///< of the faces of all solids: of one that two share twice
  Box3 box;                           ///< within a ten-thousandth of its diagonal
};
ShapeMeasures measures_of(const TopoDS_Shape& shape);

/// Distances to the faces of a shape.
class JudgedShape {
 public:
  struct Found {
    double distance = HUGE_VAL;
    double tolerance = 0;  ///< the largest of that face and of its edges and vertices
    std::size_t face = 0;
  };

  explicit JudgedShape(const TopoDS_Shape& shape);
  ~JudgedShape();

  /// To the nearest face, edge or vertex. Of what is nearer than `enough` no nearer place is looked for; the face
  /// `first` is looked at before the others.
  Found nearest(Vec3 p, double enough, std::size_t first) const;

 private:
  class Face;
  std::vector<std::unique_ptr<Face>> faces_;
};

}  // namespace octafront
