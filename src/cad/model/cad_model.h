#pragma once

// cad/model: what is known of a CAD file, as plain data: triangles, faces, edges, solids, names, and the geometry of
// faces and edges as records. Made by the program octafront-cad, which alone knows OpenCASCADE; travels as bytes
// (stream.h), and answers for itself afterwards (cad/shapes).

#include <octafront/ids.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront::cad {

/// Place and directions of an analytic curve or surface: unit vectors, orthogonal; y need not be z x x.
struct Frame {
  Vec3 origin, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// Parameters of a point on a surface.
struct Uv {
  double u = 0, v = 0;
  friend bool operator==(const Uv&, const Uv&) = default;
};

/// A B-spline of one direction: `knots` with their multiplicities (poles + degree + 1 of them), ascending.
struct Knots {
  std::uint32_t degree = 0;
  std::vector<double> knots;
  std::size_t poles() const { return knots.empty() ? 0 : knots.size() - degree - 1; }
  double first() const { return knots[degree]; }
  double last() const { return knots[knots.size() - degree - 1]; }
};

/// The geometry of a curve, by parameter t:
/// kLine    origin + t x
/// kCircle  origin + radius (cos t x + sin t y)
/// kEllipse origin + radius cos t x + minor sin t y
/// kNurbs   a B-spline, rational where `weights` are given
/// kNone    not known: points stay on the triangles' edges
struct CurveRecord {
  enum class Kind : std::uint8_t { kNone, kLine, kCircle, kEllipse, kNurbs };
  Kind kind = Kind::kNone;
  Frame frame;
  double radius = 0, minor = 0;
  Knots knots;
  std::vector<Vec3> poles;
  std::vector<double> weights;  ///< one per pole, or empty
};

/// The geometry of a face, by parameters u and v:
/// kPlane    origin + u x + v y
/// kCylinder origin + radius (cos u x + sin u y) + v z
/// kCone     origin + (radius + v sin minor) (cos u x + sin u y) + v cos minor z; `minor`: the semi-angle
/// kSphere   origin + radius cos v (cos u x + sin u y) + radius sin v z
/// kTorus    origin + (radius + minor cos v) (cos u x + sin u y) + minor sin v z
/// kNurbs    a tensor product of B-splines, rational where `weights` are given
/// kNone     not known: points stay on the triangles
struct SurfaceRecord {
  enum class Kind : std::uint8_t { kNone, kPlane, kCylinder, kCone, kSphere, kTorus, kNurbs };
  Kind kind = Kind::kNone;
  Frame frame;
  double radius = 0, minor = 0;
  Knots u_knots, v_knots;
  std::vector<Vec3> poles;      ///< pole (i, j) is poles[i * v_knots.poles() + j]
  std::vector<double> weights;  ///< one per pole, or empty
  /// After how much of a parameter the surface is itself again; 0: never. Of kNurbs only; for the others it is known.
  double u_period = 0, v_period = 0;
};

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// What a file says of a solid or a face beside its geometry. Empty: nothing.
struct Labels {
  std::string name;  ///< UTF-8
  std::string layer;
  std::optional<Colour> colour;
};

/// A face of the B-rep.
struct Face {
  Labels labels;
  SurfaceRecord surface;
  bool is_turned = false;  ///< its front is where the derivatives by u and v do not point, as the file has them
  /// The box of its parameters, u and v; what is trimmed away inside of it is not known.
  Uv low, high;
  Sides sides = {kNone, kNone};  ///< the solids in front of its triangles and behind; kNone: none
  /// The first of the faces between the same solids that go on as one kind of surface, smoothly; kNone: itself.
  std::uint32_t piece = kNone;
  double area = 0;       ///< of the true face
  double tolerance = 0;  ///< of the B-rep, input units
  /// How its triangles came: as asked, coarser than asked, or not at all (filled from its boundary elsewhere).
  enum class Triangles : std::uint8_t { kAsAsked, kCoarser, kNone };
  Triangles triangles = Triangles::kAsAsked;
};

/// An edge of the B-rep: a polyline of the triangulation, once for all faces that meet in it.
struct CadEdge {
  CurveRecord curve;
  std::vector<VertexIndex>
      vertices;                    ///< along it, at least two, from `parameters.front()` on; the first twice if closed
  std::vector<double> parameters;  ///< one per vertex: where on the curve; ascending
  std::vector<std::uint32_t> faces;  ///< that meet in it, each once
  double length = 0;                 ///< of the true curve
  double tolerance = 0;
  bool is_seam = false;    ///< the same face on both sides, and smooth across: an artefact of parameters
  bool is_smooth = false;  ///< its two faces have the same tangent plane all along it, within 1 degree
};

struct Solid {
  Labels labels;
  std::string product, material;  ///< what it is an occurrence of, and made of, by name; empty: the file does not say
  double density = 0;             ///< kg/m3; 0: the file does not say
  double volume = 0, area = 0;    ///< of the true solid
  bool closed = false;            ///< its triangles are: by topology
};

/// Two solids that had space in common when they were read.
struct SharedSpace {
  std::array<std::uint32_t, 2> solids{};  ///< ascending
  double volume = 0, depth = 0;           ///< how thick that space is
};

struct CadModel {
  std::vector<Vec3> points;                ///< millimetres times `per_millimetre`, as all lengths
  std::vector<Triangle> triangles;         ///< counter-clockwise seen from the front of their face
  std::vector<std::uint32_t> face_of;      ///< one per triangle
  std::vector<std::array<Uv, 3>> corners;  ///< one per triangle: parameters of its corners on the face
  std::vector<Face> faces;
  std::vector<CadEdge> edges;  ///< without degenerate ones
  std::vector<Solid> solids;
  std::vector<VertexIndex> vertices;  ///< points that are vertices of the B-rep
  double tolerance = 0;               ///< the largest of the B-rep
  std::vector<SharedSpace> shared;
  /// Solids that touch share faces. False: that was not done, or not for all; faces of different solids may lie on one
  /// another, or cross.
  bool fused = true;
  std::string format;              ///< "STEP", "IGES", "BREP"
  std::string unit;                ///< of the file, in words: "millimetre", "inch"; "": it says none
  double to_millimetres = 1;       ///< by which the file's numbers were multiplied
  double per_millimetre = 1;       ///< the unit of all lengths here: more than 1 where the library needs larger shapes
  std::vector<std::string> notes;  ///< what was found, healed, fused, left out
};

/// How fine triangles are.
struct Fineness {
  double deflection = 0;  ///< in the model's unit, > 0: triangles and polylines lie so near to the true face or edge
  double angle = 0.25;    ///< radians, > 0: neighbours turn by no more
};

}  // namespace octafront::cad
