#pragma once

// cad: the program octafront-cad. What was read of a file, in the types of OpenCASCADE, as it goes from step to step.

#include "cad/model/stream.h"

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <stdexcept>
#include <string>
#include <vector>

namespace octafront::cad {

/// What ends the program's work with a sentence for the user.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// By the face itself, wherever it is placed; its orientation makes no difference.
using FaceLabels = NCollection_DataMap<TopoDS_Shape, Labels, TopTools_ShapeMapHasher>;

struct Body {
  TopoDS_Shape solid;
  Labels labels;
  std::string product = {}, material = {};  ///< as of Solid
  double density = 0;
};

struct Part {
  std::vector<Body> solids;
  std::vector<TopoDS_Shape> loose;  ///< faces of no solid
  FaceLabels face_labels;
  std::vector<SharedSpace> shared;  ///< by the solids' places here
  bool fused = true;
  std::string format, unit;
  double to_millimetres = 1;
  double per_millimetre = 1;  ///< in how many units of the shapes, and of all that is said of them
  std::vector<std::string> notes;
};

struct Arguments {
  std::string file;
  double memory = 0;       ///< bytes; 0: no limit
  double cpu_seconds = 0;  ///< of the reading, and of each answer; 0: no limit
  bool fuse = true, heal = true, keep_going = false;
  Overlap overlap = Overlap::kRefuse;
  double tolerance = 0;  ///< millimetres; solids that share a layer no thicker touch
};

}  // namespace octafront::cad
