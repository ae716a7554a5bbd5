#include "judged_shape.h"

#include "cad/measure.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepExtrema_ExtPC.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Extrema_ExtPS.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>
#include <utility>

namespace octafront {

namespace {

/// Of triangles for boxes: how far chords lie off, in diagonals, and how far neighbours turn, radians.
constexpr double kChord = 1e-4, kTurn = 0.2;

std::string ending_of(const std::string& file) {
  std::string ending = file.substr(file.rfind('.') + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

template <class Reader>
TopoDS_Shape transferred(Reader& reader, const std::string& file) {
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw std::runtime_error(file + " cannot be read");
  reader.TransferRoots();
  return reader.OneShape();
}

/// A solid that two assemblies have at one place counts once.
TopTools_IndexedMapOfShape parts_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape parts;
  TopExp::MapShapes(shape, kind, parts);
  return parts;
}

Box3 box_of(const TopoDS_Shape& shape) {
  Bnd_Box bounds;
  BRepBndLib::Add(shape, bounds, false);
  Box3 box;
  if (!bounds.IsVoid()) bounds.Get(box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
  return box;
}

/// Of fine triangles, whose corners lie on the faces: BRepBndLib::AddOptimal() finds more than there is of some faces.
Box3 close_box_of(const TopoDS_Shape& shape) {
  BRepMesh_IncrementalMesh(shape, kChord * box_of(shape).diagonal(), false, kTurn);
  Box3 box;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    TopLoc_Location place;
    const auto triangles = BRep_Tool::Triangulation(TopoDS::Face(it.Current()), place);
    for (int i = 1; !triangles.IsNull() && i <= triangles->NbNodes(); ++i) {
      const gp_Pnt p = triangles->Node(i).Transformed(place.Transformation());
      box.add(Vec3{p.X(), p.Y(), p.Z()});
    }
  }
  return box;
}

double distance_to(Vec3 p, const Box3& box) {
  const auto beyond = [](double x, double lo, double hi) { return std::max({0.0, lo - x, x - hi}); };
  return std::hypot(beyond(p.x, box.lo.x, box.hi.x), beyond(p.y, box.lo.y, box.hi.y), beyond(p.z, box.lo.z, box.hi.z));
}

}  // namespace

TopoDS_Shape shape_of(const std::string& file) {
  const std::string ending = ending_of(file);
  if (ending == "igs" || ending == "iges") {
    IGESControl_Reader reader;
    return transferred(reader, file);
  }
  if (ending == "brep" || ending == "brp") {
    TopoDS_Shape shape;
    if (!BRepTools::Read(shape, file.c_str(), BRep_Builder())) throw std::runtime_error(file + " cannot be read");
    return shape;
  }
  STEPControl_Controller::Init();
  STEPControl_Reader reader;
  return transferred(reader, file);
}

TopoDS_Shape sewn(const TopoDS_Shape& shape) {
  if (TopExp_Explorer(shape, TopAbs_SOLID).More()) return shape;
  BRepBuilderAPI_Sewing sewing(std::max(Precision::Confusion(), ShapeAnalysis_ShapeTolerance().Tolerance(shape, 1)));
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) sewing.Add(it.Current());
  sewing.Perform();
  return sewing.SewedShape();
}

ShapeMeasures measures_of(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape solids = parts_of(shape, TopAbs_SOLID);
  ShapeMeasures sum;
  sum.solids = static_cast<std::size_t>(solids.Extent());
  TopTools_IndexedMapOfShape faces;
  const auto add = [&](const TopoDS_Shape& part) {
    TopExp::MapShapes(part, TopAbs_FACE, faces);
    sum.area += cad::area_of(part);
    sum.box.add(close_box_of(part));
  };
  for (int i = 1; i <= solids.Extent(); ++i) add(solids(i));
  if (solids.IsEmpty()) {
    const TopTools_IndexedMapOfShape loose = parts_of(shape, TopAbs_FACE);
    for (int i = 1; i <= loose.Extent(); ++i) add(loose(i));
  }
  sum.faces = static_cast<std::size_t>(faces.Extent());
  return sum;
}

/// A face that is asked for distances many times.
class JudgedShape::Face {
 public:
  explicit Face(const TopoDS_Face& face) : face_(face) {
    start_on_face();
    tolerance_ = BRep_Tool::Tolerance(face);
    box_ = box_of(face);
    std::set<const void*> seen;
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(it.Current());
      if (BRep_Tool::Degenerated(edge) || !seen.insert(edge.TShape().get()).second) continue;
      tolerance_ = std::max(tolerance_, BRep_Tool::Tolerance(edge));
      to_edges_.push_back(std::make_unique<BRepExtrema_ExtPC>());
      to_edges_.back()->Initialize(edge);
    }
    for (TopExp_Explorer it(face, TopAbs_VERTEX); it.More(); it.Next()) {
      tolerance_ = std::max(tolerance_, BRep_Tool::Tolerance(TopoDS::Vertex(it.Current())));
      corners_.push_back(BRep_Tool::Pnt(TopoDS::Vertex(it.Current())));
    }
  }

  const Box3& box() const { return box_; }
  double tolerance() const { return tolerance_; }

  double distance(const gp_Pnt& p, double enough) {
    double best = HUGE_VAL;
    for (const gp_Pnt& corner : corners_) best = std::min(best, p.Distance(corner));
    if (best > enough) best = std::min(best, to_face(p, enough));
    const TopoDS_Vertex vertex = best > enough ? TopoDS_Vertex(BRepBuilderAPI_MakeVertex(p)) : TopoDS_Vertex();
    for (std::size_t k = 0; k < to_edges_.size() && best > enough; ++k) {
      const std::size_t e = (last_edge_ + k) % to_edges_.size();
      best = std::min(best, to_edge(vertex, *to_edges_[e]));
      if (best <= enough) last_edge_ = e;
    }
    return best;
  }

 private:
  /// As BRepExtrema_ExtPF does, but for the classifier, which is made once.
  void start_on_face() {
    surface_.Initialize(face_, false);
    const double tolerance = std::min(BRep_Tool::Tolerance(face_), Precision::Confusion());
    const double u_tolerance = std::max(surface_.UResolution(tolerance), Precision::PConfusion()),
                 v_tolerance = std::max(surface_.VResolution(tolerance), Precision::PConfusion());
    double u0, u1, v0, v1;
    BRepTools::UVBounds(face_, u0, u1, v0, v1);
    extrema_.Initialize(surface_, u0, u1, v0, v1, u_tolerance, v_tolerance);
    inside_ = std::make_unique<BRepTopAdaptor_FClass2d>(face_, std::min(u_tolerance, v_tolerance));
  }

  /// What OpenCASCADE cannot say is no distance.
  double to_face(const gp_Pnt& p, double enough) {
    double found = HUGE_VAL;
    try {
      extrema_.Perform(p);
      for (int i = 1; extrema_.IsDone() && i <= extrema_.NbExt(); ++i) {
        double u, v;
        extrema_.Point(i).Parameter(u, v);
        const double d = std::sqrt(extrema_.SquareDistance(i));
        if (d < found && is_inside({u, v}, d <= std::max(enough, tolerance_))) found = d;
      }
    } catch (const Standard_Failure&) {
    }
    return found;
  }

  /// The quick classifier goes by polygons: what it has outside is looked at again where that decides.
  bool is_inside(const gp_Pnt2d& uv, bool decides) const {
    if (inside_->Perform(uv) != TopAbs_OUT) return true;
    return decides && BRepClass_FaceClassifier(face_, uv, BRep_Tool::Tolerance(face_)).State() != TopAbs_OUT;
  }

  static double to_edge(const TopoDS_Vertex& vertex, BRepExtrema_ExtPC& extrema) {
    double found = HUGE_VAL;
    try {
      extrema.Perform(vertex);
      for (int i = 1; extrema.IsDone() && i <= extrema.NbExt(); ++i)
        found = std::min(found, std::sqrt(extrema.SquareDistance(i)));
    } catch (const Standard_Failure&) {
    }
    return found;
  }

  TopoDS_Face face_;
  BRepAdaptor_Surface surface_;
  Extrema_ExtPS extrema_;
  std::unique_ptr<BRepTopAdaptor_FClass2d> inside_;
  std::vector<std::unique_ptr<BRepExtrema_ExtPC>> to_edges_;
  std::size_t last_edge_ = 0;  ///< the next node is likely to be on it too
  std::vector<gp_Pnt> corners_;
  Box3 box_;
  double tolerance_ = 0;
};

JudgedShape::JudgedShape(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape faces = parts_of(shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) faces_.push_back(std::make_unique<Face>(TopoDS::Face(faces(i))));
}

JudgedShape::~JudgedShape() = default;

JudgedShape::Found JudgedShape::nearest(Vec3 p, double enough, std::size_t first) const {
  Found best;
  const auto look = [&](std::size_t f) {
    const double d = faces_[f]->distance({p.x, p.y, p.z}, enough);
    if (d < best.distance) best = {d, faces_[f]->tolerance(), f};
  };
  if (first < faces_.size()) look(first);
  if (best.distance <= enough) return best;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (f != first) order.push_back({distance_to(p, faces_[f]->box()), f});
  std::sort(order.begin(), order.end());
  for (const auto& [least, f] : order) {
    if (least >= best.distance || best.distance <= enough) break;
    look(f);
  }
  return best;
}

}  // namespace octafront
