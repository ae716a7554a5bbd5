#include <octafront/error.h>
#include <octafront/formula.h>

#include "images/formulas/formulas.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

double value(const std::string& text, Vec3 p = {0.3, -0.7, 1.9}, double period = 1) {
  return Formula(text, period).at(p);
}

TEST(Formula, FollowsTheRulesOfArithmetic) {
  EXPECT_EQ(value("1 + 2 * 3"), 7);
  EXPECT_EQ(value("(1 + 2) * 3"), 9);
  EXPECT_EQ(value("2 ^ 3 ^ 2"), 512);
  EXPECT_EQ(value("2 ** 3"), 8);
  EXPECT_EQ(value("-2 ^ 2"), -4);
  EXPECT_EQ(value("2 ^ -1"), 0.5);
  EXPECT_EQ(value("1 - 2 - 3"), -4);
  EXPECT_EQ(value("8 / 4 / 2"), 1);
  EXPECT_EQ(value("1e3 + .5"), 1000.5);
  EXPECT_EQ(value("mod(-1, 3)"), 2);
  EXPECT_EQ(value("min(3, 1, 2) + max(3, 1, 2, 5)"), 6);
  EXPECT_EQ(value("x + 10 * y", {1, 2, 0}), 21);
  EXPECT_EQ(value("L * 2", {}, 5), 10);
}

TEST(Formula, TakesFurtherVariables) {
  const Formula law("rho ^ 2 + x * HU", 1, {"HU", "rho"});
  EXPECT_EQ(law.at({2, 0, 0}, std::array{10.0, 3.0}), 29);
  EXPECT_THROW(Formula("rho", 1, {"HU"}), OptionError);
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
  mesh.tets = {{0, 1, 2, 3}};
  const std::vector<MeshField> fields{{"HU", true, 1, {5}}, {"HU", false, 1, {1, 2, 3, 4}}};
  EXPECT_EQ(field_by_formula(mesh, "E", "HU + x", fields, true).values, (std::vector<double>{6}));
  EXPECT_EQ(field_by_formula(mesh, "E", "HU + x", fields, false).values, (std::vector<double>{1, 6, 3, 4}));
  EXPECT_THROW(field_by_formula(mesh, "E", "log(HU - 2)", fields, false), OptionError);
}

TEST(Formula, KnowsFunctions) {
  const Vec3 p{0.3, -0.7, 1.9};
  EXPECT_NEAR(value("sin(x) * cos(y) + tan(z)", p), std::sin(p.x) * std::cos(p.y) + std::tan(p.z), 1e-14);
  EXPECT_NEAR(value("exp(x) + log(z) + sqrt(z)", p), std::exp(p.x) + std::log(p.z) + std::sqrt(p.z), 1e-14);
  EXPECT_NEAR(value("abs(y) + atan2(y, x)", p), 0.7 + std::atan2(p.y, p.x), 1e-14);
  EXPECT_NEAR(value("hypot(x, y, z)", p), length(p), 1e-14);
  EXPECT_NEAR(value("pow(z, 1.5) + z ^ .5", p), std::pow(p.z, 1.5) + std::sqrt(p.z), 1e-13);
  EXPECT_TRUE(std::isnan(value("sqrt(y)", p)));
  EXPECT_NEAR(value("sin(x)", {1e7, 0, 0}), std::sin(1e7), 1e-8);
}

TEST(Formula, KnowsSurfacesThatRepeatThemselves) {
  const Vec3 p{0.13, 0.27, 0.41};
  const double t = 2 * std::numbers::pi, X = t * p.x, Y = t * p.y, Z = t * p.z;
  EXPECT_NEAR(value("gyroid", p), std::sin(X) * std::cos(Y) + std::sin(Y) * std::cos(Z) + std::sin(Z) * std::cos(X),
              1e-14);
  EXPECT_NEAR(value("schwarz_p(x, y, z)", p), std::cos(X) + std::cos(Y) + std::cos(Z), 1e-14);
  EXPECT_EQ(value("gyroid(x, y, z)", p), value("gyroid", p));
  EXPECT_NEAR(value("gyroid(y, z, x)", p), value("gyroid", p), 1e-14);
  for (const char* name : {"gyroid", "schwarz_p", "diamond", "iwp", "neovius", "lidinoid", "fischer_koch_s", "split_p"})
    for (const Vec3 step : {Vec3{3, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 3}})
      EXPECT_NEAR(value(name, p, 3), value(name, p + step, 3), 1e-13) << name;
}

TEST(Formula, ComparisonsSayWhereTheBodyIs) {
  EXPECT_EQ(value("x < 2", {1, 0, 0}), -1);
  EXPECT_EQ(value("x > 2", {1, 0, 0}), 1);
  EXPECT_EQ(value("abs(x) <= 2", {-3, 0, 0}), 1);
}

/// What is wrong, and at which character.
void refused(const std::string& text, std::size_t at, const std::string& words) {
  try {
    Formula formula(text);
    FAIL() << text;
  } catch (const OptionError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("at character " + std::to_string(at) + ":"), std::string::npos) << what;
    EXPECT_NE(what.find(words), std::string::npos) << what;
  }
}

TEST(Formula, SaysWhatItDoesNotUnderstandAndWhere) {
  refused("x + ", 5, "ends where");
  refused("x + * 2", 5, "stands where");
  refused("(x + 1", 7, "not closed");
  refused("x + 1)", 6, "does not belong");
  refused("gyriod(x, y, z)", 1, "there is no \"gyriod\"");
  refused("1 + gyroid(x, y)", 5, "three coordinates");
  refused("sin(x, y)", 1, "takes 1 argument");
  refused("min(x)", 1, "takes 2 or more");
  refused("sin x", 5, "parentheses");
  refused("x $ y", 3, "\"$\"");
  refused("x < y < z", 7, "does not belong");
  refused(std::string(500, '(') + "x" + std::string(500, ')'), 101, "nested");
  EXPECT_THROW(Formula("gyroid", 0), OptionError);
  EXPECT_THROW(Formula("gyroid", -2), OptionError);
}

TEST(Formula, IsToldFromNamesOfFiles) {
  for (const char* text : {"gyroid", "gyroid(x,y,z) - 0.3", "x^2 + y^2 + z^2 - 1", "abs(gyroid) < .3", "gyroid - .3"})
    EXPECT_TRUE(is_formula(text)) << text;
  for (const char* text :
       {"part.stl", "x.stl", "no such file", "scan-x-y.ply", "", "-", "folder/x", "3 + 4", "a+b.step"})
    EXPECT_FALSE(is_formula(text)) << text;
}

TEST(NearestZero, IsWhereTheFunctionIsZeroUpToRounding) {
  const formulas::FormulaFunction sphere(Formula("x^2 + y^2 + z^2 - 4"), 1e-4);
  for (const Vec3 p : {Vec3{1.8, 0.3, -0.4}, Vec3{0.1, 2.3, 0}, Vec3{-1.2, -1.2, 1.2}}) {
    const Vec3 on = formulas::nearest_zero(sphere, p, 0, 1);
    EXPECT_NEAR(length(on), 2, 1e-14);
    EXPECT_LT(distance(on, p / length(p) * 2), 0.02);
    const Vec3 in_plane = formulas::nearest_zero(sphere, p, 1, 1);
    EXPECT_EQ(in_plane.x, p.x);
    EXPECT_NEAR(length(in_plane), 2, 1e-14);
  }
  EXPECT_EQ(formulas::nearest_zero(sphere, {0, 0, 0}, 0, 0.5), (Vec3{0, 0, 0}));
}

TEST(SampledSpace, FollowsQuadraticsExactlyInside) {
  SampledFunction samples{{{0, 0, 0}, {2, 1, 1}}, {8, 5, 4}, {}};
  const auto f = [](Vec3 p) { return 1 + p.x * p.x - 2 * p.y * p.z + 0.5 * p.z * p.z - p.x; };
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 10; ++i) samples.values.push_back(f({(i - 0.5) * 0.25, (j - 0.5) * 0.2, (k - 0.5) * 0.25}));
  const formulas::SampledSpace space(samples);
  for (const Vec3 p : {Vec3{0.7, 0.5, 0.4}, Vec3{1.3, 0.31, 0.55}, Vec3{1, 0.6, 0.5}}) {
    EXPECT_NEAR(space.at(p), f(p), 1e-12);
    const Vec3 gradient = space.gradient(p);
    EXPECT_NEAR(gradient.x, 2 * p.x - 1, 1e-12);
    EXPECT_NEAR(gradient.y, -2 * p.z, 1e-12);
    EXPECT_NEAR(gradient.z, -2 * p.y + p.z, 1e-12);
  }
}

}  // namespace
}  // namespace octafront
