#include "arguments.h"

#include <octafront/io.h>

#include "units.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace octafront::cli {

namespace {

template <class Value>
void add_choice(CLI::App& group, const std::string& option, Value& value,
                const std::vector<std::pair<std::string, Value>>& names, const std::string& help) {
  const Choice<Value> choice{names};
  group
      .add_option_function<std::string>(
          option, [&value, choice, option](const std::string& typed) { value = choice.value_of(option, typed); },
          help + " [" + choice.name_of(value) + "]")
      ->type_name(choice.listed("|"));
}

/// ".vtu, .msh (Gmsh MSH 4.1), ..."
std::string formats_that(bool FormatInfo::*can) {
  std::string all;
  for (const FormatInfo& info : known_formats())
    if (info.*can && !info.endings.empty() && !info.writes_surface)
      all += (all.empty() ? "" : ", ") + std::string(info.endings.substr(0, info.endings.find(' ')));
  return all;
}

std::string formats_with_text() {
  std::string names;
  for (const FormatInfo& info : known_formats())
    if (info.also_text) names += (names.empty() ? "" : ", ") + std::string(info.name);
  return names;
}

std::string names_of_formats() {
  std::string all;
  for (const FormatInfo& info : known_formats())
    if (info.writes_mesh) all += (all.empty() ? "" : ", ") + std::string(info.name);
  return all;
}

/// A length in units of the input, or with a unit of its own: "2", "2mm".
CLI::Option* add_length(CLI::App& group, Arguments& a, const std::string& option, std::optional<double>& value,
                        const std::string& help) {
  const auto read = [&a, &value, option](const std::string& typed) {
    const auto [number, unit] = length_of(option, typed);
    value = number;
    if (!unit.empty()) a.lengths.push_back({option, unit, &value});
  };
  return group.add_option_function<std::string>(option, read, help);
}

[[noreturn]] void refuse_group(const std::string& typed, const std::string& why) {
  throw CLI::ValidationError("--group", "\"" + typed + "\" " + why +
                                            "; write NAME=box:X0,Y0,Z0,X1,Y1,Z1, NAME=sphere:X,Y,Z,R or "
                                            "NAME=patches:A,B");
}

std::vector<double> numbers_of(const std::string& typed, const std::string& list, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string& word : CLI::detail::split(list, ',')) {
    double value = 0;
    if (!CLI::detail::lexical_cast(word, value) || !std::isfinite(value))
      refuse_group(typed, "has \"" + word + "\" where a number should be");
    numbers.push_back(value);
  }
  if (numbers.size() != count)
    refuse_group(typed, "has " + std::to_string(numbers.size()) + " numbers, not " + std::to_string(count));
  return numbers;
}

/// A point as "x,y,z".
Vec3 point_of(const std::string& option, const std::string& typed, const std::string& list) {
  std::vector<double> numbers;
  for (const std::string& word : CLI::detail::split(list, ',')) {
    double value = 0;
    if (CLI::detail::lexical_cast(word, value) && std::isfinite(value)) numbers.push_back(value);
  }
  if (numbers.size() != 3 || std::count(list.begin(), list.end(), ',') != 2)
    throw CLI::ValidationError(option, "\"" + typed + "\" does not end with a point; write its coordinates as X,Y,Z");
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

GroupRule group_rule(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos) refuse_group(typed, "has no name");
  GroupRule rule{typed.substr(0, equals), NamedSet::Kind::kNodes, {}};
  std::vector<std::string> words = CLI::detail::split(typed.substr(equals + 1), ':');
  const std::vector<std::pair<std::string, NamedSet::Kind>> kinds{
      {"nodes", NamedSet::Kind::kNodes}, {"faces", NamedSet::Kind::kFaces}, {"elements", NamedSet::Kind::kElements}};
  for (const auto& [word, kind] : kinds)
    if (words.size() == 3 && words[0] == word) {
      rule.kind = kind;
      words.erase(words.begin());
    }
  if (words.size() != 2) refuse_group(typed, "does not say where it is");
  if (words[0] == "box") {
    const std::vector<double> n = numbers_of(typed, words[1], 6);
    rule.where = Box3{{std::min(n[0], n[3]), std::min(n[1], n[4]), std::min(n[2], n[5])},
                      {std::max(n[0], n[3]), std::max(n[1], n[4]), std::max(n[2], n[5])}};
  } else if (words[0] == "sphere") {
    const std::vector<double> n = numbers_of(typed, words[1], 4);
    if (!(n[3] > 0)) refuse_group(typed, "has a radius that is not above 0");
    rule.where = GroupRule::Sphere{{n[0], n[1], n[2]}, n[3]};
  } else if (words[0] == "patches") {
    rule.where = CLI::detail::split(words[1], ',');
  } else {
    refuse_group(typed, "has \"" + words[0] + "\" where box, sphere or patches should be");
  }
  return rule;
}

RegionSeed region_seed(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw CLI::ValidationError("--region", "\"" + typed + "\" has no name; write NAME=X,Y,Z");
  return {typed.substr(0, equals), point_of("--region", typed, typed.substr(equals + 1))};
}

std::int64_t whole_number(const char* option, double n) {
  if (!(std::abs(n) < 9e18) || n != std::floor(n))
    throw CLI::ValidationError(option, "needs a whole number, such as 100000 or 1e5");
  return static_cast<std::int64_t>(n);
}

void declare_input(CLI::App& command, Arguments& a, const std::string& what) {
  const std::string surface =
      "Closed surface, with inner walls or without: STL, OBJ, OFF, PLY, TetGen .poly, triangles of Gmsh .msh or MEDIT "
      ".mesh; -: from standard input; or several files, a body each. Or CAD: STEP, IGES, BREP. Or an image of labels "
      "or grey values: NIfTI, "
      "NRRD, "
      "MetaImage, raw with JSON, DICOM (a folder or its files). Or a formula";
  command
      .add_option_function<std::vector<std::string>>(
          "input",
          [&a](const std::vector<std::string>& all) {
            a.bodies.assign(all.begin(), all.end());
            a.input = a.bodies.front();
          },
          what.empty() ? surface : what)
      ->required()
      ->type_name("FILE");
}

void declare_complex(CLI::App& command, Arguments& a) {
  ComplexOptions& o = a.intake.complex;
  auto* group = command.add_option_group("Several materials", "Cells between walls, or bodies of several files");
  group
      ->add_option_function<std::vector<std::string>>(
          "--region",
          [&o](const std::vector<std::string>& all) {
            for (const std::string& typed : all) o.regions.push_back(region_seed(typed));
          },
          "The cell of this point is a region of this name; cells of one name are one region")
      ->type_name("NAME=X,Y,Z")
      ->allow_extra_args(false);
  group
      ->add_option_function<std::vector<std::string>>(
          "--void",
          [&o](const std::vector<std::string>& all) {
            for (const std::string& typed : all) o.voids.push_back(point_of("--void", typed, typed));
          },
          "The cell of this point stays empty")
      ->type_name("X,Y,Z")
      ->allow_extra_args(false);
  using Cells = ComplexOptions::Cells;
  add_choice<Cells>(*group, "--cells", o.cells,
                    {{"auto", Cells::kAuto}, {"regions", Cells::kRegions}, {"merge", Cells::kMerge}},
                    "auto: cells between inner walls are regions, plain surfaces stay what they are; regions: every "
                    "enclosed cell, also where walls lie double or cross; merge: one region without the walls");
  using Nested = ComplexOptions::Nested;
  add_choice<Nested>(
      *group, "--nested", o.nested,
      {{"direction", Nested::kByDirection}, {"cavity", Nested::kCavity}, {"region", Nested::kRegion}},
      "Closed shells inside others: cavities where they face inward and regions where outward, or all the same");
  using Overlap = ComplexOptions::Overlap;
  add_choice<Overlap>(
      *group, "--overlap", o.overlap,
      {{"auto", Overlap::kAuto},
       {"first", Overlap::kFirst},
       {"later", Overlap::kLater},
       {"new", Overlap::kNew},
       {"regions", Overlap::kLater}},
      "What parts share where they overlap. auto: parts of one file are united, of several files the later one has it, "
      "solids of a CAD file are refused; first, later: that one has it, each name of a patch (solid, group) a region; "
      "new: it is a region of its own, a&b; regions: as later");
  group
      ->add_option("--tolerance", o.tolerance,
                   "Several bodies: walls nearer to each other than this are one; 0: exactly as they are [what "
                   "facets explain, a tenth of the size]. Repair: nothing moves farther than this [a thousandth of "
                   "the diagonal]")
      ->type_name("T");
}

void declare_inside(CLI::App& command, Arguments& a) {
  InsideIntake& inside = a.intake.inside;
  auto* group = command.add_option_group(
      "Inside", "What lies in the bodies and is part of their mesh, by the names of its files");
  const auto files = [&](const std::string& option, std::vector<std::string>& list, const std::string& help) {
    group->add_option(option, list, help)->type_name("[NAME=]FILE")->allow_extra_args(false);
  };
  files(
      "--sheet", inside.sheet_files,
      "An open or closed surface whose triangles become faces inside: a crack, a fault; what lies outside is cut off");
  files("--wire", inside.wire_files,
        "Lines that become edges: OBJ, PLY, VTK, MSH, or a table of points, polygons end at empty lines");
  files("--points", inside.point_files, "Points that become nodes: the same files");
}

void declare_split(CLI::App& command, Arguments& a) {
  command
      .add_option(
          "--split", a.options.split,
          "Open the mesh along these patches inside, sheets or walls between regions, commas between them: nodes "
          "are doubled, the sides are the patches NAME_plus and NAME_minus")
      ->type_name("NAME,...");
}

void declare_repair(CLI::App& command, Arguments& a) {
  auto* group = command.add_option_group("Repair", "Surfaces that cannot be meshed as they are");
  using Repair = IntakeOptions::Repair;
  using Sheets = IntakeOptions::Sheets;
  add_choice<Repair>(*group, "--repair", a.intake.repair,
                     {{"none", Repair::kOff}, {"auto", Repair::kAuto}, {"wrap", Repair::kWrap}},
                     "none: they are refused; auto: holes are closed, crossings resolved, what bounds nothing dropped, "
                     "the rest stays; wrap: a closed skin around everything");
  add_choice<Sheets>(
      *group, "--sheets", a.intake.sheets, {{"keep", Sheets::kKeep}, {"drop", Sheets::kDrop}},
      "Walls inside of a region of a clean complex that bound nothing: cracks to keep, or debris. What has "
      "to be mended loses them");
  group
      ->add_option("--wrap-distance", a.intake.wrap_distance,
                   "How far the skin lies from the surface [a hundredth of the diagonal]")
      ->type_name("D");
  group
      ->add_option("--defects", a.defects,
                   "Show what was changed: a surface with a mark at each place, a patch each kind")
      ->type_name("FILE.ply");
}

void declare_formula(CLI::App& command, Arguments& a) {
  FormulaIntake& o = a.intake.formula;
  auto* group =
      command.add_option_group("Formulas", "A body where a formula is below 0, such as 'gyroid(x,y,z) - 0.3'");
  group
      ->add_option("--cell", o.cell,
                   "Period of the named surfaces (gyroid, schwarz_p, diamond, iwp, neovius, lidinoid) [1]")
      ->type_name("L");
  group
      ->add_option("--resolution", o.resolution,
                   "Cells along the longest side of the box, between which the surface is sought [64, and 32 a period]")
      ->type_name("N");
}

void declare_cad(CLI::App& command, Arguments& a) {
  CadIntake& cad = a.intake.cad;
  auto* group = command.add_option_group("CAD", "STEP, IGES, BREP");
  group->add_flag("--keep-edges", cad.keep_edges,
                  "Keep all lines between faces, also where narrow faces meet smoothly");
  group->add_flag("--keep-going", cad.keep_going, "Go on without what cannot be read");
  group->add_flag_callback(
      "--no-heal", [&cad] { cad.heal = false; }, "Leave invalid faces and solids as they are");
  group->add_option("--cad-seconds", cad.seconds, "CPU time for reading, healing, fusing and triangles [300]")
      ->type_name("S");
  group->add_option("--cad-memory", cad.memory_gigabytes, "Memory for the same, gigabytes [8]")->type_name("GB");
}

void declare_mesh_input(CLI::App& command, Arguments& a) {
  command.add_option("input", a.input, "Tetrahedral mesh: " + formats_that(&FormatInfo::reads_mesh))
      ->required()
      ->type_name("MESH");
}

void declare_output(CLI::App& command, Arguments& a, const std::string& what, bool required) {
  auto* option = command.add_option("-o,--output", a.output, what)->type_name("FILE");
  if (required) option->required();
}

namespace {

std::string formats_in_parts() {
  std::string names;
  for (const FormatInfo& info : known_formats())
    if (info.holds.parts) names += (names.empty() ? "" : ", ") + std::string(info.name);
  return names;
}

/// More parts than any machine has processes are a slip of the hand.
constexpr int kMostParts = 1'000'000;

void declare_parts(CLI::App& command, Arguments& a) {
  command
      .add_option("--parts", a.parts,
                  "Divide the mesh into N parts, for programs on several processes: " + formats_in_parts())
      ->type_name("N")
      ->check(CLI::Range(1, kMostParts));
  add_choice<Partitioner>(command, "--partitioner", a.partitioner,
                          {{"curve", Partitioner::kCurve}, {"metis", Partitioner::kMetis}},
                          "curve: parts that differ by one element at most, the same everywhere; metis: fewer faces "
                          "between them");
  command.add_flag("--split-files", a.split_files,
                   "Of Gmsh MSH 4.1 in parts: NAME_1.msh and so on, in the place of one file");
}

}  // namespace

void declare_mesh_output(CLI::App& command, Arguments& a) {
  command
      .add_option("-o,--output", a.meshes,
                  "Mesh, its format by the ending: " + formats_that(&FormatInfo::writes_mesh) +
                      "; several: each is written; -: to standard output, alone, with --format; /dev/null: nowhere, "
                      "with --format")
      ->type_name("FILE")
      ->transform([](const std::string& file) { return file == "/dev/stdout" ? std::string("-") : file; })
      ->allow_extra_args(false);
  command
      .add_option("--format", a.formats,
                  "Format by name, whatever the ending; for several outputs once for each: " + names_of_formats())
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_flag("--ascii", a.ascii, "As text, of formats that are binary else: " + formats_with_text());
  command.add_flag(
      "--cells-only", a.cells_only,
      "Tetrahedra alone, with regions and sets: no faces and edges, which some programs refuse beside them");
  command.add_flag("--cohesive", a.cohesive,
                   "Cohesive elements of no height between the two sides of what was split (Abaqus: COH3D6)");
  declare_parts(command, a);
  command.add_option("--beams", a.beams, "These curves are beams, too (Abaqus: B31, B32)")->type_name("NAME,...");
  command
      .add_option_function<std::vector<std::string>>(
          "--group",
          [&a](const std::vector<std::string>& all) {
            for (const std::string& typed : all) a.groups.push_back(group_rule(typed));
          },
          "Add a set: NAME=box:X0,Y0,Z0,X1,Y1,Z1, NAME=sphere:X,Y,Z,R or NAME=patches:A,B; of nodes, or "
          "NAME=elements:box:..., NAME=faces:box:...")
      ->type_name("NAME=WHERE")
      ->allow_extra_args(false);
}

void declare_page(CLI::App& command, Arguments& a) {
  command
      .add_option("--report", a.page,
                  "Write a web page with the mesh in 3D and all numbers, in one file that needs no network")
      ->type_name("FILE.html");
}

void declare_preset(CLI::App& command, Arguments& a) {
  const Choice<Preset> choice{{{"draft", Preset::kDraft}, {"standard", Preset::kStandard}, {"fine", Preset::kFine}}};
  command
      .add_option_function<std::string>(
          "--preset", [&a, choice](const std::string& typed) { a.preset = choice.value_of("--preset", typed); },
          "draft: automatic sizes with about a quarter of the elements, improved fast; fine: with four times as many, "
          "improved "
          "best; options that are given go before [standard]")
      ->type_name(choice.listed("|"));
}

void declare_dry_run(CLI::App& command, Arguments& a) {
  command.add_flag("--dry-run", a.dry_run,
                   "Say how many elements, how much memory and time it would take; make nothing");
}

void declare_report(CLI::App& command, Arguments& a) {
  command
      .add_option("--json", a.json, "Write the report as JSON, also of a run that fails; -: to standard output, alone")
      ->type_name("FILE");
}

/// "500MB", "2 GB", "1e9".
std::uint64_t bytes_of(const std::string& typed) {
  constexpr double kLeast = 64e6;  // the program itself takes some of it
  const std::size_t end = typed.find_last_of("0123456789.") + 1;
  const std::string unit = CLI::detail::to_lower(CLI::detail::trim_copy(typed.substr(end)));
  const std::vector<std::pair<std::string, double>> units{
      {"", 1},    {"b", 1},   {"kb", 1e3}, {"mb", 1e6},     {"gb", 1e9},     {"tb", 1e12},    {"k", 1e3},
      {"m", 1e6}, {"g", 1e9}, {"t", 1e12}, {"kib", 0x1p10}, {"mib", 0x1p20}, {"gib", 0x1p30}, {"tib", 0x1p40}};
  const auto known = std::find_if(units.begin(), units.end(), [&](const auto& u) { return u.first == unit; });
  double number = 0;
  if (known == units.end() || !CLI::detail::lexical_cast(CLI::detail::trim_copy(typed.substr(0, end)), number) ||
      !(number * known->second >= kLeast && number * known->second < 1e18))
    throw CLI::ValidationError("--memory", "\"" + typed + "\" is no size of memory; write 500MB or 8GB, at least 64MB");
  return static_cast<std::uint64_t>(number * known->second);
}

void declare_run(CLI::App& command, Arguments& a) {
  auto* group = command.add_option_group("Run");
  group
      ->add_option("--threads", a.threads,
                   "Threads at most, never more than the machine has; 0: all. The result is the same")
      ->check(CLI::Range(0, 1024).description(""))
      ->type_name("N");
  group
      ->add_option_function<std::string>(
          "--memory", [&a](const std::string& typed) { a.limits.memory = bytes_of(typed); },
          "Memory at most: 500MB, 8GB, or bytes; what takes more is refused [what the machine has]")
      ->type_name("SIZE");
  group
      ->add_option_function<double>(
          "--max-elements",
          [&a](double n) {
            if (!(n >= 1)) throw CLI::ValidationError("--max-elements", "is a number of elements, 1 or more");
            a.limits.elements = static_cast<std::uint64_t>(whole_number("--max-elements", n));
          },
          "Elements at most; what has or makes more is refused")
      ->type_name("N");
  group
      ->add_option_function<double>(
          "--cpu-seconds",
          [&a](double seconds) {
            if (!(seconds > 0)) throw CLI::ValidationError("--cpu-seconds", "is a number of seconds above 0");
            a.limits.cpu_seconds = seconds;
          },
          "CPU seconds of all threads at most; then the run ends without a result")
      ->type_name("S");
  group->add_flag("-q,--quiet", a.quiet, "Print nothing but errors");
}

/// NAME=H, where the name may have signs of equality of its own.
NamedSize named_size(const std::string& text) {
  const std::size_t at = text.rfind('=');
  double size = 0;
  if (at == std::string::npos || at == 0 || !CLI::detail::lexical_cast(text.substr(at + 1), size))
    throw CLI::ValidationError("--size-of", "\"" + text + "\" is not NAME=H, the name of a part and a size");
  return {text.substr(0, at), size};
}

/// NAME=H:DISTANCE or X,Y,Z=H:DISTANCE.
NearSize near_size(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw CLI::ValidationError("--size-near",
                               "\"" + text + "\" " + why + "; write NAME=H:DISTANCE or X,Y,Z=H:DISTANCE");
  };
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) refuse("names no place");
  const std::vector<std::string> numbers = CLI::detail::split(text.substr(equals + 1), ':');
  NearSize near;
  if (numbers.size() != 2 || !CLI::detail::lexical_cast(numbers[0], near.size) ||
      !CLI::detail::lexical_cast(numbers[1], near.distance))
    refuse("does not end with a size and a distance");
  const std::string place = text.substr(0, equals);
  std::vector<double> coordinates;
  for (const std::string& word : CLI::detail::split(place, ',')) {
    double value = 0;
    if (CLI::detail::lexical_cast(word, value)) coordinates.push_back(value);
  }
  const bool is_point = coordinates.size() == 3 && std::count(place.begin(), place.end(), ',') == 2;
  if (is_point)
    near.point = {coordinates[0], coordinates[1], coordinates[2]};
  else
    near.name = place;
  return near;
}

void declare_sizes(CLI::App& command, Arguments& a) {
  SizeOptions& o = a.options.size;
  auto* group = command.add_option_group("Sizes", "None given: an automatic size. Several: the smallest wins");
  add_length(*group, a, "--size", o.size, "Edge length, in units of the input, or with one: 2mm")->type_name("H");
  group
      ->add_option_function<double>(
          "--elements", [&o](double n) { o.elements = whole_number("--elements", n); },
          "Number of tetrahedra wanted, met within 15 %")
      ->type_name("N");
  group->add_option("--curvature", o.curvature, "Elements per full turn of a curved surface")->type_name("K");
  group->add_option("--gap", o.gap, "Elements across thin walls and narrow gaps [images with --size or --elements: 1]")
      ->type_name("K");
  group->add_option("--through", o.through, "Elements across thin walls at least, whatever the gaps between them")
      ->type_name("K");
  group->add_option("--feature-elements", o.feature_elements, "Elements along each feature curve at least")
      ->type_name("K");
  group
      ->add_option_function<std::vector<std::string>>(
          "--size-of",
          [&o](const std::vector<std::string>& all) {
            for (const std::string& text : all) o.named.push_back(named_size(text));
          },
          "Edge length in and around a region, on a patch or along a curve, by its name, of CAD also by \"color "
          "#ff8000\" "
          "or \"layer NAME\"; may be repeated")
      ->type_name("NAME=H")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  group
      ->add_option_function<std::vector<std::string>>(
          "--size-near",
          [&o](const std::vector<std::string>& all) {
            for (const std::string& text : all) o.near.push_back(near_size(text));
          },
          "Edge length H in a region, on a patch, along a curve or at a point, rising to nothing asked at the "
          "distance; "
          "may be repeated")
      ->type_name("NAME|X,Y,Z=H:DISTANCE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  group
      ->add_option("--regions", a.regions, "Boxes, spheres and points with a size each: JSON, or a table x, y, z, size")
      ->type_name("FILE");
  group
      ->add_option("--point-sizes", a.point_sizes,
                   "Sizes at the vertices of the surface: VTU, VTP (array \"size\"), or a table x, y, z, size")
      ->type_name("FILE");
  group
      ->add_option("--size-field", a.size_field,
                   "A mesh of tetrahedra or triangles with a field of sizes, at points or in elements, by its name "
                   "(VTU, VTK, Gmsh, MEDIT .sol, TetGen .mtr, XDMF); or all sizes, as `octafront size -o` writes them, "
                   "edited or not, alone")
      ->type_name("FILE[:FIELD]");
  group
      ->add_option(
          "--unit", a.unit,
          "What the input's coordinates count, for lengths with a unit; OBJ files may say it. Of CAD files what comes "
          "out counts it, and what lengths are given [mm]")
      ->type_name(names_of_units("|"));
  group->add_flag("--facets", o.facets, "Sizes follow the areas of the input's facets (the paper's rule)");
  add_length(*group, a, "--min-size", o.min_size,
             "No size falls below this [images with --size or --elements: a voxel]")
      ->type_name("H");
  add_length(*group, a, "--max-size", o.max_size, "No size rises above this")->type_name("H");
  group
      ->add_option("--automatic-factor", o.automatic_factor,
                   "Automatic sizes times this: .5 makes eight times as many elements")
      ->type_name("F")
      ->capture_default_str();
  group
      ->add_option(
          "--gradation,--grading", o.gradation,
          "How fast sizes may change: |h(x) - h(y)| <= G |x - y| [by the spread of sizes, .12 to .4, order 2: .8]")
      ->type_name("G");
  add_choice<SizeOptions::Interior>(
      *group, "--interior", o.interior,
      {{"uniform", SizeOptions::Interior::kUniform}, {"graded", SizeOptions::Interior::kGraded}},
      "Inside no larger than on the surface, or growing inward");
  a.names.add("field", "--size-field");
}

void declare_surface(CLI::App& command, Arguments& a) {
  SurfaceOptions& o = a.options.surface;
  auto* group = command.add_option_group("Surface");
  group->add_flag("--keep-surface", o.keep, "The input triangles become the boundary, exactly");
  group
      ->add_option("--feature-angle", o.feature_angle,
                   "Edges that bend by more degrees than this are kept [40; images: 85]")
      ->type_name("DEG");
  add_length(*group, a, "--max-deviation", o.max_deviation,
             "Smaller elements where the surface would stray farther from the input, and how far folds and needles "
             "of it give way; 0: not at all [images: 0.16 voxels, but not with --elements; what repair moved: its "
             "tolerance, else 0.4 % of the diagonal, with "
             "automatic sizes]")
      ->type_name("D");
  group
      ->add_option("--normal-deviation", o.normal_deviation,
                   "Smaller elements where triangles would turn by more degrees against the input [none]")
      ->type_name("DEG");
  using Strips = SurfaceOptions::Strips;
  add_choice<Strips>(
      *group, "--strips", o.strips, {{"fine", Strips::kFine}, {"off", Strips::kOff}},
      "fine: smaller elements where two feature edges run side by side nearer than an element; off: flat ones");
  group->add_flag("--patches", o.patches_by_features,
                  "Each part of the surface that feature edges enclose becomes a patch");
  group->add_flag("--keep-volumes", o.keep_volumes,
                  "Bodies and regions keep the volumes that they have in the input; images do so unasked");
  group
      ->add_option("--volume-tolerance", o.volume_tolerance,
                   "Smaller elements where chords would change the volume of a region by more percent [none]")
      ->type_name("P");
  a.names.add("keep", "--keep-surface");
  a.names.add("patches_by_features", "--patches");
}

void declare_periodic(CLI::App& command, Arguments& a) {
  auto* group = command.add_option_group("Periodic cell");
  group
      ->add_option("--periodic", a.options.periodic,
                   "Axes along which the body is one cell of a periodic one, such as x or xyz: opposite faces of its "
                   "bounding box get the same triangles, and their nodes are paired; bodies and images are repeated. "
                   "Or what leads from a face to its copy: X,Y,Z (a translation), DEGREES@z or "
                   "DEGREES@PX,PY,PZ,DX,DY,DZ (a rotation about an axis), several with semicolons between, each with "
                   "LOW:HIGH= before it where names of patches are to say what it leads to what")
      ->type_name("AXES|MAP");
  group
      ->add_option("--repeat", a.intake.repeat,
                   "Axes along which bodies in a box, or an image, are repeated: what crosses a face of the cell comes "
                   "in again at the opposite one [those of --periodic]")
      ->type_name("AXES");
  group
      ->add_option("--box", a.intake.box,
                   "The cell that bodies lie in: they are cut by it, and the rest of it is a region, matrix; or first: "
                   "the first body is the cell. Of a formula the box that cuts it [one cell from the origin on]")
      ->type_name("X0,Y0,Z0,X1,Y1,Z1");
}

void declare_layers(CLI::App& command, Arguments& a) {
  LayersOptions& o = a.options.layers;
  auto* group = command.add_option_group("Boundary layers");
  group->add_option("--layers", o.count, "Layers of thin elements along walls, as high as the options below say")
      ->type_name("N");
  add_length(*group, a, "--first", o.first, "Height of the first layer, at the wall")->type_name("H");
  group->add_option("--first-part", o.first_part, "Height of the first layer as a part of the edge length there")
      ->type_name("F");
  group
      ->add_option("--growth", o.growth,
                   "Each layer over the one below, 1 to 3 [1.2, or what --first and --total need]")
      ->type_name("G");
  add_length(*group, a, "--total", o.total, "Height of all layers")->type_name("T");
  group
      ->add_option("--yplus", o.yplus,
                   "Height of the first layer by its y+ in a turbulent flow along a flat plate, with --Re and --Lref")
      ->type_name("Y");
  group->add_option("--Re", o.reynolds, "Reynolds number of the flow, for --yplus")->type_name("RE");
  add_length(*group, a, "--Lref", o.reference_length, "Length that the Reynolds number belongs to")->type_name("L");
  group->add_option("--on", o.on, "Patches that are walls, by name, with commas between them [all]")
      ->type_name("NAMES");
  group->add_option("--layers-in", o.in, "Regions that they grow in, by name, with commas between them [all]")
      ->type_name("NAMES");
  group->add_flag("--layers-outside", o.outside,
                  "Layers grow on the outside, as a shell around the mesh and a region of its own");
  group
      ->add_option("--require-coverage", o.require_coverage,
                   "Percent of each wall's faces that must have all layers, or the run fails with status 4")
      ->type_name("P");
  group->add_flag("--layers-as-tets", o.as_tets, "Layers are tetrahedra also in formats that have wedges");
  a.names.add("count", "--layers");
  a.names.add("in", "--layers-in");
  a.names.add("outside", "--layers-outside");
  a.names.add("as_tets", "--layers-as-tets");
  a.names.add("reynolds", "--Re");
  a.names.add("reference_length", "--Lref");
}

void declare_volume(CLI::App& command, Arguments& a) {
  using Core = VolumeOptions::Core;
  using Ranking = VolumeOptions::Ranking;
  using Order = VolumeOptions::Order;
  VolumeOptions& o = a.options.volume;
  auto* group = command.add_option_group("Volume");
  add_choice<Method>(
      *group, "--method", a.options.method,
      {{"octree-aft", Method::kOctreeAft},
       {"aft", Method::kAft},
       {"octree", Method::kOctree},
       {"recover", Method::kRecover}},
      "octree-aft: the volume front; aft: the classical front, slow, for comparison; octree: a lattice cut at the "
      "surface, fast, also with defects, but not on the input's triangles; recover: the input's triangles kept, with "
      "as few points inside as "
      "possible");
  add_choice<Core>(*group, "--core", o.core, {{"lattice", Core::kLattice}, {"none", Core::kOff}},
                   "lattice: the inside is a lattice, the front fills the shell around it; none: all by the front");
  group->add_option("--ideal-distance", o.ideal_distance, "Ideal point above its face, as a multiple of the size there")
      ->type_name("X")
      ->capture_default_str();
  add_choice<Ranking>(*group, "--ranking", o.ranking,
                      {{"solid-angle", Ranking::kSolidAngle}, {"quality", Ranking::kQuality}}, "Order of candidates");
  add_choice<Order>(
      *group, "--queue", o.order,
      {{"layers", Order::kLayers}, {"smallest", Order::kSmallest}, {"newest", Order::kNewest}},
      "Order of the front's faces: layer by layer, the smallest of each layer first, or the newest first");
  group
      ->add_option("--shell", o.shell,
                   "Layers of flat elements through walls that are thinner than elements are wide; 0: as they come")
      ->type_name("N")
      ->capture_default_str();
}

void add_no_bridging(CLI::App& group, Arguments& a) {
  group.add_flag("--no-bridging", a.options.improve.no_bridging,
                 "Elements with all corners on walls (boundary, walls between regions) get a vertex inside");
}

void declare_improvement(CLI::App& command, Arguments& a) {
  using Level = ImproveOptions::Level;
  ImproveOptions& o = a.options.improve;
  auto* group = command.add_option_group("Improvement");
  add_choice<Level>(*group, "--improve", o.level,
                    {{"none", Level::kOff},
                     {"paper", Level::kPaper},
                     {"fast", Level::kFast},
                     {"default", Level::kDefault},
                     {"best", Level::kBest}},
                    "How the finished mesh is improved");
  using Objective = ImproveOptions::Objective;
  add_choice<Objective>(*group, "--objective", o.objective,
                        {{"balanced", Objective::kBalanced},
                         {"beta", Objective::kBeta},
                         {"min-dihedral", Objective::kMinDihedral},
                         {"max-dihedral", Objective::kMaxDihedral},
                         {"mean-ratio", Objective::kMeanRatio},
                         {"solver", Objective::kSolver}},
                        "What is improved at the worst elements: beta and dihedral angles, one of them alone, the mean "
                        "ratio, or what the checks of structural solvers look at");
  group->add_option("--relaxation", o.relaxation, "phi of the paper's weighted Laplacian")
      ->type_name("PHI")
      ->capture_default_str();
  group->add_option("--improve-time", o.seconds, "Seconds after which no further pass begins (then not repeatable)")
      ->type_name("S");
  group->add_flag_function(
      "--fix-boundary", [&o](std::int64_t) { o.move_boundary = false; },
      "No vertex of the boundary slides on the surface, no edge turns");
  add_no_bridging(*group, a);
  a.names.add("level", "--improve");
  a.names.add("seconds", "--improve-time");
  a.names.add("move_boundary", "--fix-boundary");
}

void declare_requirements(CLI::App& command, Arguments& a, bool of_sizes) {
  RequireOptions& o = a.options.require;
  auto* group = command.add_option_group("Requirements", "A mesh that does not meet them is not written: status 4");
  group
      ->add_option("--require-volume", o.volume,
                   "Percent by which the volume of each region may differ from the input's")
      ->type_name("P");
  group->add_option("--require-angle", o.angle, "Degrees that each dihedral angle has at least")->type_name("DEG");
  if (of_sizes)
    group->add_option("--require-size", o.size, "Times the size wanted there that no edge is longer than; 1 or more")
        ->type_name("F");
}

void declare_ground(CLI::App& command, Arguments& a) {
  auto* group = command.add_option_group("Boundary", "Stays as it is, unless a surface is given");
  group->add_option("--surface", a.surface, "The surface that was meshed: the boundary may slide along it")
      ->type_name("FILE");
  group->add_option("--feature-angle", a.options.surface.feature_angle, "Edges that bend by more degrees are kept [40]")
      ->type_name("DEG");
}

void declare_adaptation(CLI::App& command, Arguments& a) {
  auto* group = command.add_option_group("Adaptation", "The boundary stays on the smooth surface that it stands for");
  group->add_option("--sizes", a.size_field, "Another name of --size-field")->type_name("FILE[:FIELD]");
  group
      ->add_option("--metric", a.metric,
                   "Other lengths in other directions: MEDIT's .sol or .solb, or tensors at the points of a VTU or VTK "
                   "mesh; with --elements scaled to that number, with --gradation, --min-size, --max-size changed so")
      ->type_name("FILE[:FIELD]");
  group
      ->add_option("--from", a.field,
                   "A metric made of a field at the points of the input, for --elements elements: its second "
                   "derivatives say where and in which direction they must be short")
      ->type_name("FIELD");
  group->add_option("--norm", a.norm, "The error of --from is least in the norm of L^P; 1 or more")
      ->type_name("P")
      ->capture_default_str();
  group
      ->add_option("--carry", a.carry,
                   "Fields of the input that go along, by name and with commas between, or none: linear at points, "
                   "conservative in elements; into VTU, VTK and MSH [all]")
      ->delimiter(',')
      ->type_name("FIELD");
  group->add_option("--save-metric", a.metric_out, "Where that metric is written, to look at: .vtu, or MEDIT's .sol")
      ->type_name("FILE");
  group
      ->add_option("--surface", a.surface,
                   "What walls stand for instead, where it is near them: the surface that was meshed, or the CAD file, "
                   "whose true geometry they go to")
      ->type_name("FILE");
  add_length(*group, a, "--max-deviation", a.options.surface.max_deviation,
             "How far the boundary may stray from it [.4 % of the diagonal]")
      ->type_name("D");
  group->add_option("--feature-angle", a.options.surface.feature_angle, "Edges that bend by more degrees are kept [40]")
      ->type_name("DEG");
  group
      ->add_option("--only", a.only,
                   "What may change, all else stays: box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R, or a region, patch, curve "
                   "or set by its name; several times if wanted")
      ->type_name("PLACE");
  group->add_option("--halo", a.options.adapt.halo, "Layers of elements around --only that may change, too [2]")
      ->type_name("N");
  group->add_flag_function(
      "--fix-boundary", [&a](std::int64_t) { a.options.improve.move_boundary = false; },
      "The triangles of the outer boundary stay as they are; lengths grow from there");
  group
      ->add_option("--keep", a.keep,
                   "Faces, edges and vertices that stay as they are: a patch, curve or set by its name, a region for "
                   "the walls around it, or the number of a patch; several times if wanted")
      ->type_name("NAME");
  add_no_bridging(*group, a);
  group
      ->add_option("--map", a.map_file,
                   "Where old vertices and elements are now: .json (two arrays) or .csv, by numbers from 0; -1: gone")
      ->type_name("FILE");
}

void declare_order(CLI::App& command, Arguments& a) {
  add_choice<int>(
      command, "--order", a.options.order, {{"1", 1}, {"2", 2}},
      "2: elements of second order, with mid-side nodes; those of the boundary on the smooth surface that the "
      "input stands for, every element proven valid");
}

void declare_conversion(CLI::App& command, Arguments& a) {
  add_choice<int>(
      command, "--order", a.new_order, {{"keep", 0}, {"1", 1}, {"2", 2}},
      "1: mid-side nodes are dropped; 2: they are added where there are none, in the middle of straight edges");
}

void declare_solver(CLI::App& command, Arguments& a) {
  const Choice<Solver> choice{{{"abaqus", Solver::kAbaqus},
                               {"ansys", Solver::kAnsys},
                               {"nastran", Solver::kNastran},
                               {"calculix", Solver::kCalculix}}};
  command
      .add_option_function<std::string>(
          "--solver", [&a, choice](const std::string& typed) { a.solver = choice.value_of("--solver", typed); },
          "List the elements of a mesh that this solver would warn of or refuse, by its documented limits")
      ->type_name(choice.listed("|"));
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> options = command.get_options();
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!group->get_name().empty()) continue;
    for (const CLI::Option* option : options_of(*group))
      if (option != group->get_help_ptr()) options.push_back(option);  // each group has one of its own
  }
  return options;
}

void note_command(const CLI::App& command, Arguments& a) {
  a.command = command.get_name();
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_lnames().empty()) continue;
    const std::string name = option->get_lnames().front();
    std::string field = name;
    std::replace(field.begin(), field.end(), '-', '_');
    a.names.add(field, "--" + name);
    const bool is_flag = option->get_items_expected_max() == 0;
    if (option->count() > 0) a.given.emplace_back(name, is_flag ? "true" : CLI::detail::join(option->results(), ","));
  }
}

}  // namespace octafront::cli
