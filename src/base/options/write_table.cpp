#include <octafront/io.h>

#include "base/options/rows.h"

namespace octafront::options {

namespace {

About about_writing(std::string_view name, std::string_view help) {
  return About(name, "Output", "mesh improve adapt", help).also("carry move convert");
}

template <class Access>
Row<WriteOptions> write_row(const OptionInfo& info, Access field) {
  return row_of_field<WriteOptions>(info, field);
}

const std::vector<Row<WriteOptions>>& write_rows() {
  static const std::vector<Row<WriteOptions>> all{
      write_row(
          about_writing("format", "Format by name, whatever the ending").takes("NAME").also("-"),
          [](auto& o) -> auto& { return o.format; }),
      write_row(
          about_writing("ascii", "As text, of formats that are binary else"), [](auto& o) -> auto& { return o.ascii; }),
      write_row(
          about_writing("cells_only",
                        "Tetrahedra alone, with regions and sets: no faces and edges, which some programs refuse "
                        "beside them"),
          [](auto& o) -> auto& { return o.cells_only; }),
      write_row(
          about_writing("polyhedral",
                        "As polyhedra, a cell for each vertex: the dual of the tetrahedra, layers stay prisms "
                        "(OpenFOAM, CGNS, VTU)"),
          [](auto& o) -> auto& { return o.polyhedral; }),
      write_row(
          about_writing(
              "deck",
              "OpenFOAM: also the rest of a case for simpleFoam around CASE/constant/polyMesh, by `speed` and "
              "`fluid`; an old one stays"),
          [](auto& o) -> auto& { return o.deck; }),
      write_row(
          About("speed", "Output", "improve adapt convert", "Speed of the flow at the inlet, m/s, for `deck`")
              .takes("U")
              .above(0),
          [](auto& o) -> auto& { return o.speed; }),
      write_row(
          About("fluid", "Output", "improve adapt convert", "air, water, or a kinematic viscosity in m2/s, for `deck`")
              .takes("NAME|NU"),
          [](auto& o) -> auto& { return o.fluid; }),
      write_row(
          About("unit", "Output", "improve convert",
                "What coordinates count: the case of a `deck` is written in metres")
              .takes("UNIT")
              .without("metres"),
          [](auto& o) -> auto& { return o.unit; }),
      write_row(
          about_writing("cohesive",
                        "Cohesive elements of no height between the two sides of what was split (Abaqus: COH3D6)"),
          [](auto& o) -> auto& { return o.cohesive; }),
      write_row(
          about_writing("beams", "These curves are beams, too, names with commas between (Abaqus: B31, B32)")
              .takes("NAME,..."),
          [](auto& o) -> auto& { return o.beams; }),
      // More parts than any machine has processes are a slip of the hand.
      write_row(
          about_writing("parts", "Divide the mesh into N parts, for programs on several processes; 0: it stays whole")
              .takes("N")
              .from(0)
              .to(1'000'000),
          [](auto& o) -> auto& { return o.parts; }),
      row_of_choice<WriteOptions, Partitioner>(
          about_writing("partitioner",
                        "curve: parts that differ by one element at most, the same everywhere; metis: fewer faces "
                        "between them"),
          [](auto& o) -> auto& { return o.partitioner; },
          {{"curve", Partitioner::kCurve}, {"metis", Partitioner::kMetis}}),
      write_row(
          about_writing("split_files", "Of Gmsh MSH 4.1 in parts: NAME_1.msh and so on, in the place of one file"),
          [](auto& o) -> auto& { return o.split_files; }),
  };
  return all;
}

}  // namespace

}  // namespace octafront::options

namespace octafront {

const std::vector<OptionInfo>& write_table() {
  static const std::vector<OptionInfo> table = options::infos_of(options::write_rows());
  return table;
}

OptionValue option_value(const WriteOptions& options, std::string_view name) {
  return options::row_named(options::write_rows(), name).get(options);
}

void set_option(WriteOptions& options, std::string_view name, const OptionValue& value) {
  options::row_named(options::write_rows(), name).set(options, value);
}

void check_ranges(const WriteOptions& options) {
  options::check_rows(options::write_rows(), options);
}

}  // namespace octafront
