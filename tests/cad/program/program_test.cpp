#include "compressed.h"
#include "reader.h"
#include "shapes.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <regex>

#include <gtest/gtest.h>

namespace octafront::testing {

namespace {

using cad::CadModel;
using cad::SurfaceRecord;

const std::string kFine = "triangulate 0.01 0.25\n";

class CadProgram : public ::testing::Test {
 protected:
  std::string written(const std::string& shape, const std::string& ending, const std::string& unit = "MM") const {
    const std::string file = folder_ / (shape + ending);
    write_shape(shape_named(shape), file, unit);
    return file;
  }

  static CadModel model_of_file(const std::string& file, const std::vector<std::string>& options = {}) {
    const Answer answer = run_reader(file, options, kFine);
    EXPECT_EQ(answer.models.size(), 1u) << file << (answer.errors.empty() ? "" : answer.errors[0]);
    return answer.models.empty() ? CadModel{} : answer.models[0];
  }

  const testing::TemporaryFolder folder_;
};

double volume_behind(const CadModel& m, std::uint32_t solid) {
  double sum = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const Sides& sides = m.faces[m.face_of[t]].sides;
    const Triangle& c = m.triangles[t];
    const double six = dot(m.points[c[0]], cross(m.points[c[1]], m.points[c[2]]));
    sum += six / 6 * ((sides[1] == solid ? 1 : 0) - (sides[0] == solid ? 1 : 0));
  }
  return sum;
}

/// How many edges of the solid's triangles have not exactly one triangle on each side.
int open_edges(const CadModel& m, std::uint32_t solid) {
  std::map<std::array<VertexIndex, 2>, int> ways;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const Sides& sides = m.faces[m.face_of[t]].sides;
    const Triangle& c = m.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (sides[1] == solid) ++ways[{c[k], c[(k + 1) % 3]}];
      if (sides[0] == solid) ++ways[{c[(k + 1) % 3], c[k]}];
    }
  }
  int open = 0;
  for (const auto& [edge, n] : ways) {
    const auto back = ways.find({edge[1], edge[0]});
    open += n != 1 || back == ways.end() || back->second != 1;
  }
  return open;
}

TEST_F(CadProgram, SolidsOfAllKindsAreClosedAndKeepTheirVolume) {
  for (const std::string shape : {"box", "cylinder", "cone", "sphere", "torus", "revolved", "extruded", "filleted"})
    for (const std::string ending : {".step", ".brep", ".igs"}) {
      SCOPED_TRACE(shape + ending);
      const CadModel m = model_of_file(written(shape, ending));
      ASSERT_EQ(m.solids.size(), 1u);
      EXPECT_TRUE(m.solids[0].closed);
      EXPECT_EQ(open_edges(m, 0), 0);
      EXPECT_NEAR(volume_behind(m, 0), m.solids[0].volume, 5e-3 * m.solids[0].volume);
      if (const double known = volume_of_shape(shape); known > 0) {
        EXPECT_NEAR(m.solids[0].volume, known, 1e-6 * known);
      }
      for (const cad::Face& face : m.faces) {
        EXPECT_NE(face.surface.kind, SurfaceRecord::Kind::kNone);
        EXPECT_EQ(face.sides, (Sides{kNone, 0}));
        EXPECT_EQ(face.triangles, cad::Face::Triangles::kAsAsked);
      }
      for (const cad::CadEdge& edge : m.edges) {
        EXPECT_NE(edge.curve.kind, cad::CurveRecord::Kind::kNone);
        EXPECT_TRUE(std::is_sorted(edge.parameters.begin(), edge.parameters.end()));
      }
    }
}

TEST_F(CadProgram, AnalyticRecordsPassThroughTheCorners) {
  const CadModel m = model_of_file(written("sphere", ".step"));
  ASSERT_EQ(m.faces.size(), 1u);
  const SurfaceRecord& s = m.faces[0].surface;
  ASSERT_EQ(s.kind, SurfaceRecord::Kind::kSphere);
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const cad::Uv at = m.corners[t][k];
      const Vec3 on = s.frame.origin +
                      (s.frame.x * std::cos(at.u) + s.frame.y * std::sin(at.u)) * (s.radius * std::cos(at.v)) +
                      s.frame.z * (s.radius * std::sin(at.v));
      EXPECT_LT(distance(on, m.points[m.triangles[t][k]]), 1e-7);
    }
  const auto seams = std::count_if(m.edges.begin(), m.edges.end(), [](const auto& e) { return e.is_seam; });
  EXPECT_EQ(seams, 1);
}

TEST_F(CadProgram, FilletsAreSmoothAndBoxesAreNot) {
  for (const cad::CadEdge& edge : model_of_file(written("box", ".step")).edges) EXPECT_FALSE(edge.is_smooth);
  for (const cad::CadEdge& edge : model_of_file(written("filleted", ".step")).edges) EXPECT_TRUE(edge.is_smooth);
}

TEST_F(CadProgram, UnitsComeToMillimetres) {
  for (const std::string ending : {".step", ".igs"}) {
    const Answer answer = run_reader(written("box", ending, "INCH"), {}, "end\n");
    ASSERT_TRUE(answer.opened) << ending;
    EXPECT_EQ(answer.opened->model.unit, "inch");
    EXPECT_NEAR(answer.opened->model.to_millimetres, 25.4, 1e-12);
    EXPECT_NEAR(answer.opened->hi.x - answer.opened->lo.x, 10, 1e-6);
  }
  const Answer answer = run_reader(written("box", ".brep"), {}, "end\n");
  ASSERT_TRUE(answer.opened);
  EXPECT_EQ(answer.opened->model.unit, "");
  EXPECT_EQ(answer.opened->model.to_millimetres, 1);
}

TEST_F(CadProgram, TouchingSolidsShareAFace) {
  const CadModel m = model_of_file(written("touching", ".brep"));
  ASSERT_EQ(m.solids.size(), 2u);
  EXPECT_TRUE(m.fused);
  const auto shared = std::count_if(m.faces.begin(), m.faces.end(),
                                    [](const cad::Face& f) { return f.sides[0] != kNone && f.sides[1] != kNone; });
  EXPECT_EQ(shared, 1);
  EXPECT_NEAR(volume_behind(m, 0), 1000, 1e-9);
  EXPECT_NEAR(volume_behind(m, 1), 125, 1e-9);
  EXPECT_EQ(open_edges(m, 0) + open_edges(m, 1), 0);
  EXPECT_FALSE(model_of_file(written("touching", ".brep"), {"--no-fuse"}).fused);
}

TEST_F(CadProgram, WithoutTrianglesFacesAndEdgesAreKnown) {
  const Answer answer = run_reader(written("fitted", ".step"), {}, "end\n");
  ASSERT_TRUE(answer.opened);
  const CadModel& m = answer.opened->model;
  EXPECT_TRUE(m.triangles.empty());
  std::size_t cylinders = 0;
  for (const cad::Face& face : m.faces) {
    const bool is_contact = face.sides[0] != kNone && face.sides[1] != kNone;
    EXPECT_EQ(face.piece != kNone, is_contact);
    cylinders += face.surface.kind == SurfaceRecord::Kind::kCylinder;
    EXPECT_LT(face.low.u, face.high.u);
  }
  EXPECT_GE(cylinders, 1u);
  EXPECT_TRUE(std::ranges::all_of(m.edges, [](const cad::CadEdge& e) { return !e.faces.empty() && e.length > 0; }));
  ASSERT_EQ(m.shared.size(), 1u);
  EXPECT_EQ(m.shared[0].solids, (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_NEAR(m.shared[0].depth, 0.01, 1e-3);
}

TEST_F(CadProgram, OverlapIsRefusedWithItsVolume) {
  const std::string file = written("overlapping", ".brep");
  const Answer answer = run_reader(file, {}, kFine);
  ASSERT_EQ(answer.errors.size(), 1u);
  EXPECT_NE(answer.errors[0].find("solid 1 and solid 2 overlap in 50 mm^3"), std::string::npos) << answer.errors[0];
  EXPECT_EQ(model_of_file(file, {"--no-fuse"}).solids.size(), 2u);
}

TEST_F(CadProgram, OverlapGoesWhereItIsAsked) {
  // Boxes of 1000 and 125 that share 50.
  const std::string file = written("overlapping", ".brep");
  const std::map<std::string, std::vector<double>> volumes = {
      {"first", {1000, 75}}, {"later", {950, 125}}, {"new", {950, 75, 50}}, {"tell", {1000, 125}}};
  for (const auto& [word, expected] : volumes) {
    SCOPED_TRACE(word);
    const CadModel m = model_of_file(file, {"--overlap", word});
    ASSERT_EQ(m.solids.size(), expected.size());
    EXPECT_EQ(m.fused, word != "tell");
    ASSERT_EQ(m.notes.size(), 1u);
    EXPECT_NE(m.notes[0].find("solid 1 and solid 2 overlap in 50 mm^3"), std::string::npos) << m.notes[0];
    for (std::uint32_t s = 0; s < expected.size(); ++s) {
      EXPECT_NEAR(m.solids[s].volume, expected[s], 1e-9);
      EXPECT_NEAR(volume_behind(m, s), expected[s], 1e-9);
      EXPECT_EQ(open_edges(m, s), 0);
    }
  }
  EXPECT_EQ(model_of_file(file, {"--overlap", "new"}).solids[2].labels.name, "solid 1&solid 2");
  EXPECT_EQ(run_reader(file, {"--overlap", "both"}, kFine).status, 2);
}

TEST_F(CadProgram, OverlapOfThreeIsEachPairs) {
  const std::string file = written("three", ".brep");
  const Answer refused = run_reader(file, {}, kFine);
  ASSERT_EQ(refused.errors.size(), 1u);
  for (const char* pair : {"solid 1 and solid 2 overlap in 500", "solid 2 and solid 3 overlap in 700",
                           "solid 1 and solid 3 overlap in 200"})
    EXPECT_NE(refused.errors[0].find(pair), std::string::npos) << refused.errors[0];
  const CadModel apart = model_of_file(file, {"--overlap", "new"});
  std::map<std::string, double> volumes;
  for (const cad::Solid& solid : apart.solids) volumes[solid.labels.name] += solid.volume;
  // The three together fill 18 x 10 x 10.
  double sum = 0;
  for (const auto& [name, volume] : volumes) sum += volume;
  EXPECT_NEAR(sum, 1800, 1e-9);
  EXPECT_NEAR(volumes["solid 1&solid 2&solid 3"], 200, 1e-9);
  const CadModel first = model_of_file(file, {"--overlap", "first"});
  ASSERT_EQ(first.solids.size(), 3u);
  EXPECT_NEAR(first.solids[0].volume, 1000, 1e-9);
  EXPECT_NEAR(first.solids[1].volume, 500, 1e-9);
  EXPECT_NEAR(first.solids[2].volume, 300, 1e-9);
}

TEST_F(CadProgram, NothingLeftOfASolidIsRefused) {
  const std::string file = written("within", ".brep");
  const Answer answer = run_reader(file, {"--overlap", "first"}, kFine);
  ASSERT_EQ(answer.errors.size(), 1u);
  EXPECT_NE(answer.errors[0].find("nothing is left of solid 2"), std::string::npos) << answer.errors[0];
  const CadModel later = model_of_file(file, {"--overlap", "later"});
  ASSERT_EQ(later.solids.size(), 2u);
  EXPECT_NEAR(volume_behind(later, 0), 875, 1e-9);
  EXPECT_NEAR(volume_behind(later, 1), 125, 1e-9);
  const CadModel apart = model_of_file(file, {"--overlap", "new"});
  ASSERT_EQ(apart.solids.size(), 2u);
  EXPECT_EQ(apart.solids[1].labels.name, "solid 1&solid 2");
}

TEST_F(CadProgram, WhoOverlapsByNextToNothingTouches) {
  const CadModel m = model_of_file(written("nearly", ".brep"));
  ASSERT_EQ(m.solids.size(), 2u);
  EXPECT_TRUE(m.fused);
  EXPECT_NEAR(m.solids[0].volume + m.solids[1].volume, 1125 - 25e-6, 1e-7);
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_NE(m.notes[0].find("is how they touch"), std::string::npos) << m.notes[0];
}

TEST_F(CadProgram, AFitIsAContact) {
  const std::string file = written("fitted", ".step");
  const CadModel m = model_of_file(file);
  ASSERT_EQ(m.solids.size(), 2u);
  EXPECT_TRUE(m.fused);
  const double pin = M_PI * 3.01 * 3.01 * 4;
  EXPECT_NEAR(m.solids[1].volume, pin, 1e-4 * pin);
  EXPECT_NEAR(m.solids[0].volume + m.solids[1].volume, 1600, 1e-2);
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_NE(m.notes[0].find("0.01 mm deep at most, is how they touch, and the later one has it"), std::string::npos)
      << m.notes[0];
  // Who says who gets what they share means fits, too.
  EXPECT_NEAR(model_of_file(file, {"--overlap", "first"}).solids[0].volume, 1600 - M_PI * 36, 1e-2);
}

TEST_F(CadProgram, WhatIsThinnerThanTheToleranceIsAContact) {
  // Boxes that share a layer of 2.
  const std::string file = written("overlapping", ".brep");
  EXPECT_TRUE(run_reader(file, {"--tolerance", "0.5"}, kFine).models.empty());
  const CadModel m = model_of_file(file, {"--tolerance", "2"});
  ASSERT_EQ(m.solids.size(), 2u);
  EXPECT_NEAR(m.solids[0].volume, 950, 1e-9);
  EXPECT_NEAR(m.solids[1].volume, 125, 1e-9);
}

TEST_F(CadProgram, TinyShapesAreScaledUp) {
  const CadModel m = run_reader(written("tiny", ".brep"), {}, "triangulate 1e-3 0.25\n").models.at(0);
  EXPECT_EQ(m.per_millimetre, 1000);
  ASSERT_EQ(m.solids.size(), 1u);
  EXPECT_EQ(open_edges(m, 0), 0);
  const double volume = (100 * 50 - M_PI * 100) * 20 * 1e-9;
  EXPECT_NEAR(m.solids[0].volume, volume, 1e-5 * volume);
  EXPECT_NEAR(volume_behind(m, 0), volume, 1e-2 * volume);
}

TEST_F(CadProgram, TangentContactIsRefusedWithItsPlace) {
  const std::string file = written("groove", ".brep");
  const Answer answer = run_reader(file, {}, kFine);
  ASSERT_EQ(answer.errors.size(), 1u);
  EXPECT_NE(answer.errors[0].find("solid 1 and solid 2 touch along lines where their faces are tangent"),
            std::string::npos)
      << answer.errors[0];
  EXPECT_EQ(model_of_file(file, {"--overlap", "tell"}).solids.size(), 2u);
}

TEST_F(CadProgram, ShellsInShellsOfSewnFacesAreCavities) {
  for (const std::string ending : {".brep", ".igs"}) {
    SCOPED_TRACE(ending);
    const CadModel m = model_of_file(written("nested faces", ending));
    ASSERT_FALSE(m.notes.empty());
    ASSERT_EQ(m.solids.size(), 2u) << m.notes[0];
    EXPECT_NE(m.notes[0].find("2 solids with 1 cavity and 0 faces"), std::string::npos) << m.notes[0];
    EXPECT_NEAR(m.solids[0].volume + m.solids[1].volume, 1000 - 216 + 8, 1e-6);
    for (std::uint32_t s = 0; s < 2; ++s) {
      EXPECT_NEAR(volume_behind(m, s), m.solids[s].volume, 1e-6);
      EXPECT_EQ(open_edges(m, s), 0);
    }
  }
}

TEST_F(CadProgram, WhatClosesIsNoModelWhereMostStaysOpen) {
  const CadModel m = model_of_file(written("mostly open", ".brep"));
  EXPECT_EQ(m.solids.size(), 0u);
  EXPECT_EQ(m.faces.size(), 11u);
  ASSERT_FALSE(m.notes.empty());
  EXPECT_NE(m.notes[0].find("95 % of the area of its faces bounds none"), std::string::npos) << m.notes[0];
}

TEST_F(CadProgram, APartOfASphereThatCrossesTheRestIsTheOtherPart) {
  const std::string file = written("wrong part", ".brep");
  const CadModel m = model_of_file(file);
  ASSERT_EQ(m.solids.size(), 1u);
  const double right = 1000 * std::numbers::pi / 3 + 2800;
  EXPECT_NEAR(m.solids[0].volume, right, 1e-5 * right);
  EXPECT_NEAR(volume_behind(m, 0), right, 1e-3 * right);
  EXPECT_EQ(open_edges(m, 0), 0);
  EXPECT_TRUE(std::ranges::any_of(m.notes, [](const std::string& note) {
    return note.find("1 face of spheres taken as the other part") != std::string::npos;
  }));
  EXPECT_GT(std::abs(model_of_file(file, {"--no-heal"}).solids[0].volume - right), 100) << "as it is in the file";
}

TEST_F(CadProgram, BinaryBrepIsTheSame) {
  const CadModel binary = model_of_file(written("filleted", ".bin.brep")),
                 text = model_of_file(written("filleted", ".brep"));
  EXPECT_EQ(binary.format, "BREP");
  EXPECT_EQ(binary.faces.size(), text.faces.size());
  EXPECT_EQ(open_edges(binary, 0), 0);
  ASSERT_EQ(binary.solids.size(), 1u);
  EXPECT_NEAR(binary.solids[0].volume, text.solids[0].volume, 1e-9);
}

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST_F(CadProgram, CompressedFilesAreRead) {
  const std::string text = content_of(written("box", ".step"));
  const std::string gzip = folder_ / "gzip.stpz", zip = folder_ / "zip.stpz", cut = folder_ / "cut.stpz";
  write_gzip(text, gzip), write_zip(text, "part.step", zip);
  for (const std::string& file : {gzip, zip}) {
    const CadModel m = model_of_file(file);
    EXPECT_EQ(m.format, "STEP") << file;
    ASSERT_EQ(m.solids.size(), 1u) << file;
    EXPECT_NEAR(m.solids[0].volume, 1000, 1e-9);
    std::ofstream(cut, std::ios::binary) << content_of(file).substr(0, 1000);
    const Answer answer = run_reader(cut, {}, kFine);
    ASSERT_EQ(answer.errors.size(), 1u);
    EXPECT_NE(answer.errors[0].find("damaged"), std::string::npos) << answer.errors[0];
  }
}

TEST_F(CadProgram, WhatUnpacksToManyTimesItsSizeIsRefused) {
  const std::string file = folder_ / "zeros.stpz";
  write_gzip("ISO-10303-21;" + std::string(70 << 20, ' '), file);
  const Answer answer = run_reader(file, {}, kFine);
  ASSERT_EQ(answer.errors.size(), 1u);
  EXPECT_NE(answer.errors[0].find("100 times its size"), std::string::npos) << answer.errors[0];
}

/// Calls the parts of an assembly that nobody named so.
std::string with_parts_called(const std::string& text, const std::string& name) {
  static const std::regex unnamed("'Open CASCADE STEP translator [0-9.]+ [0-9]+\\.[0-9]+'");
  EXPECT_TRUE(std::regex_search(text, unnamed));
  return std::regex_replace(text, unnamed, "'" + name + "'");
}

TEST_F(CadProgram, InstancesAreNumberedAndNamesOfAnyCodePageAreUtf8) {
  const std::string file = written("instances", ".step"), text = content_of(file);
  // Latin-1, as ISO 10303-21 writes it, and UTF-8, as many programs do.
  for (const std::string name : {"Tr\xe4ger", R"(Tr\X2\00E4\X0\ger)", "Tr\u00e4ger"}) {
    std::ofstream(file, std::ios::binary) << with_parts_called(text, name);
    const CadModel m = model_of_file(file);
    ASSERT_EQ(m.solids.size(), 2u);
    EXPECT_EQ(m.solids[0].labels.name, "Tr\u00e4ger");
    EXPECT_EQ(m.solids[1].labels.name, "Tr\u00e4ger#2");
    EXPECT_EQ(m.solids[1].product, "Tr\u00e4ger");
  }
}

/// Takes the first line out of a STEP file that defines such an entity; its number.
std::string without_entity(const std::string& file, const std::string& type) {
  const std::string text = content_of(file);
  const std::size_t at = text.find(" = " + type + "(");
  if (at == std::string::npos) return "none";
  const std::size_t begin = text.rfind('#', at), end = text.find(";", at) + 1;
  std::ofstream(file, std::ios::binary) << text.substr(0, begin) << text.substr(end);
  return text.substr(begin, at - begin);
}

TEST_F(CadProgram, AMissingEntityIsNamedAndLeftOutIfAsked) {
  for (const std::string type : {"ADVANCED_FACE", "PLANE", "CYLINDRICAL_SURFACE"}) {
    SCOPED_TRACE(type);
    const std::string file = written("filleted", ".step");
    const std::string number = without_entity(file, type);
    ASSERT_NE(number, "none");
    const Answer refused = run_reader(file, {}, kFine);
    ASSERT_EQ(refused.errors.size(), 1u);
    EXPECT_NE(refused.errors[0].find(number), std::string::npos) << number << ": " << refused.errors[0];
    EXPECT_NE(refused.errors[0].find("keep_going"), std::string::npos) << refused.errors[0];
    const Answer rest = run_reader(file, {"--keep-going"}, kFine);
    ASSERT_EQ(rest.models.size(), 1u);
    EXPECT_GE(rest.models[0].faces.size(), 20u) << "of 26";
    ASSERT_FALSE(rest.notes.empty());
    EXPECT_NE(rest.notes[0].find("went on without"), std::string::npos) << rest.notes[0];
  }
}

TEST_F(CadProgram, DamagedColoursAndTextsAreANote) {
  const std::string file = written("box", ".step");
  std::string text = content_of(file);
  const std::string damaged = "#99990=COLOUR_RGB($,1.,0.,0.);\n#99991=POINT_STYLE('',#99990,$,$);\n";
  text.insert(text.rfind("ENDSEC;"), damaged);
  std::ofstream(file, std::ios::binary) << text;
  const CadModel m = model_of_file(file);
  ASSERT_EQ(m.solids.size(), 1u);
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_NE(m.notes[0].find("no shape needs: #99990 (COLOUR_RGB)"), std::string::npos) << m.notes[0];
}

/// Puts entities at the end of a STEP file.
void add_entities(const std::string& file, const std::string& entities) {
  std::string text = content_of(file);
  text.insert(text.rfind("ENDSEC;"), entities);
  std::ofstream(file, std::ios::binary) << text;
}

TEST_F(CadProgram, DamagedValuesBesideShapesAreANote) {
  // Numbers of a kind that the schema does not allow, as validation properties of AP242 have them.
  for (const std::string of :
       {"#99993=PROPERTY_DEFINITION('validation','',#5);\n#99994=PROPERTY_DEFINITION_REPRESENTATION(#99993,#99992);\n",
        "#99995=SHAPE_REPRESENTATION('values',(#99991),CONTEXT);\n"}) {
    const std::string file = written("box", ".step"), text = content_of(file);
    std::smatch context;
    ASSERT_TRUE(std::regex_search(text, context, std::regex(R"(SHAPE_REPRESENTATION\('',\([#0-9,]+\),(#[0-9]+)\))")));
    add_entities(file,
                 "#99991=INTEGER_REPRESENTATION_ITEM('number of faces',6.5);\n"
                 "#99992=REPRESENTATION('values',(#99991),$);\n" +
                     std::regex_replace(of, std::regex("CONTEXT"), context[1].str()));
    const CadModel m = model_of_file(file);
    ASSERT_EQ(m.solids.size(), 1u);
    EXPECT_NEAR(m.solids[0].volume, 1000, 1e-6);
    ASSERT_EQ(m.notes.size(), 1u);
    EXPECT_NE(m.notes[0].find("no shape needs: #99991 (INTEGER_REPRESENTATION_ITEM)"), std::string::npos) << m.notes[0];
  }
}

TEST_F(CadProgram, DamagedGeometryThatNoShapeHasIsANote) {
  const std::string file = written("box", ".step");
  add_entities(file, "#99991=CARTESIAN_POINT('',(1.,'two',3.));\n");
  const CadModel m = model_of_file(file);
  ASSERT_EQ(m.solids.size(), 1u);
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_NE(m.notes[0].find("no shape needs: #99991"), std::string::npos) << m.notes[0];
}

TEST_F(CadProgram, SameFileSameBytes) {
  const std::string file = written("filleted", ".step");
  EXPECT_EQ(run_reader(file, {}, kFine).bytes, run_reader(file, {}, kFine).bytes);
}

TEST_F(CadProgram, AnswersAsOftenAsAsked) {
  const Answer answer = run_reader(written("cylinder", ".step"), {}, "triangulate 1 0.5\ntriangulate 0.01 0.1\nwhat\n");
  ASSERT_EQ(answer.models.size(), 2u);
  EXPECT_LT(answer.models[0].triangles.size(), answer.models[1].triangles.size());
  EXPECT_EQ(answer.errors.size(), 1u);
}

TEST_F(CadProgram, WhatIsNoSolidIsRefusedInWords) {
  std::ofstream(folder_ / "a.txt") << "hello";
  std::ofstream(folder_ / "b.step") << "";
  for (const std::string name : {"a.txt", "b.step", "none.step"}) {
    const Answer answer = run_reader(folder_ / name, {}, kFine);
    EXPECT_EQ(answer.errors.size(), 1u) << name;
    EXPECT_FALSE(answer.opened);
  }
}

/// Ends in time, with a whole frame, an answer or a signal.
void expect_end(const std::string& file) {
  const Answer answer = run_reader(file, {"--cpu", "10", "--memory", "4e9"}, kFine, 60);
  EXPECT_NE(answer.signal, SIGKILL) << file << " hangs";
  EXPECT_TRUE(answer.signal != 0 || !answer.errors.empty() || answer.models.size() == 1) << file;
  EXPECT_TRUE(answer.signal != 0 || answer.complete) << file;
}

TEST_F(CadProgram, DamagedFilesEnd) {
  for (const std::string ending : {".step", ".brep", ".igs"}) {
    std::ifstream in(written("filleted", ending), std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    ASSERT_GT(whole.size(), 1000u);
    for (std::size_t i = 1; i <= 20; ++i) {
      const std::string cut = folder_ / ("cut" + ending), flipped = folder_ / ("flipped" + ending);
      std::ofstream(cut, std::ios::binary) << whole.substr(0, whole.size() * i / 21);
      std::string bytes = whole;
      for (std::size_t k = 0; k < 5; ++k) bytes[(i * 7919 + k * 104729) % bytes.size()] ^= static_cast<char>(1 << k);
      std::ofstream(flipped, std::ios::binary) << bytes;
      expect_end(cut), expect_end(flipped);
    }
  }
}

}  // namespace

}  // namespace octafront::testing
