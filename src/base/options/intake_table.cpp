#include <octafront/domain.h>

#include "base/options/rows.h"

namespace octafront::options {

namespace {

/// Commands beside those that make meshes.
constexpr std::string_view kWithSurfaces = "repair check";

About about_intake(std::string_view name, std::string_view group, std::string_view help) {
  return {name, group, "mesh surface size", help};
}

template <class Access>
Row<IntakeOptions> intake_row(const OptionInfo& info, Access field) {
  return row_of_field<IntakeOptions>(info, field);
}

template <class Value, class Access>
Row<IntakeOptions> intake_choice(const OptionInfo& info, Access field, const Names<Value>& names) {
  return row_of_choice<IntakeOptions, Value>(info, field, names);
}

std::vector<Row<IntakeOptions>> material_rows() {
  using Cells = ComplexOptions::Cells;
  using Nested = ComplexOptions::Nested;
  using Overlap = ComplexOptions::Overlap;
  constexpr const char* kGroup = "Several materials";
  return {
      intake_choice<Cells>(
          about_intake("cells", kGroup,
                       "auto: cells between inner walls are regions, plain surfaces stay what they are; regions: "
                       "every enclosed cell, also where walls lie double or cross; merge: one region without the "
                       "walls")
              .also(kWithSurfaces),
          [](auto& o) -> auto& { return o.complex.cells; },
          {{"auto", Cells::kAuto}, {"regions", Cells::kRegions}, {"merge", Cells::kMerge}}),
      intake_choice<Nested>(
          about_intake(
              "nested", kGroup,
              "Closed shells inside others: cavities where they face inward and regions where outward, or all the "
              "same")
              .also(kWithSurfaces),
          [](auto& o) -> auto& { return o.complex.nested; },
          {{"direction", Nested::kByDirection}, {"cavity", Nested::kCavity}, {"region", Nested::kRegion}}),
      intake_choice<Overlap>(
          about_intake("overlap", kGroup,
                       "What parts share where they overlap. auto: parts of one file are united, of several bodies the "
                       "later one has it, solids of a CAD file are refused; first, later: that one has it, each name "
                       "of a patch (solid, group) a region; new: it is a region of its own, a&b; regions: as later")
              .also(kWithSurfaces),
          [](auto& o) -> auto& { return o.complex.overlap; },
          {{"auto", Overlap::kAuto},
           {"first", Overlap::kFirst},
           {"later", Overlap::kLater},
           {"new", Overlap::kNew},
           {"regions", Overlap::kLater}}),
      intake_row(
          about_intake(
              "tolerance", kGroup,
              "Several bodies: walls nearer to each other than this are one; 0: exactly as they are. Repair: nothing "
              "moves farther than this")
              .takes("T")
              .from(0)
              .without("what facets explain, or a tenth of the size; of repair a thousandth of the diagonal")
              .also(kWithSurfaces),
          [](auto& o) -> auto& { return o.complex.tolerance; }),
      intake_row(
          about_intake("contacts", kGroup,
                       "How parts meet. shared: by the same nodes; split: nodes are doubled, the sides are the patches "
                       "A|B and B|A; separate: each part has triangles of its own, by its own sizes. Of an image also: "
                       "where labels touch in spots below this area, or in strips of a voxel or two, a label beside "
                       "them comes between; keep: they stay. Two with a comma between")
              .takes("shared|split|separate|A|keep")
              .without("shared; of images the square of the size, if one is given")
              .also("check"),
          [](auto& o) -> auto& { return o.contacts; }),
      intake_row(
          about_intake("contact", kGroup,
                       "The same for one contact, A|B=split, or all of one part, A=separate; several with semicolons "
                       "between, or a file with one in each line")
              .takes("CONTACT=WAY"),
          [](auto& o) -> auto& { return o.contact; }),
  };
}

std::vector<Row<IntakeOptions>> cell_rows() {
  constexpr const char* kGroup = "Periodic cell";
  return {
      intake_row(
          about_intake("repeat", kGroup,
                       "Axes along which bodies in a box, or an image, are repeated: what crosses a face of the cell "
                       "comes in again at the opposite one")
              .takes("AXES")
              .without("those of `periodic`"),
          [](auto& o) -> auto& { return o.repeat; }),
      intake_row(
          about_intake("box", kGroup,
                       "The cell that bodies lie in, X0,Y0,Z0,X1,Y1,Z1: they are cut by it, and the rest of it is a "
                       "region, matrix; or first: the first body is the cell. Of a formula the box that cuts it")
              .takes("X0,Y0,Z0,X1,Y1,Z1")
              .without("of a formula one cell of it, from the origin on"),
          [](auto& o) -> auto& { return o.box; }),
      intake_row(
          about_intake("wind_tunnel", "Flows",
                       "Mesh what flows around the bodies, in a box with the patches inlet, outlet, side_right, "
                       "side_left, ground and top; auto: 5 lengths before, 10 behind, 5 to all sides; ground: the "
                       "same, on the ground")
              .takes("auto|ground|X0,Y0,Z0:X1,Y1,Z1"),
          [](auto& o) -> auto& { return o.wind_tunnel; }),
  };
}

std::vector<Row<IntakeOptions>> repair_rows() {
  using Repair = IntakeOptions::Repair;
  using Sheets = IntakeOptions::Sheets;
  constexpr const char* kGroup = "Repair";
  return {
      intake_choice<Repair>(
          about_intake("repair", kGroup,
                       "Surfaces that cannot be meshed as they are. none: they are refused; auto: holes are "
                       "closed, crossings resolved, what bounds nothing dropped, the rest stays; wrap: a closed "
                       "skin around everything")
              .also("repair"),
          [](auto& o) -> auto& { return o.repair; },
          {{"none", Repair::kOff}, {"auto", Repair::kAuto}, {"wrap", Repair::kWrap}}),
      intake_choice<Sheets>(
          about_intake(
              "sheets", kGroup,
              "Walls inside of a region of a clean complex that bound nothing: cracks to keep, or debris. What "
              "has to be mended loses them")
              .also("repair"),
          [](auto& o) -> auto& { return o.sheets; }, {{"keep", Sheets::kKeep}, {"drop", Sheets::kDrop}}),
      intake_row(
          about_intake("wrap_distance", kGroup, "How far the skin lies from the surface")
              .takes("D")
              .above(0)
              .without("a hundredth of the diagonal")
              .also("repair"),
          [](auto& o) -> auto& { return o.wrap_distance; }),
  };
}

std::vector<Row<IntakeOptions>> image_rows() {
  using Kind = ImageRegions::Kind;
  constexpr const char* kGroup = "Images";
  return {
      intake_row(
          about_intake("series", kGroup,
                       "Which of several images of a folder or a file, counted from 1; 0: the only one")
              .takes("N")
              .from(0)
              .also("check info picture"),
          [](auto& o) -> auto& { return o.image.choice.series; }),
      intake_choice<Kind>(
          about_intake("kind", kGroup,
                       "What the voxels hold; auto: labels if they are whole numbers that neighbours mostly share")
              .called("image")
              .written("image")
              .also("check picture"),
          [](auto& o) -> auto& { return o.image.regions.kind; },
          {{"auto", Kind::kAuto}, {"labels", Kind::kLabels}, {"grey", Kind::kGrey}}),
      intake_row(
          about_intake("islands", kGroup,
                       "Pieces of regions below this volume go to what surrounds them; each region keeps its largest")
              .takes("V")
              .from(0)
              .also("check picture"),
          [](auto& o) -> auto& { return o.image.regions.clean.islands; }),
      intake_row(
          about_intake("holes", kGroup, "Pieces of the outside below this volume, not at the image's edge, are filled")
              .takes("V")
              .from(0)
              .also("check picture"),
          [](auto& o) -> auto& { return o.image.regions.clean.holes; }),
      intake_row(
          about_intake("specks", kGroup,
                       "Pieces of labels and holes below this volume go to what surrounds them, while they are at most "
                       "1 % of a region; 0: they stay")
              .takes("V")
              .from(0)
              .without("an element of the size, if one is given")
              .also("check picture"),
          [](auto& o) -> auto& { return o.image.specks; }),
      intake_row(
          about_intake("close_voxels", kGroup,
                       "Gaps of regions toward the outside close that are up to twice as many voxels wide")
              .takes("N")
              .from(0)
              .to(64)
              .also("check picture"),
          [](auto& o) -> auto& { return o.image.regions.clean.closing; }),
      intake_row(
          about_intake("closed_at_box", kGroup,
                       "What reaches the edge of the image ends flat there, which is said; false: it is refused")
              .also("check picture"),
          [](auto& o) -> auto& { return o.image.regions.closed_at_box; }),
  };
}

/// Those of octafront/units.h, as a test compares.
Names<std::string> units() {
  return {{"um", "um"}, {"mm", "mm"}, {"cm", "cm"}, {"m", "m"}, {"in", "in"}, {"ft", "ft"}};
}

std::vector<Row<IntakeOptions>> cad_rows() {
  constexpr const char* kGroup = "CAD";
  return {
      intake_row(
          about_intake("cad_size", kGroup,
                       "The edge length that elements will have: triangles are made fine enough for it, and no line is "
                       "kept where narrow faces meet smoothly")
              .takes("H")
              .above(0)
              .without("as size or elements ask, else a fortieth of the diagonal, and all lines")
              .also("-"),
          [](auto& o) -> auto& { return o.cad.size; }),
      intake_row(
          about_intake("cad_elements", kGroup, "The number of tetrahedra that the mesh will have, in place of cad_size")
              .takes("N")
              .from(1)
              .also("-"),
          [](auto& o) -> auto& { return o.cad.elements; }),
      intake_choice<std::string>(
          about_intake("cad_unit", kGroup, "What lengths count, those that are given and those of the mesh").also("-"),
          [](auto& o) -> auto& { return o.cad.unit; }, units()),
      intake_row(
          about_intake("keep_edges", kGroup, "All lines between faces are kept, tiny ones and smooth ones too")
              .also("repair"),
          [](auto& o) -> auto& { return o.cad.keep_edges; }),
      intake_row(
          about_intake("keep_going", kGroup, "A file of which a part cannot be read is meshed without it")
              .also("repair"),
          [](auto& o) -> auto& { return o.cad.keep_going; }),
      intake_row(
          about_intake("heal", kGroup, "What is not valid is healed, where that changes no volume; else it stays")
              .written("no-heal")
              .also("repair"),
          [](auto& o) -> auto& { return o.cad.heal; }),
      intake_row(
          about_intake("cad_seconds", kGroup, "CPU time for reading, healing, fusing and triangles")
              .takes("S")
              .above(0)
              .also("repair"),
          [](auto& o) -> auto& { return o.cad.seconds; }),
      intake_row(
          about_intake("cad_memory", kGroup, "Memory for the same, in gigabytes").takes("GB").above(0).also("repair"),
          [](auto& o) -> auto& { return o.cad.memory_gigabytes; }),
  };
}

std::vector<Row<IntakeOptions>> formula_rows() {
  constexpr const char* kGroup = "Formulas";
  return {
      intake_row(
          about_intake("cell", kGroup,
                       "Period of the named surfaces (gyroid, schwarz_p, diamond, iwp, neovius, lidinoid)")
              .takes("L")
              .above(0)
              .without("1"),
          [](auto& o) -> auto& { return o.formula.cell; }),
      intake_row(
          about_intake("resolution", kGroup,
                       "Cells along the longest side of the box, between which the surface is sought")
              .takes("N")
              .from(4)
              .without("64, and 32 a period"),
          [](auto& o) -> auto& { return o.formula.resolution; }),
  };
}

const std::vector<Row<IntakeOptions>>& intake_rows() {
  static const auto all =
      all_of<IntakeOptions>({material_rows(), cell_rows(), repair_rows(), image_rows(), cad_rows(), formula_rows()});
  return all;
}

}  // namespace

}  // namespace octafront::options

namespace octafront {

const std::vector<OptionInfo>& intake_table() {
  static const std::vector<OptionInfo> table = options::infos_of(options::intake_rows());
  return table;
}

OptionValue option_value(const IntakeOptions& options, std::string_view name) {
  return options::row_named(options::intake_rows(), name).get(options);
}

void set_option(IntakeOptions& options, std::string_view name, const OptionValue& value) {
  options::row_named(options::intake_rows(), name).set(options, value);
}

void check_ranges(const IntakeOptions& options) {
  options::check_rows(options::intake_rows(), options);
}

}  // namespace octafront
