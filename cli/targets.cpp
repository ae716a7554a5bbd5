#include "targets.h"

#include <octafront/error.h>
#include <octafront/field_files.h>
#include <octafront/io.h>
#include <octafront/named_groups.h>
#include <octafront/share_files.h>
#include <octafront/units.h>

#include "fields.h"
#include "ranks.h"
#include "terminal.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <optional>

#include <fmt/core.h>
#include <unistd.h>

namespace octafront::cli {

namespace {

bool holds_parts(const Arguments& a, std::size_t i) {
  return format_for(a.meshes[i].string(), {.format = a.formats.empty() ? "" : a.formats[i]}).holds.parts;
}

/// Among several outputs those are divided that hold parts, if some do.
bool takes_parts(const Arguments& a, std::size_t i) {
  if (a.writing.parts == 0 || a.meshes.size() == 1 || holds_parts(a, i)) return true;
  for (std::size_t other = 0; other < a.meshes.size(); ++other)
    if (holds_parts(a, other)) return false;
  return true;
}

/// How the output of this number is written.
WriteOptions options_of(const Arguments& a, std::size_t i) {
  WriteOptions options = a.writing;
  if (a.command == "mesh") options.speed = a.options.layers.speed, options.fluid = a.options.layers.fluid;
  if (!a.formats.empty()) options.format = a.formats[i];
  if (a.meshes.size() > 1) {  // beside a job or a case other outputs are the mesh alone
    const FormatInfo& format = format_for(a.meshes[i].string(), {.format = options.format});
    if (!format.holds.jobs) options.job.reset();
    if (format.name != "openfoam") options.deck = false;
  }
  if (!takes_parts(a, i)) options.parts = 0, options.partitioner = Partitioner::kCurve, options.split_files = false;
  return options;
}

/// Of an input without a unit nobody knows what they would be.
std::vector<JobDensity> densities_of_job(const std::vector<std::pair<std::string, double>>& of_input,
                                         const std::string& unit) {
  std::vector<JobDensity> all;
  if (const LengthUnit* length = unit_named(unit); length != nullptr)
    for (const auto& [part, density] : of_input) all.push_back({part, density_with_newtons(density, *length)});
  return all;
}

bool is_null(const std::filesystem::path& file) {
  return file == "/dev/null";
}

/// What goes to no file has no ending.
void check_format(const std::filesystem::path& file, const std::string& format) {
  if (format.empty())
    throw OptionError(fmt::format("-o {} has no ending: say which format is written, with --format", file.string()));
}

void check_pipe(const std::filesystem::path& file, const WriteOptions& options) {
  const std::string& format = options.format;
  check_format(file, format);
  if (options.split_files) throw OptionError("--split-files makes several files: they cannot go to standard output");
  if (options.job && format == "med")
    throw OptionError("a job for code_aster is several files: it cannot go to standard output");
  for (const FormatInfo& info : known_formats())
    if (info.writes_mesh && info.name == format && !info.one_file)
      throw OptionError(fmt::format("{} is written to several files: it cannot go to standard output", info.title));
  // A terminal of mpirun's own, which would change bytes.
  if (isatty(STDOUT_FILENO) && launch_of_environment().size > 1)
    throw OptionError("-o -: mpirun takes what processes print for text; give a file");
  if (isatty(STDOUT_FILENO))
    throw OptionError("-o -: standard output is a terminal; send it to a file or a pipe: octafront ... > FILE");
}

#ifdef _WIN32
/// As POSIX has it: a folder of a name that nobody has; its last six characters are chosen.
char* mkdtemp(char* name) {
  constexpr int kTries = 100;
  std::random_device number;
  std::error_code error;
  const std::string_view text(name);
  for (int tries = 0; tries < kTries && !error; ++tries) {
    for (std::size_t i = text.size() - 6; i < text.size(); ++i) name[i] = static_cast<char>('a' + number() % 26);
    if (std::filesystem::create_directory(name, error)) return name;
  }
  return nullptr;
}
#endif

/// A folder of our own for as long as it lives.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "octafront-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw OutputError(fmt::format("{}: no temporary folder can be made; set TMPDIR to one that is writable", name));
    folder_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

void copy_to_standard_output(const std::filesystem::path& file, const RunContext& context) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 1 << 16> buffer{};
  while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0) {
    context.check();
    const auto size = static_cast<std::size_t>(in.gcount());
    if (std::fwrite(buffer.data(), 1, size, stdout) != size) throw OutputError("standard output cannot be written");
  }
}

/// Formats go back in their files, so that a pipe gets a file that is complete.
std::vector<std::string> write_one(const std::filesystem::path& file, const TetMesh& mesh,
                                   std::span<const MeshField> fields, const WriteOptions& options,
                                   const RunContext& context) {
  if (file != kStandardOutput && !is_null(file)) return write_mesh(file.string(), mesh, fields, context, options);
  const TemporaryFolder folder;
  const std::filesystem::path whole = folder.file("mesh");
  std::vector<std::string> notes = write_mesh(whole.string(), mesh, fields, context, options);
  if (is_null(file)) return notes;
  clear_progress();
  copy_to_standard_output(whole, context);
  return notes;
}

}  // namespace

void check_mesh_targets(const Arguments& a) {
  if (a.meshes.empty())
    throw OptionError(fmt::format("--output is required: where the mesh goes, such as -o {}.vtu",
                                  a.input.stem().empty() ? "mesh" : a.input.stem().string()));
  if (!a.formats.empty() && a.formats.size() != a.meshes.size())
    throw OptionError(fmt::format("--format is given {} and -o {} times: give each output its format, in turn",
                                  a.formats.size(), a.meshes.size()));
  check_asked_fields(a);
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    const WriteOptions options = options_of(a, i);
    if (a.meshes[i] == kStandardOutput)
      check_pipe(a.meshes[i], options);
    else if (is_null(a.meshes[i]))
      check_format(a.meshes[i], options.format);
    else
      check_mesh_target(a.meshes[i].string(), options);
  }
}

bool some_target_holds_fields(const Arguments& a) {
  for (std::size_t i = 0; i < a.meshes.size(); ++i)
    if (format_for(a.meshes[i].string(), options_of(a, i)).holds.fields) return true;
  return false;
}

void check_surface_targets(const Arguments& a) {
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    const FormatInfo& format = format_for(a.meshes[i].string(), options_of(a, i));
    if (!format.holds.surfaces_alone)
      throw OptionError(
          fmt::format("-o {}: the input is a surface alone, and {} holds meshes of tetrahedra; write .ply, .stl, .obj, "
                      ".off, .vtu, .vtk, .msh, .mesh or .meshb",
                      a.meshes[i].string(), format.title));
  }
}

void write_mesh_targets(Session& session, const TetMesh& as_it_is, std::span<const MeshField> fields,
                        std::vector<std::string> told) {
  const Arguments& a = session.arguments();
  std::optional<TetMesh> grouped;
  // generate() has added those of the mesh that it made.
  const std::vector<std::string> groups = a.command == "mesh" ? std::vector<std::string>() : a.options.groups;
  if (!groups.empty() || a.material_bins > 0) grouped = as_it_is;
  const TetMesh& mesh = grouped ? *grouped : as_it_is;
  std::vector<std::string> group_notes;
  for (const std::string& group : groups)
    if (std::string note = add_group(*grouped, group_rule(group)); !note.empty())
      group_notes.push_back(std::move(note));
  std::vector<MeshField> all_fields(fields.begin(), fields.end());
  add_asked_fields(session, mesh, all_fields);
  const std::vector<SetMaterial> materials =
      a.material_bins > 0 ? bins_asked(session, *grouped, all_fields) : std::vector<SetMaterial>{};
  Json all = Json::array();
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    session.context().report("writing", -1);
    WriteOptions options = options_of(a, i);
    options.materials = materials;
    if (options.unit.empty()) options.unit = session.unit.empty() ? a.unit : session.unit;
    if (options.job) options.job->densities = densities_of_job(session.densities, options.unit);
    std::vector<std::string> notes = write_one(a.meshes[i], mesh, all_fields, options, session.context());
    session.warn("writing", group_notes);
    session.say_notes("writing", notes);
    for (std::vector<std::string>* first : {&group_notes, &told}) {
      notes.insert(notes.begin(), first->begin(), first->end());
      first->clear();
    }
    all.push_back({{"file", a.meshes[i].string()}, {"notes", notes}});
  }
  session.found({{"output", all[0]}});
  if (all.size() > 1) session.found({{"outputs", all}});
}

void recommend_second_order(const Arguments& a, Report& report) {
  constexpr std::array kOfStructures{"abaqus", "nastran", "ansys", "lsdyna", "febio", "unv", "med"};
  if (report.true_volume == 0 || a.options.order > 1 || report.stages.empty()) return;
  bool is_for_structures = false;
  for (std::size_t i = 0; i < a.meshes.size(); ++i)
    is_for_structures |= std::ranges::find(kOfStructures, format_for(a.meshes[i].string(), options_of(a, i)).name) !=
                         kOfStructures.end();
  if (!is_for_structures) return;
  report.stages.back().note(
      {"first-order",
       "these are elements of first order, which are 6 to 29 % off in the stress of notches where a tenth of the "
       "unknowns in second order are as true or truer (docs/measured/answers.md): `order` 2, whose automatic sizes are "
       "twice as large",
       ""});
}

bool takes_shares(const Arguments& a) {
  const auto is_pvtu = [&](std::size_t i) { return format_for(a.meshes[i].string(), options_of(a, i)).name == "pvtu"; };
  for (std::size_t i = 0; i < a.meshes.size(); ++i)
    if (!is_pvtu(i)) return false;
  return a.writing.parts == 0 && a.page.empty() && a.options.groups.empty() && !asks_for_fields(a) &&
         !a.writing.ascii && !a.writing.cells_only;
}

void write_share_targets(Session& session, const TetMesh& share) {
  Json all = Json::array();
  for (const std::filesystem::path& file : session.arguments().meshes) {
    session.context().report("writing", -1);
    const std::vector<std::string> notes = write_shares(file.string(), share, session.context());
    session.say_notes("writing", notes);
    all.push_back({{"file", file.string()}, {"notes", notes}});
  }
  session.found({{"output", all[0]}});
  if (all.size() > 1) session.found({{"outputs", all}});
}

void write_text_target(const std::filesystem::path& file, const std::string& text) {
  if (file != kStandardOutput) return write_text(file.string(), text);
  clear_progress();
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    throw OutputError("standard output cannot be written");
}

}  // namespace octafront::cli
