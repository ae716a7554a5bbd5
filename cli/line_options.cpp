#include "line_options.h"

#include <octafront/io.h>

#include "image_arguments.h"
#include "job_options.h"
#include "picture_options.h"
#include "units.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

constexpr std::string_view kWriters = "mesh improve adapt carry move convert";
constexpr std::string_view kSizers = "mesh surface size adapt";
constexpr std::string_view kSurfaces = "mesh surface size";
constexpr std::string_view kAll = "mesh surface repair size improve adapt carry move convert info check report picture";

/// One value, or a list of them, that goes to `where(arguments)`.
template <class Access>
Add value(const Access& where) {
  return [where](CLI::App& app, const LineOption& o, Arguments& a) {
    return app.add_option(std::string(o.names), where(a), o.help)->type_name(std::string(o.letter));
  };
}

template <class Access>
Add flag(const Access& where) {
  return [where](CLI::App& app, const LineOption& o, Arguments& a) {
    return app.add_flag(std::string(o.names), where(a), o.help);
  };
}

/// A file, or what else is one value, without which the command does nothing.
template <class Access>
Add needed(const Access& where) {
  return [add = value(where)](CLI::App& app, const LineOption& o, Arguments& a) { return add(app, o, a)->required(); };
}

/// A number, with its option for messages.
template <class Take>
Add number(const Take& take) {
  return [take](CLI::App& app, const LineOption& o, Arguments& a) {
    return app
        .add_option_function<double>(
            std::string(o.names), [&a, take, option = std::string(o.names)](double n) { take(a, option, n); }, o.help)
        ->type_name(std::string(o.letter));
  };
}

/// Lists that take one value each time.
Add list_of(std::vector<std::filesystem::path> Arguments::*list) {
  return [list](CLI::App& app, const LineOption& o, Arguments& a) {
    return app.add_option(std::string(o.names), a.*list, o.help)
        ->type_name(std::string(o.letter))
        ->transform([](const std::string& file) { return file == "/dev/stdout" ? std::string("-") : file; })
        ->allow_extra_args(false);
  };
}

template <class Value, class Set>
Add choice_of(const std::vector<std::pair<std::string, Value>>& names, const Set& set) {
  return [choice = Choice<Value>{names}, set](CLI::App& app, const LineOption& o, Arguments& a) {
    return app
        .add_option_function<std::string>(
            std::string(o.names),
            [&a, choice, set, option = std::string(o.names)](const std::string& typed) {
              set(a, choice.value_of(option, typed));
            },
            o.help)
        ->type_name(choice.listed("|"));
  };
}

/// ".vtu, .msh (Gmsh MSH 4.1), ..."
std::string formats_that(bool FormatInfo::*can) {
  std::string all;
  for (const FormatInfo& info : known_formats())
    if (info.*can && !info.endings.empty() && !info.writes_surface)
      all += (all.empty() ? "" : ", ") + std::string(info.endings.substr(0, info.endings.find(' ')));
  return all;
}

std::string names_of_formats() {
  std::string all;
  for (const FormatInfo& info : known_formats())
    if (info.writes_mesh) all += (all.empty() ? "" : ", ") + std::string(info.name);
  return all;
}

/// The three numbers of "x,y,z"; none: it is no point.
std::optional<Vec3> point_in(const std::string& list) {
  std::vector<double> numbers;
  for (const std::string& word : CLI::detail::split(list, ',')) {
    double value = 0;
    if (CLI::detail::lexical_cast(word, value) && std::isfinite(value)) numbers.push_back(value);
  }
  if (numbers.size() != 3 || std::count(list.begin(), list.end(), ',') != 2) return std::nullopt;
  return Vec3{numbers[0], numbers[1], numbers[2]};
}

/// A point as "x,y,z".
Vec3 point_of(const std::string& option, const std::string& typed, const std::string& list) {
  const std::optional<Vec3> point = point_in(list);
  if (!point)
    throw CLI::ValidationError(option, "\"" + typed + "\" does not end with a point; write its coordinates as X,Y,Z");
  return *point;
}

/// NAME=thickness:LO..HI or NAME=.6*thickness:LO..HI.
NamedSize size_by_thickness(const std::string& name, const std::string& before, const std::string& range) {
  NamedSize named{name, 0, 1, 0};
  const std::size_t dots = range.find("..");
  const auto is_number = [](const std::string& word, double& value) { return CLI::detail::lexical_cast(word, value); };
  const bool has_factor =
      before.empty() || (before.ends_with('*') && is_number(before.substr(0, before.size() - 1), named.of_thickness));
  if (!has_factor || dots == std::string::npos || !is_number(range.substr(0, dots), named.size) ||
      !is_number(range.substr(dots + 2), named.most))
    throw CLI::ValidationError("--size-of",
                               "\"" + name + "=" + before + "thickness:" + range +
                                   "\" is no size by thickness; write NAME=thickness:1..5 or NAME=.6*thickness:1..10");
  return named;
}

/// PLACE=H, where the place may have signs of equality of its own.
NamedSize named_size(const std::string& text) {
  const std::size_t at = text.rfind('=');
  if (const std::size_t by = text.find("thickness:", at + 1); at != std::string::npos && at > 0 && by != text.npos)
    return size_by_thickness(text.substr(0, at), text.substr(at + 1, by - at - 1), text.substr(by + 10));
  double size = 0;
  if (at == std::string::npos || at == 0 || !CLI::detail::lexical_cast(text.substr(at + 1), size))
    throw CLI::ValidationError("--size-of", "\"" + text + "\" is not NAME=H, the name of a part and a size");
  return {text.substr(0, at), size};
}

/// A=B, divided at the last or the first sign; `how`: it is written. Throws OptionError.
std::pair<std::string, std::string> named_value(const std::string& typed, const char* how, bool at_last) {
  const std::size_t equals = at_last ? typed.rfind('=') : typed.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == typed.size())
    throw OptionError(fmt::format("\"{}\" has no value or no name; {}", typed, how));
  return {CLI::detail::trim_copy(typed.substr(0, equals)), CLI::detail::trim_copy(typed.substr(equals + 1))};
}

/// FIELD or FIELD=VALUE.
std::pair<std::string, double> level_set(const std::string& typed) {
  const std::size_t equals = typed.rfind('=');
  double value = 0;
  if (equals == std::string::npos) return {typed, value};
  if (equals == 0 || !CLI::detail::lexical_cast(typed.substr(equals + 1), value) || !std::isfinite(value))
    throw CLI::ValidationError("--level-set", "\"" + typed + "\" is not FIELD=VALUE, the name of a field and a number");
  return {typed.substr(0, equals), value};
}

/// PLACE=H:DISTANCE or X,Y,Z=H:DISTANCE.
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
  if (const std::optional<Vec3> point = point_in(place))
    near.point = *point;
  else
    near.name = place;
  return near;
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

std::vector<LineOption> output_options() {
  constexpr std::string_view kGroup = "Output";
  return {
      {kWriters, kGroup, "-o,--output", "FILE",
       "Mesh, its format by the ending: " + formats_that(&FormatInfo::writes_mesh) +
           "; several: each is written; -: to standard output, alone, with --format; /dev/null: nowhere, with --format",
       list_of(&Arguments::meshes), "Mesh, its format by the ending: .vtu, .msh, .inp, .med, ..."},
      {"surface repair", kGroup, "-o,--output", "FILE", "Surface: .stl, .obj, .off or .ply",
       needed([](Arguments & a) -> auto& { return a.output; }), "Surface: .stl, .obj, .off or .ply"},
      {"size", kGroup, "-o,--output", "FILE", "Background grid: .vtu",
       value([](Arguments & a) -> auto& { return a.output; }), "Background grid: .vtu"},
      {"picture", kGroup, "-o,--output", "FILE", "Picture: .png",
       needed([](Arguments & a) -> auto& { return a.output; }), "Picture: .png"},
      {"report", kGroup, "-o,--output", "FILE", "Web page: .html, one file that needs no network",
       needed([](Arguments & a) -> auto& { return a.output; }), "Web page: .html, one file that needs no network"},
      {kWriters, kGroup, "--format", "NAME",
       "Format by name, whatever the ending; for several outputs once for each: " + names_of_formats(),
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         return app.add_option(std::string(o.names), a.formats, o.help)->type_name("NAME")->allow_extra_args(false);
       }},
      {kWriters, kGroup, "--group", "NAME=PLACE",
       "Add a set of what lies at a place: NAME=box:X0,Y0,Z0,X1,Y1,Z1 or NAME=sphere:X,Y,Z,R of nodes, "
       "NAME=elements:box:... and NAME=faces:box:... of others, NAME=patches:A,B, or NAME=NAME of what has a name; of "
       "CAD "
       "also of what is like something: \"holes=cylinders of radius 3\"",
       each([](Arguments& a, const std::string& typed) {
         group_rule(typed);  // refused at once if it is none
         a.options.groups.push_back(typed);
       })},
      {kWriters, kGroup, "--sample", "IMAGE=NAME",
       "Values of an image as the field NAME of elements (the mean of their voxels) and nodes (linear between voxels), "
       "in formats that hold fields: --sample ct.nii.gz=HU",
       each([](Arguments& a, const std::string& typed) {
         a.samples.push_back(named_value(typed, "write IMAGE=NAME, such as ct.nii.gz=HU", true));
       })},
      {kWriters, kGroup, "--field", "NAME=FORMULA",
       "A field by a formula of others and of x, y, z: --field \"E=10500*max(.01,.0011*HU)^2.29\"; in turn",
       each([](Arguments& a, const std::string& typed) {
         a.formulas.push_back(named_value(typed, "write NAME=FORMULA, such as \"rho=.0011*HU+.05\"", false));
       })},
      {kWriters, kGroup, "--material-bins", "N",
       "Sets of elements by the last of these fields, for N equal parts of its range; their mean values are told, and "
       "Abaqus files get a material and a section for each where the field is called E",
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         constexpr std::uint32_t kMost = 10'000;
         return app.add_option(std::string(o.names), a.material_bins, o.help)
             ->type_name("N")
             ->check(CLI::Range(std::uint32_t{1}, kMost));
       }},
      {kWriters, kGroup, "--poisson", "NU", "Poisson's ratio of these materials [.3]",
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         return app.add_option(std::string(o.names), a.writing.poissons_ratio, o.help)
             ->type_name("NU")
             ->check(CLI::Range(-1.0, 0.5));
       }},
      {"mesh improve adapt", kGroup, "--report", "FILE.html",
       "Write a web page with the mesh in 3D and all numbers, in one file that needs no network",
       value([](Arguments & a) -> auto& { return a.page; }), "A web page with the mesh in 3D and all numbers"},
      {kAll, kGroup, "--json", "FILE",
       "Write the report as JSON, also of a run that fails; -: to standard output, alone",
       value([](Arguments & a) -> auto& { return a.json; }), "The report as JSON; -: to standard output"},
      {"convert", kGroup, "--order", "",
       "1: nodes behind the corners are dropped; 2, 3, 4: the mesh gets those of this order, with straight edges, "
       "unless "
       "it has it [keep]",
       choice_of<int>({{"keep", 0}, {"1", 1}, {"2", 2}, {"3", 3}, {"4", 4}},
                      [](Arguments& a, int order) { a.new_order = order; })},
  };
}

std::vector<LineOption> size_options() {
  constexpr std::string_view kGroup = "Sizes";
  return {
      {"mesh", kGroup, "--preset", "",
       "draft: automatic sizes with about a quarter of the elements, improved fast; fine: with eight times as many, "
       "improved best; head: sizes of a head's labels by their thickness, in mm; options that are given go before "
       "[standard]",
       choice_of<Preset>({{"draft", Preset::kDraft},
                          {"standard", Preset::kStandard},
                          {"fine", Preset::kFine},
                          {"head", Preset::kHead}},
                         [](Arguments& a, Preset preset) { a.preset = preset; }),
       "How fine automatic sizes are, and how long the mesh is improved"},
      {kSizers, kGroup, "--size-of", "PLACE=H",
       "Edge length at a place: in and around a region, on a patch, along a curve, in box:... or sphere:...; of CAD "
       "also \"color #ff8000\" or \"layer NAME\"; NAME=[F*]thickness:LO..HI: of a region F times its thickness, "
       "within a range; may be repeated",
       each([](Arguments& a, const std::string& typed) { a.options.size.named.push_back(named_size(typed)); }),
       "Edge length in a region, on a patch or along a curve"},
      {kSizers, kGroup, "--size-near", "PLACE|X,Y,Z=H:DISTANCE",
       "Edge length H at a place or point, rising to nothing asked at the distance; may be repeated",
       each([](Arguments& a, const std::string& typed) { a.options.size.near.push_back(near_size(typed)); }),
       "Edge length at a place or point, growing from there"},
      {kSizers, kGroup, "--regions", "FILE",
       "Boxes, spheres and points with a size each: JSON, or a table x, y, z, size",
       value([](Arguments & a) -> auto& { return a.regions; })},
      {kSizers, kGroup, "--point-sizes", "FILE",
       "Sizes at the vertices of the surface: VTU, VTP (array \"size\"), or a table x, y, z, size",
       value([](Arguments & a) -> auto& { return a.point_sizes; })},
      {kSizers, kGroup, "--size-field", "FILE[:FIELD]",
       "A mesh of tetrahedra or triangles with a field of sizes, at points or in elements, by its name (VTU, VTK, "
       "Gmsh, MEDIT .sol, TetGen .mtr, XDMF, MED); or all sizes, as `octafront size -o` writes them, edited or not, "
       "alone",
       value([](Arguments & a) -> auto& { return a.size_field; })},
      {kSizers, kGroup, "--unit", "",
       "What the input's coordinates count, for lengths with a unit; OBJ files may say it. Of CAD files what comes out "
       "counts it, and what lengths are given [mm]",
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         return app.add_option(std::string(o.names), a.unit, o.help)->type_name(names_of_units("|"));
       }},
  };
}

std::vector<LineOption> body_options() {
  return {
      {"mesh surface size repair check", "Several materials", "--region", "NAME=X,Y,Z",
       "The cell of this point is a region of this name; cells of one name are one region",
       each([](Arguments& a, const std::string& typed) { a.intake.complex.regions.push_back(region_seed(typed)); })},
      {"mesh surface size repair check", "Several materials", "--void", "X,Y,Z", "The cell of this point stays empty",
       each([](Arguments& a, const std::string& typed) {
         a.intake.complex.voids.push_back(point_of("--void", typed, typed));
       })},
      {"mesh surface", "Inside", "--sheet", "[NAME=]FILE",
       "An open or closed surface whose triangles become faces inside: a crack, a fault; what lies outside is cut off",
       each([](Arguments& a, const std::string& typed) { a.intake.inside.sheet_files.push_back(typed); })},
      {"mesh surface", "Inside", "--wire", "[NAME=]FILE",
       "Lines that become edges: OBJ, PLY, VTK, MSH, or a table of points, polygons end at empty lines",
       each([](Arguments& a, const std::string& typed) { a.intake.inside.wire_files.push_back(typed); })},
      {"mesh surface", "Inside", "--points", "[NAME=]FILE", "Points that become nodes: the same files",
       each([](Arguments& a, const std::string& typed) { a.intake.inside.point_files.push_back(typed); })},
      {"mesh surface size repair", "Repair", "--defects", "FILE.ply",
       "Show what was changed: a surface with a mark at each place, a patch each kind",
       value([](Arguments & a) -> auto& { return a.defects; })},
  };
}

std::vector<LineOption> adapt_options() {
  constexpr std::string_view kGroup = "Adaptation";
  return {
      {"improve", kGroup, "--surface", "FILE", "The surface that was meshed: the boundary may slide along it",
       value([](Arguments & a) -> auto& { return a.surface; }),
       "The surface that was meshed: the boundary may slide along it"},
      {"adapt", kGroup, "--sizes", "FILE[:FIELD]", "Another name of --size-field",
       value([](Arguments & a) -> auto& { return a.size_field; }), "A mesh with a field of sizes, by its name"},
      {"adapt", kGroup, "--metric", "FILE[:FIELD]",
       "Other lengths in other directions: MEDIT's .sol or .solb, or tensors at the points of a VTU or VTK mesh; with "
       "--elements scaled to that number, with --gradation, --min-size, --max-size changed so",
       value([](Arguments & a) -> auto& { return a.metric; }),
       "Other lengths in other directions: MEDIT's .sol, or VTU"},
      {"adapt", kGroup, "--from", "FIELD",
       "A metric made of a field at the points of the input, for --elements elements: its second derivatives say where "
       "and in which direction they must be short",
       value([](Arguments & a) -> auto& { return a.field; }), "A metric made of a field of the input, with --elements"},
      {"adapt", kGroup, "--norm", "P", "The error of --from is least in the norm of L^P; 1 or more [2]",
       value([](Arguments & a) -> auto& { return a.norm; })},
      {"adapt", kGroup, "--level-set", "FIELD[=VALUE]",
       "The surface where a field at points of the input has a value [0] becomes faces: a region FIELD below it, a "
       "patch "
       "FIELD_surface; sizes stay unless others are asked for; several: the first that holds a place names its region",
       each([](Arguments& a, const std::string& typed) { a.level_sets.push_back(level_set(typed)); }),
       "The surface where a field has a value becomes faces"},
      {"adapt", kGroup, "--save-metric", "FILE", "Where that metric is written, to look at: .vtu, or MEDIT's .sol",
       value([](Arguments & a) -> auto& { return a.metric_out; })},
      {"adapt", kGroup, "--surface", "FILE",
       "What walls stand for instead, where it is near them: the surface that was meshed, or the CAD file, whose true "
       "geometry they go to",
       value([](Arguments & a) -> auto& { return a.surface; }), "The surface or CAD file that was meshed"},
      {"adapt", kGroup, "--map", "FILE",
       "Where old vertices and elements are now: .json (two arrays) or .csv, by numbers from 0; -1: gone",
       value([](Arguments & a) -> auto& { return a.map_file; })},
  };
}

std::vector<LineOption> field_options() {
  return {
      {"move", "Motion", "--displacement", "FIELD",
       "The field of the input, three numbers at each point, that it moves by",
       value([](Arguments & a) -> auto& { return a.displacement; }), "The field at points that the mesh moves by"},
      {"improve adapt carry move", "Fields", "--carry", "FIELD",
       "Fields of the input that go along, by name and with commas between, or none: linear at points, conservative in "
       "elements; into formats that hold fields [all]",
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         return app.add_option(std::string(o.names), a.carry, o.help)->delimiter(',')->type_name(std::string(o.letter));
       }},
  };
}

std::vector<LineOption> run_options() {
  constexpr std::string_view kGroup = "Run";
  return {
      {"check", kGroup, "--solver", "",
       "List the elements of a mesh that this solver would warn of or refuse, by its documented limits",
       choice_of<Solver>({{"abaqus", Solver::kAbaqus},
                          {"ansys", Solver::kAnsys},
                          {"nastran", Solver::kNastran},
                          {"calculix", Solver::kCalculix}},
                         [](Arguments& a, Solver solver) { a.solver = solver; })},
      {"mesh", kGroup, "--dry-run", "", "Say how many elements, how much memory and time it would take; make nothing",
       flag([](Arguments & a) -> auto& { return a.dry_run; }),
       "Say how many elements, memory and time it would take; make nothing"},
      {kAll, kGroup, "--threads", "N",
       "Threads at most, never more than the machine has; 0: all. The result is the same",
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         return app.add_option(std::string(o.names), a.threads, o.help)
             ->check(CLI::Range(0, 1024).description(""))
             ->type_name(std::string(o.letter));
       },
       "Threads at most; 0: all. The result is the same"},
      {kAll, kGroup, "--memory", "SIZE",
       "Memory at most: 500MB, 8GB, or bytes; what takes more is refused [what the machine has]",
       each([](Arguments& a, const std::string& typed) { a.limits.memory = bytes_of(typed); })},
      {kAll, kGroup, "--max-elements", "N", "Elements at most; what has or makes more is refused",
       number([](Arguments& a, const std::string& option, double n) {
         if (!(n >= 1)) throw CLI::ValidationError(option, "is a number of elements, 1 or more");
         a.limits.elements = static_cast<std::uint64_t>(whole_number(option, n));
       })},
      {kAll, kGroup, "--cpu-seconds", "S", "CPU seconds of all threads at most; then the run ends without a result",
       number([](Arguments& a, const std::string& option, double seconds) {
         if (!(seconds > 0)) throw CLI::ValidationError(option, "is a number of seconds above 0");
         a.limits.cpu_seconds = seconds;
       })},
      {kAll, kGroup, "--within", "FOLDER",
       "Files are read and written only in this folder and below, links followed, also those that other files name; "
       "may "
       "be repeated [anywhere]",
       each([](Arguments& a, const std::string& typed) { a.limits.folders.push_back(typed); })},
      {kAll, kGroup, "-q,--quiet", "", "Print nothing but errors",
       flag([](Arguments & a) -> auto& { return a.quiet; })},
  };
}

}  // namespace

const std::vector<OptionGroup>& option_groups() {
  static const std::vector<OptionGroup> groups{
      {"Output", "output", ""},
      {"Jobs", "jobs", "Abaqus, CalculiX, Nastran: the output is a job that a solver runs (docs/use/jobs.md)"},
      {"Sizes", "sizes", "None given: an automatic size. Several: the smallest wins"},
      {"Surface", "surface", ""},
      {"Elements", "elements", ""},
      {"Boundary layers", "layers", ""},
      {"Volume", "volume", ""},
      {"Improvement", "improve", ""},
      {"Requirements", "require", "A mesh that does not meet them is not written: status 4"},
      {"Picture", "picture", ""},
      {"Adaptation", "adapt", "The boundary stays on the smooth surface that it stands for"},
      {"Motion", "move", "In steps as long as elements allow, mended between them"},
      {"Fields", "fields", "What is known on the mesh goes along: at points linear, in elements conservative"},
      {"Several materials", "materials", "Cells between walls, or bodies of several files"},
      {"Inside", "inside", "What lies in the bodies and is part of their mesh, by the names of its files"},
      {"Images", "images", "Voxels: a region per label, or per band of grey values"},
      {"Formulas", "formulas", "A body where a formula is below 0, such as 'gyroid(x,y,z) - 0.3'"},
      {"Repair", "repair", "Surfaces that cannot be meshed as they are"},
      {"CAD", "cad", "STEP, IGES, BREP"},
      {"Periodic cell", "periodic", ""},
      {"Flows", "flows", ""},
      {"Paper", "paper", "Of the methods that this program began with; few need them"},
      {"Run", "run", ""}};
  return groups;
}

const std::vector<LineOption>& line_options() {
  static const std::vector<LineOption> all = [] {
    std::vector<LineOption> list;
    for (const auto& part : {output_options(), job_options(), size_options(), body_options(), image_line_options(),
                             adapt_options(), field_options(), picture_options(), run_options()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

RegionSeed region_seed(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw CLI::ValidationError("--region", "\"" + typed + "\" has no name; write NAME=X,Y,Z");
  return {typed.substr(0, equals), point_of("--region", typed, typed.substr(equals + 1))};
}

std::int64_t whole_number(const std::string& option, double n) {
  if (!(std::abs(n) < 9e18) || n != std::floor(n))
    throw CLI::ValidationError(option, "needs a whole number, such as 100000 or 1e5");
  return static_cast<std::int64_t>(n);
}

}  // namespace octafront::cli
