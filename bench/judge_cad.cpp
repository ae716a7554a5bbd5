// Do the nodes of a mesh's boundary lie on the faces of the CAD file that it was made of? OpenCASCADE reads the file
// and measures; nothing of octafront-cad or of the mesher has a part in it. Prints one JSON object.
//   octafront_judge_cad MESH FILE [--millimetres N]     N: how many a unit of the mesh has
// Distances are to the nearest face, edge or vertex of the file, whichever the node was meant to lie on.

#include <octafront/io.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_ExtPC.hxx>
#include <BRepExtrema_ExtPF.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace {

using octafront::Box3;
using octafront::TetMesh;
using octafront::Vec3;

/// A node is on the geometry if it is nearer to it than this part of the diagonal, or than the tolerance of the file
/// there.
constexpr double kOnGeometry = 1e-9;

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

double distance_to(const gp_Pnt& p, const Box3& box) {
  const auto beyond = [](double x, double lo, double hi) { return std::max({0.0, lo - x, x - hi}); };
  return std::hypot(beyond(p.X(), box.lo.x, box.hi.x), beyond(p.Y(), box.lo.y, box.hi.y),
                    beyond(p.Z(), box.lo.z, box.hi.z));
}

/// A face that is asked for distances many times.
class JudgedFace {
 public:
  explicit JudgedFace(const TopoDS_Face& face) : face_(face) {
    to_face_.Initialize(face);
    tolerance_ = BRep_Tool::Tolerance(face);
    Bnd_Box bounds;
    BRepBndLib::Add(face, bounds, false);
    bounds.Get(box_.lo.x, box_.lo.y, box_.lo.z, box_.hi.x, box_.hi.y, box_.hi.z);
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
  double tolerance() const { return tolerance_; }  ///< the largest of its own and its edges' and vertices'

  /// Of what is nearer than `enough` no nearer place is looked for.
  double distance(const gp_Pnt& p, double enough) {
    double best = HUGE_VAL;
    for (const gp_Pnt& corner : corners_) best = std::min(best, p.Distance(corner));
    const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(p);
    if (best > enough) best = std::min(best, least(vertex, to_face_, &face_));
    for (std::size_t e = 0; e < to_edges_.size() && best > enough; ++e)
      best = std::min(best, least(vertex, *to_edges_[e], nullptr));
    return best;
  }

 private:
  static void perform(BRepExtrema_ExtPF& extrema, const TopoDS_Vertex& v, const TopoDS_Face* f) {
    extrema.Perform(v, *f);
  }
  static void perform(BRepExtrema_ExtPC& extrema, const TopoDS_Vertex& v, const TopoDS_Face*) { extrema.Perform(v); }

  /// What OpenCASCADE cannot say is no distance.
  template <class Extrema>
  static double least(const TopoDS_Vertex& vertex, Extrema& extrema, const TopoDS_Face* face) {
    double found = HUGE_VAL;
    try {
      perform(extrema, vertex, face);
      for (int i = 1; extrema.IsDone() && i <= extrema.NbExt(); ++i)
        found = std::min(found, std::sqrt(extrema.SquareDistance(i)));
    } catch (const Standard_Failure&) {
    }
    return found;
  }

  TopoDS_Face face_;
  BRepExtrema_ExtPF to_face_;
  std::vector<std::unique_ptr<BRepExtrema_ExtPC>> to_edges_;
  std::vector<gp_Pnt> corners_;
  Box3 box_;
  double tolerance_ = 0;
};

struct Found {
  double distance = HUGE_VAL, tolerance = 0;
};

class Geometry {
 public:
  explicit Geometry(const TopoDS_Shape& shape) {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) faces_.push_back(std::make_unique<JudgedFace>(TopoDS::Face(faces(i))));
  }

  Found nearest(const gp_Pnt& p, double enough) const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t f = 0; f < faces_.size(); ++f) order.push_back({distance_to(p, faces_[f]->box()), f});
    std::sort(order.begin(), order.end());
    Found best;
    for (const auto& [least, f] : order) {
      if (least >= best.distance || best.distance <= enough) break;
      const double d = faces_[f]->distance(p, enough);
      if (d < best.distance) best = {d, faces_[f]->tolerance()};
    }
    return best;
  }

 private:
  std::vector<std::unique_ptr<JudgedFace>> faces_;
};

/// The corners and mid-side nodes of the faces of boundary and interfaces.
struct Nodes {
  std::vector<std::uint32_t> corners, mids;
};

Nodes nodes_of(const TetMesh& mesh) {
  std::vector<char> is_corner(mesh.points.size(), 0), is_mid(mesh.points.size(), 0);
  std::set<octafront::Edge> edges;
  for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
    for (const octafront::Triangle& t : *faces)
      for (std::size_t k = 0; k < 3; ++k) {
        is_corner[t[k]] = 1;
        edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
      }
  for (std::size_t t = 0; t < mesh.mid_nodes.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto a = mesh.tets[t][static_cast<std::size_t>(octafront::kTetEdges[e][0])],
                 b = mesh.tets[t][static_cast<std::size_t>(octafront::kTetEdges[e][1])];
      if (edges.contains({std::min(a, b), std::max(a, b)})) is_mid[mesh.mid_nodes[t][e]] = 1;
    }
  Nodes nodes;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (is_corner[v]) nodes.corners.push_back(v);
    if (is_mid[v]) nodes.mids.push_back(v);
  }
  return nodes;
}

struct Summary {
  std::size_t nodes = 0, off = 0;
  double largest = 0;  ///< of the diagonal
  Vec3 where;          ///< of the mesh
};

Summary judged(const TetMesh& mesh, const std::vector<std::uint32_t>& nodes, const Geometry& geometry, double unit) {
  const double diagonal = unit * octafront::bounding_box(mesh.points).diagonal(), allowed = kOnGeometry * diagonal;
  Summary sum;
  for (const std::uint32_t v : nodes) {
    const Vec3 p = unit * mesh.points[v];
    const Found found = geometry.nearest({p.x, p.y, p.z}, allowed / 10);
    if (!std::isfinite(found.distance)) throw std::runtime_error("the file has no face and no edge to measure to");
    ++sum.nodes;
    sum.off += found.distance > std::max(allowed, found.tolerance);
    if (found.distance / diagonal > sum.largest) sum.largest = found.distance / diagonal, sum.where = mesh.points[v];
  }
  return sum;
}

std::string json_of(const Summary& s) {
  return fmt::format(R"({{"nodes": {}, "off": {}, "largest": {:.3g}, "where": [{:.9g}, {:.9g}, {:.9g}]}})", s.nodes,
                     s.off, s.largest, s.where.x, s.where.y, s.where.z);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 5) {
    std::fputs("octafront_judge_cad MESH FILE [--millimetres N]\n", stderr);
    return 2;
  }
  try {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    const double unit = argc == 5 ? std::strtod(argv[4], nullptr) : 1;
    const TetMesh mesh = octafront::read_mesh(argv[1]);
    const Geometry geometry(shape_of(argv[2]));
    const Nodes nodes = nodes_of(mesh);
    fmt::print("{{\"vertices\": {}, \"mid_side\": {}}}\n", json_of(judged(mesh, nodes.corners, geometry, unit)),
               json_of(judged(mesh, nodes.mids, geometry, unit)));
    return 0;
  } catch (const Standard_Failure& failure) {
    std::fprintf(stderr, "octafront_judge_cad: %s\n", failure.GetMessageString());
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "octafront_judge_cad: %s\n", failure.what());
  }
  return 1;
}
