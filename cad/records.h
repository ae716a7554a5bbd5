#pragma once

#include "cad/model/cad_model.h"

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <vector>

namespace octafront::cad {

/// A point that a record is held against, and its parameters. Points on a face's border are its edges': how far a file
/// lets these lie off their faces is not what its tolerances say.
struct SurfaceSample {
  Uv at;
  Vec3 p;
  bool on_border = false;
};
struct CurveSample {
  double at = 0;
  Vec3 p;
  bool on_border = false;  ///< a vertex
};

/// How far a record may pass by points inside, and by those on the border.
struct Allowed {
  double inside = 0, border = 0;
};

/// The geometry of a face as a record that passes through the samples so near; kNone where none does. Sets their
/// parameters anew where the record has others than the face.
SurfaceRecord surface_record(const TopoDS_Face& face, std::vector<SurfaceSample>& samples, const Allowed& allowed);
/// The same before there are points to hold it against: where a few numbers give it, else kNone.
SurfaceRecord analytic_record(const TopoDS_Face& face);
/// The same for an edge.
CurveRecord curve_record(const TopoDS_Edge& edge, std::vector<CurveSample>& samples, const Allowed& allowed);

/// How far the record passes by the samples.
double gap(const SurfaceRecord& record, const std::vector<SurfaceSample>& samples);
double gap(const CurveRecord& record, const std::vector<CurveSample>& samples);

}  // namespace octafront::cad
