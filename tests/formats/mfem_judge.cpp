// What MFEM makes of a mesh file, as JSON: of its elements and boundary by attribute how many, and volumes and areas by
// MFEM's own quadrature, the least determinant of the Jacobian at many points, names of attributes, and orders.
//   mfem_judge FILE [SAVED [KIND]]
// With SAVED what MFEM saves goes there: as it is, or with nodes of KIND: H1, L2 (MFEM's usual ones) or a collection's
// name, and what is told is of these.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <mfem.hpp>
#include <string>

namespace {

struct Measure {
  int elements = 0;
  double measure = 0, vector = 0;  ///< volume or area; the length of the sum of normals of each face
};
using Measures = std::map<int, Measure>;

/// By a rule that is exact for the determinant of the Jacobian: MFEM's own GetElementVolume() takes one that is not.
double volume_by_rule(mfem::Mesh& mesh, int element) {
  mfem::ElementTransformation& place = *mesh.GetElementTransformation(element);
  const mfem::IntegrationRule& rule = mfem::IntRules.Get(mesh.GetElementGeometry(element), place.OrderW() + 2);
  double sum = 0;
  for (int i = 0; i < rule.GetNPoints(); ++i) {
    place.SetIntPoint(&rule.IntPoint(i));
    sum += rule.IntPoint(i).weight * place.Jacobian().Det();
  }
  return sum;
}

double least_jacobian(mfem::Mesh& mesh, int element) {
  mfem::ElementTransformation& place = *mesh.GetElementTransformation(element);
  const mfem::RefinedGeometry& fine = *mfem::GlobGeometryRefiner.Refine(mesh.GetElementGeometry(element), 8);
  double least = 1e300;
  for (int i = 0; i < fine.RefPts.GetNPoints(); ++i) {
    place.SetIntPoint(&fine.RefPts.IntPoint(i));
    least = std::min(least, place.Jacobian().Det());
  }
  return least;
}

Measure face(mfem::ElementTransformation& place, mfem::Geometry::Type kind) {
  const mfem::IntegrationRule& rule = mfem::IntRules.Get(kind, 16);
  mfem::Vector normal(3), sum(3);
  sum = 0.0;
  Measure found{1, 0, 0};
  for (int i = 0; i < rule.GetNPoints(); ++i) {
    place.SetIntPoint(&rule.IntPoint(i));
    mfem::CalcOrtho(place.Jacobian(), normal);
    sum.Add(rule.IntPoint(i).weight, normal);
    found.measure += rule.IntPoint(i).weight * normal.Norml2();
  }
  found.vector = sum.Norml2();
  return found;
}

void add(Measure& to, const Measure& more) {
  to.elements += more.elements, to.measure += more.measure, to.vector += more.vector;
}

std::string json(const Measures& all) {
  std::string text;
  for (const auto& [attribute, m] : all) {
    char line[160];
    std::snprintf(line, sizeof line, "%s\"%d\": {\"size\": %d, \"measure\": %.17g, \"vector\": %.17g}",
                  text.empty() ? "" : ", ", attribute, m.elements, m.measure, m.vector);
    text += line;
  }
  return "{" + text + "}";
}

std::string json(const mfem::AttributeSets& sets) {
  std::string text;
  for (const std::string& name : sets.GetAttributeSetNames()) {
    std::string quoted;
    for (const char c : name) quoted += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    text += (text.empty() ? "\"" : ", \"") + quoted + "\": [";
    std::string comma;
    for (const int a : sets.GetAttributeSet(name)) text += comma + std::to_string(a), comma = ", ";
    text += "]";
  }
  return "{" + text + "}";
}

/// With the mesh's nodes interpolated into another space.
void change_nodes(mfem::Mesh& mesh, const std::string& kind) {
  const int order = mesh.GetNodes() ? mesh.GetNodalFESpace()->GetMaxElementOrder() : 1;
  if (kind == "H1" || kind == "L2") return mesh.SetCurvature(order, kind == "L2");
  mfem::FiniteElementCollection* const elements = mfem::FiniteElementCollection::New(kind.c_str());
  auto* const space = new mfem::FiniteElementSpace(&mesh, elements, 3, mfem::Ordering::byNODES);
  auto* const nodes = new mfem::GridFunction(space);
  nodes->MakeOwner(elements);
  mesh.EnsureNodes();
  mfem::VectorGridFunctionCoefficient places(mesh.GetNodes());
  nodes->ProjectCoefficient(places);
  mesh.NewNodes(*nodes, true);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  mfem::Mesh mesh(argv[1]);
  if (argc > 3) change_nodes(mesh, argv[3]);
  Measures regions, patches;
  double volume = 0, area = 0, least = 1e300, of_regular = 1e300;
  for (int e = 0; e < mesh.GetNE(); ++e) {
    const double own = volume_by_rule(mesh, e), jacobian = least_jacobian(mesh, e);
    add(regions[mesh.GetAttribute(e)], {1, own, 0});
    volume += own;
    least = std::min(least, jacobian);
    of_regular = std::min(of_regular, jacobian / (own / mfem::Geometry::Volume[mesh.GetElementGeometry(e)]));
  }
  for (int f = 0; f < mesh.GetNBE(); ++f) {
    const Measure found = face(*mesh.GetBdrElementTransformation(f), mesh.GetBdrElementGeometry(f));
    add(patches[mesh.GetBdrAttribute(f)], found);
    area += found.measure;
  }
  const int order = mesh.GetNodes() ? mesh.GetNodalFESpace()->GetMaxElementOrder() : 1;
  const int nodes = mesh.GetNodes() ? mesh.GetNodalFESpace()->GetNDofs() : mesh.GetNV();
  std::printf(
      "{\"order\": %d, \"space\": \"%s\", \"nodes\": %d, \"elements\": %d, \"boundary\": %d, \"volume\": %.17g, "
      "\"area\": "
      "%.17g, \"least_jacobian\": %.9g, \"least_of_mean\": %.9g, \"regions\": %s, \"patches\": %s, \"names\": %s, "
      "\"boundary_names\": %s}\n",
      order, mesh.GetNodes() ? mesh.GetNodalFESpace()->FEColl()->Name() : "", nodes, mesh.GetNE(), mesh.GetNBE(),
      volume, area, least, of_regular, json(regions).c_str(), json(patches).c_str(), json(mesh.attribute_sets).c_str(),
      json(mesh.bdr_attribute_sets).c_str());
  if (argc > 2) {
    std::ofstream saved(argv[2]);
    saved.precision(16);
    mesh.Print(saved);
  }
  return least > 0 ? 0 : 1;
}
