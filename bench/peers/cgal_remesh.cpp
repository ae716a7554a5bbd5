// CGAL's isotropic remeshing for the comparison in bench/run/surface.py: cgal_remesh IN.stl SIZE OUT.off
// CGAL's remeshing is under the GPL: this program is built for the comparison only and is no part of the library.

#include <cstdlib>
#include <fstream>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  Mesh mesh;
  if (!PMP::IO::read_polygon_mesh(argv[1], mesh)) return 3;
  const double size = std::atof(argv[2]);
  auto is_feature = mesh.add_property_map<Mesh::Edge_index, bool>("e:is_feature", false).first;
  PMP::detect_sharp_edges(mesh, 40, is_feature);
  PMP::split_long_edges(edges(mesh), size, mesh, PMP::parameters::edge_is_constrained_map(is_feature));
  PMP::isotropic_remeshing(
      faces(mesh), size, mesh,
      PMP::parameters::number_of_iterations(5).edge_is_constrained_map(is_feature).protect_constraints(false));
  mesh.collect_garbage();
  std::ofstream out(argv[3]);
  out.precision(17);
  return CGAL::IO::write_OFF(out, mesh) ? 0 : 4;
}
