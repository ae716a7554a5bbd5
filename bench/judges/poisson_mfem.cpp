// Poisson's equation with a known solution, solved by MFEM on a mesh of any order that MFEM reads itself (Gmsh 2.2);
// the error in L2, as JSON. As poisson_dolfinx.py, where the solutions are explained.
//   poisson_mfem CASE MESH.msh ORDER

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mfem.hpp>
#include <string>

namespace {

constexpr double kPi = 3.14159265358979323846;

double ball(const mfem::Vector& x) {
  return (1 - x * x) * std::exp(x(0));
}
/// -div grad: e^x has all its derivatives, 1 - r^2 has -2 x along x, and -6 as its own.
double load_of_ball(const mfem::Vector& x) {
  return -(1 - x * x - 4 * x(0) - 6) * std::exp(x(0));
}

double hole(const mfem::Vector& x) {
  return (x(0) - 2) * (x(0) - 2) + (x(1) - 2) * (x(1) - 2) - 1;
}
double waves(const mfem::Vector& x) {
  return std::sin(kPi * x(0) / 4) * std::sin(kPi * x(1) / 4) * std::sin(kPi * x(2));
}
double plate(const mfem::Vector& x) {
  return waves(x) * hole(x);
}
double load_of_plate(const mfem::Vector& x) {
  const double in_z = std::sin(kPi * x(2)), quarter = kPi / 4;
  const double along_x = quarter * std::cos(quarter * x(0)) * std::sin(quarter * x(1)) * in_z;
  const double along_y = quarter * std::sin(quarter * x(0)) * std::cos(quarter * x(1)) * in_z;
  const double squares = 2 * quarter * quarter + kPi * kPi;
  return squares * waves(x) * hole(x) - 4 * (along_x * (x(0) - 2) + along_y * (x(1) - 2)) - 4 * waves(x);
}

}  // namespace

int main(int, char** argv) {
  const bool is_ball = std::string(argv[1]) == "ball";
  const int order = std::atoi(argv[3]);
  mfem::Mesh mesh(argv[2]);
  mfem::H1_FECollection elements(order, 3);
  mfem::FiniteElementSpace space(&mesh, &elements);
  mfem::Array<int> walls(mesh.bdr_attributes.Max()), fixed;
  walls = 1;
  space.GetEssentialTrueDofs(walls, fixed);

  mfem::FunctionCoefficient exact(is_ball ? ball : plate), load(is_ball ? load_of_ball : load_of_plate);
  mfem::ConstantCoefficient one(1), zero(0);
  const mfem::IntegrationRule& rule = mfem::IntRules.Get(mfem::Geometry::TETRAHEDRON, 2 * order + 3);
  mfem::LinearForm right(&space);
  auto* loads = new mfem::DomainLFIntegrator(load);
  loads->SetIntRule(&rule);
  right.AddDomainIntegrator(loads);
  right.Assemble();
  mfem::BilinearForm form(&space);
  auto* stiffness = new mfem::DiffusionIntegrator(one);
  stiffness->SetIntRule(&rule);
  form.AddDomainIntegrator(stiffness);
  form.Assemble();

  mfem::GridFunction found(&space);
  found = 0.0;
  mfem::OperatorPtr matrix;
  mfem::Vector b, x;
  form.FormLinearSystem(fixed, found, right, matrix, x, b);
  mfem::GSSmoother smoother(static_cast<mfem::SparseMatrix&>(*matrix));
  mfem::PCG(*matrix, smoother, b, x, 0, 5000, 1e-24, 0.0);
  form.RecoverFEMSolution(x, right, found);

  const mfem::IntegrationRule* rules[mfem::Geometry::NumGeom] = {};
  rules[mfem::Geometry::TETRAHEDRON] = &rule;
  mfem::GridFunction nothing(&space);
  nothing = 0.0;
  double volume = 0;
  for (int e = 0; e < mesh.GetNE(); ++e) {
    // MFEM's own GetElementVolume() takes a rule that is too low for curved elements.
    mfem::ElementTransformation& place = *mesh.GetElementTransformation(e);
    for (int i = 0; i < rule.GetNPoints(); ++i) {
      place.SetIntPoint(&rule.IntPoint(i));
      volume += rule.IntPoint(i).weight * place.Weight();
    }
  }
  std::printf(
      "{\"order\": %d, \"elements\": %d, \"unknowns\": %d, \"volume\": %.16g, \"error\": %.9g, \"of\": %.9g, \"cpu\": "
      "%.2f}\n",
      order, mesh.GetNE(), space.GetTrueVSize(), volume, found.ComputeL2Error(exact, rules),
      nothing.ComputeL2Error(exact, rules), double(std::clock()) / CLOCKS_PER_SEC);
  return mesh.GetNodalFESpace() ? mesh.GetNodalFESpace()->GetMaxElementOrder() != order : order != 1;
}
