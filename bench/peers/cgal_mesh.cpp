// CGAL's Mesh_3 as a program, for comparison only (CGAL's meshers are under the GPL; nothing of Octafront uses them):
//   cgal_mesh SURFACE.off MESH.mesh SIZE
// Features from 40 degrees on are kept; sizes are bounds of CGAL's criteria that come out near edges of length SIZE.

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/Polyhedron_iostream.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/make_mesh_3.h>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  Polyhedron surface;
  std::ifstream in(argv[1]);
  if (!(in >> surface) || !CGAL::is_closed(surface)) {
    std::cerr << "error: not a closed surface\n";
    return 3;
  }
  const double h = std::atof(argv[3]);
  const std::clock_t start = std::clock();
  Domain domain(surface);
  domain.detect_features(40);
  namespace p = CGAL::parameters;
  const Criteria criteria(p::edge_size = h, p::facet_angle = 25, p::facet_size = 0.65 * h, p::facet_distance = 0.1 * h,
                          p::cell_radius_edge_ratio = 2, p::cell_size = 0.7 * h);
  const Complex mesh = CGAL::make_mesh_3<Complex>(domain, criteria);
  std::cout << "meshing CPU seconds: " << static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC << "\n";
  std::ofstream out(argv[2]);
  out.precision(17);
  mesh.output_to_medit(out);
  return out ? 0 : 5;
}
