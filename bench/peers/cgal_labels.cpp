// CGAL's Mesh_3 on an image of labels, for comparison only (under the GPL; nothing of Octafront uses it):
//   cgal_labels IMAGE.inr MESH.mesh SIZE
// The criteria are those of the manual's example (facets of 6, distance 4, cells of 8), in proportion to SIZE.

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Image_3.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  CGAL::Image_3 image;
  if (!image.read(argv[1])) {
    std::cerr << "error: not an image\n";
    return 3;
  }
  const double h = std::atof(argv[3]);
  const std::clock_t start = std::clock();
  const Domain domain = Domain::create_labeled_image_mesh_domain(image);
  namespace p = CGAL::parameters;
  const Criteria criteria(p::facet_angle = 30, p::facet_size = h, p::facet_distance = h * 4 / 6,
                          p::cell_radius_edge_ratio = 3, p::cell_size = h * 8 / 6);
  const Complex mesh = CGAL::make_mesh_3<Complex>(domain, criteria);
  std::cout << "meshing CPU seconds: " << static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC << "\n";
  std::ofstream out(argv[2]);
  out.precision(17);
  mesh.output_to_medit(out);
  return out ? 0 : 5;
}
