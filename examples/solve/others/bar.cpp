// The bar of ../solve.py with deal.II: bar MESH ORDER STEEL, the last the number of that region in the mesh file.
// deal.II refuses numbers on faces between regions, so it gets cells alone (--cells-only), and sides by where they lie.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>

using namespace dealii;

namespace {

class Exact : public Function<3> {
 public:
  Exact() : Function<3>(3) {}
  double value(const Point<3>& p, unsigned int axis) const override {
    return axis == 0 ? 5e-4 * std::min(p[0], 30.) + 2e-3 * std::max(p[0] - 30., 0.) : -1.5e-4 * p[axis];
  }
};

enum Side : types::boundary_id { kFree, kFixed, kPulled, kPlaneY, kPlaneZ };

void mark_sides(Triangulation<3>& mesh) {
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const Point<3> at = face->center();
      face->set_boundary_id(at[0] < 1e-9        ? kFixed
                            : at[0] > 50 - 1e-9 ? kPulled
                            : at[1] < 1e-9      ? kPlaneY
                            : at[2] < 1e-9      ? kPlaneZ
                                                : kFree);
    }
}

void assemble(const DoFHandler<3>& dofs, const Mapping<3>& mapping, const AffineConstraints<double>& supports,
              types::material_id steel, unsigned int order, SparseMatrix<double>& matrix, Vector<double>& load) {
  const QGaussSimplex<3> inside(order + 1);
  const QGaussSimplex<2> on_face(order + 1);
  FEValues<3> values(mapping, dofs.get_fe(), inside, update_gradients | update_JxW_values);
  FEFaceValues<3> faces(mapping, dofs.get_fe(), on_face, update_values | update_JxW_values);
  const FEValuesExtractors::Vector u(0);
  const unsigned int n = dofs.get_fe().n_dofs_per_cell();
  FullMatrix<double> local(n, n);
  Vector<double> pull(n);
  std::vector<types::global_dof_index> index(n);
  for (const auto& cell : dofs.active_cell_iterators()) {
    values.reinit(cell);
    local = 0;
    pull = 0;
    const bool is_steel = cell->material_id() == steel;
    const double young = is_steel ? 200000 : 50000, poisson = is_steel ? .3 : .075;
    const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    for (const unsigned int q : values.quadrature_point_indices())
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          local(i, j) += (lambda * values[u].divergence(i, q) * values[u].divergence(j, q) +
                          2 * mu * (values[u].symmetric_gradient(i, q) * values[u].symmetric_gradient(j, q))) *
                         values.JxW(q);
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary() || face->boundary_id() != kPulled) continue;
      faces.reinit(cell, face);
      for (const unsigned int q : faces.quadrature_point_indices())
        for (unsigned int i = 0; i < n; ++i) pull(i) += 100 * faces[u].value(i, q)[0] * faces.JxW(q);
    }
    cell->get_dof_indices(index);
    supports.distribute_local_to_global(local, pull, index, matrix, load);
  }
}

}  // namespace

int main(int, char** given) {
  const unsigned int order = std::atoi(given[2]);
  Triangulation<3> mesh;
  GridIn<3> reader(mesh);
  std::ifstream file(given[1]);
  reader.read_msh(file);
  mark_sides(mesh);

  const FESystem<3> element(FE_SimplexP<3>(order), 3);
  const MappingFE<3> mapping(FE_SimplexP<3>(1));
  DoFHandler<3> dofs(mesh);
  dofs.distribute_dofs(element);
  AffineConstraints<double> supports;
  const auto hold = [&](types::boundary_id side, unsigned int axis) {
    ComponentMask mask(3, false);
    mask.set(axis, true);
    DoFTools::make_zero_boundary_constraints(dofs, side, supports, mask);
  };
  hold(kFixed, 0);
  hold(kPlaneY, 1);
  hold(kPlaneZ, 2);
  supports.close();
  DynamicSparsityPattern graph(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, graph, supports, false);
  SparsityPattern pattern;
  pattern.copy_from(graph);
  SparseMatrix<double> matrix(pattern);
  Vector<double> load(dofs.n_dofs()), moved(dofs.n_dofs());
  assemble(dofs, mapping, supports, static_cast<types::material_id>(std::atoi(given[3])), order, matrix, load);
  SparseDirectUMFPACK solver;
  solver.initialize(matrix);
  solver.vmult(moved, load);
  supports.distribute(moved);

  Vector<double> exact(dofs.n_dofs());
  VectorTools::interpolate(mapping, dofs, Exact(), exact);
  exact -= moved;
  // The mean of the pulled face.
  const QGaussSimplex<2> on_face(order + 1);
  FEFaceValues<3> faces(mapping, element, on_face, update_values | update_JxW_values);
  double sum = 0, area = 0;
  std::vector<Tensor<1, 3>> at(on_face.size());
  for (const auto& cell : dofs.active_cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary() || face->boundary_id() != kPulled) continue;
      faces.reinit(cell, face);
      faces[FEValuesExtractors::Vector(0)].get_function_values(moved, at);
      for (const unsigned int q : faces.quadrature_point_indices())
        sum += at[q][0] * faces.JxW(q), area += faces.JxW(q);
    }
  std::printf("found %u %.12g %.6g\n", mesh.n_active_cells(), sum / area, exact.linfty_norm());
}
