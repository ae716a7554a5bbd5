#include "triangulate.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_Context.hxx>
#include <BRepMesh_DelabellaMeshAlgoFactory.hxx>
#include <BRepMesh_FaceDiscret.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepMesh_MeshAlgoFactory.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IMeshData_Face.hxx>
#include <IMeshTools_MeshAlgo.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS_Compound.hxx>

namespace octafront::cad {

namespace {

constexpr double kCoarser[] = {1, 4, 16};
/// Steps that one face may take: about as many points, and 5 s. Counted, for a time would come to other triangles on
/// another machine.
constexpr long kMostSteps = 100'000;
/// Of a B-spline with more spans a step takes a hundred times as long: it goes to the quicker algorithm at once.
constexpr int kMostSpans = 2000;

int spans_of(const TopoDS_Face& face) {
  const BRepAdaptor_Surface surface(face, false);
  if (surface.GetType() != GeomAbs_BSplineSurface) return 1;
  return (surface.NbUKnots() - 1) * (surface.NbVKnots() - 1);
}

/// Breaks an algorithm off: the library asks at each of its steps.
class StepLimit : public Message_ProgressIndicator {
 public:
  bool reached() const { return steps_ > kMostSteps; }

 protected:
  Standard_Boolean UserBreak() override { return ++steps_ > kMostSteps; }
  void Show(const Message_ProgressScope&, const Standard_Boolean) override {}

 private:
  long steps_ = 0;
};

struct Watch {
  const Topology& topology;
  std::vector<int> rung;
  const std::function<void(std::size_t)>& on_face;
};

/// The library's algorithm for one face, and coarser ones where it does not end well. Points on edges stay as they are.
class WatchedAlgorithm : public IMeshTools_MeshAlgo {
 public:
  WatchedAlgorithm(GeomAbs_SurfaceType type, Watch& watch) : type_(type), watch_(watch) {}

  void Perform(const IMeshData::IFaceHandle& face, const IMeshTools_Parameters& parameters,
               const Message_ProgressRange&) override {
    const std::size_t f = watch_.topology.index_of(face->GetFace());
    watch_.on_face(f);
    const int flags = face->GetStatusMask();
    if (watch_.rung[f] == 0 && spans_of(face->GetFace()) > kMostSpans) watch_.rung[f] = 1;
    for (int& rung = watch_.rung[f]; rung < kLastRung; ++rung) {
      face->UnsetStatus(static_cast<IMeshData_Status>(~flags));
      if (perform(face, parameters, rung)) return;
    }
    face->SetStatus(IMeshData_Failure);
  }

 private:
  bool perform(const IMeshData::IFaceHandle& face, IMeshTools_Parameters parameters, int rung) {
    parameters.DeflectionInterior *= kCoarser[rung], parameters.AngleInterior *= kCoarser[rung];
    parameters.MinSize *= kCoarser[rung];
    const Handle(StepLimit) limit = new StepLimit;
    try {
      const Handle(IMeshTools_MeshAlgo) algorithm = factory_of(rung)->GetAlgo(type_, parameters);
      if (algorithm.IsNull()) return false;
      algorithm->Perform(face, parameters, limit->Start());
    } catch (const Standard_Failure&) {
      return false;
    }
    TopLoc_Location place;
    return !limit->reached() && !BRep_Tool::Triangulation(face->GetFace(), place).IsNull();
  }

  /// The library's second algorithm is the quicker one.
  static Handle(IMeshTools_MeshAlgoFactory) factory_of(int rung) {
    if (rung == 0) return new BRepMesh_MeshAlgoFactory;
    return new BRepMesh_DelabellaMeshAlgoFactory;
  }

  const GeomAbs_SurfaceType type_;
  Watch& watch_;
};

class WatchedFactory : public IMeshTools_MeshAlgoFactory {
 public:
  explicit WatchedFactory(Watch& watch) : watch_(watch) {}
  Handle(IMeshTools_MeshAlgo) GetAlgo(const GeomAbs_SurfaceType type, const IMeshTools_Parameters&) const override {
    return new WatchedAlgorithm(type, watch_);
  }

 private:
  Watch& watch_;
};

}  // namespace

std::vector<int> triangulate(const Part&, const Topology& topology, const Fineness& fineness,
                             const std::vector<int>& first_rung, const std::function<void(std::size_t)>& on_face) {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const Topology::OfFace& face : topology.faces) BRep_Builder().Add(all, face.face);
  // The library takes triangles that are there for good enough, if only their deflection is.
  BRepTools::Clean(all, true);
  Watch watch{topology, first_rung, on_face};
  const Handle(BRepMesh_Context) context = new BRepMesh_Context;
  context->SetFaceDiscret(new BRepMesh_FaceDiscret(new WatchedFactory(watch)));
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(all);
  mesher.ChangeParameters().Deflection = fineness.deflection;
  mesher.ChangeParameters().Angle = fineness.angle;
  mesher.ChangeParameters().InParallel = false;
  mesher.Perform(context);
  return watch.rung;
}

}  // namespace octafront::cad
