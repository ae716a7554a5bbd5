#include "pipeline/stages/checkpoint.h"

#include <octafront/error.h>
#include <octafront/option_table.h>

#include "base/comm/hashing.h"
#include "pipeline/stages/stages.h"
#include "sizing/field/packed_sizes.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// What a file begins with. Its mark changes with what is behind it, and with what makes other meshes.
struct FileHead {
  std::uint64_t mark = 0x6f63'7461'6b65'7031;  // "octakep1"
  std::uint64_t key = 0, size = 0, hash = 0;
};

/// What the run in a folder was made of.
struct MadeOf {
  std::uint64_t version = 0, input = 0, options = 0;
};
constexpr const char* kMadeOf = "run.octafront";
constexpr const char* kEnding = ".octafront";

void add_text(BytesHash& hash, const std::string& text) {
  hash.add(std::vector<char>(text.begin(), text.end()));
}

std::uint64_t hash_of_bytes(const Bytes& bytes) {
  BytesHash hash;
  hash.add(bytes);
  return hash.value();
}

std::uint64_t hash_of_options(const Options& options) {
  BytesHash hash;
  for (const OptionInfo& info : option_table()) {
    add_text(hash, std::string(info.name));
    const OptionValue value = option_value(options, info.name);
    hash.add(value.index());
    if (const auto* flag = std::get_if<bool>(&value)) hash.add(*flag);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) hash.add(*whole);
    if (const auto* number = std::get_if<double>(&value)) hash.add(*number);
    if (const auto* text = std::get_if<std::string>(&value)) add_text(hash, *text);
  }
  return hash.value();
}

MadeOf made_of(const Domain& domain, const Options& options) {
  BytesHash version;
  add_text(version, OCTAFRONT_VERSION);
  version.add(FileHead{}.mark);
  BytesHash input;
  const SurfaceMesh& s = domain.surface;
  input.add(s.points), input.add(s.triangles), input.add(s.patch), input.add(s.sides), input.add(s.source);
  for (const auto* names : {&s.patch_names, &s.region_names})
    for (const std::string& name : *names) add_text(input, name);
  return {version.value(), input.value(), hash_of_options(options)};
}

Bytes packed_in(std::uint64_t key, const Bytes& content) {
  FileHead head;
  head.key = key, head.size = content.size(), head.hash = hash_of_bytes(content);
  Packer file;
  file.bytes().reserve(sizeof head + content.size());
  file.add(head);
  file.bytes().insert(file.bytes().end(), content.begin(), content.end());
  return std::move(file.bytes());
}

/// Nothing if there is no such file, or one that is not whole: it will be made again.
std::optional<Bytes> content_of(const std::string& name, std::uint64_t key) {
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  if (!file) return std::nullopt;
  const auto size = static_cast<std::uint64_t>(file.tellg());
  FileHead head;
  const std::uint64_t mark = head.mark;
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(&head), sizeof head) || head.mark != mark || head.key != key ||
      head.size != size - sizeof head)
    return std::nullopt;
  Bytes content(head.size);
  if (!file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(head.size))) return std::nullopt;
  if (hash_of_bytes(content) != head.hash) return std::nullopt;
  return content;
}

/// Under a name of its own first.
void write_whole(const std::string& name, const Bytes& bytes) {
  const std::string beside = name + ".part";
  std::ofstream file(beside, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(beside, name, error);
  if (file && !error) return;
  std::filesystem::remove(beside, error);
  throw OutputError(fmt::format("{}: what is kept to go on with cannot be written; is there room on the disk?", name));
}

void begin_folder(const std::filesystem::path& folder, const MadeOf& made) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw OutputError(fmt::format("{}: this folder for what is kept cannot be made", folder.string()));
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == kEnding) std::filesystem::remove(entry.path(), error);
  Packer content;
  content.add(made);
  write_whole((folder / kMadeOf).string(), packed_in(0, content.bytes()));
}

void require_same(const std::filesystem::path& folder, const MadeOf& made) {
  const std::optional<Bytes> content = content_of((folder / kMadeOf).string(), 0);
  if (!content || content->size() != sizeof(MadeOf))
    throw InputError(fmt::format("{}: nothing is kept there that a run could go on with; begin one with a checkpoint",
                                 folder.string()));
  const auto there = Unpacker(*content).take<MadeOf>();
  const char* const other = there.version != made.version   ? "by another version"
                            : there.input != made.input     ? "of another input"
                            : there.options != made.options ? "by other options"
                                                            : nullptr;
  if (other != nullptr)
    throw InputError(
        fmt::format("{}: what is kept there was made {}: begin anew with a checkpoint", folder.string(), other));
}

}  // namespace

void open_checkpoint(const Checkpoints& where, const Domain& domain, const Options& options,
                     const RunContext& context) {
  if (where.folder.empty()) return;
  if (options.size.callback)
    throw OptionError("a function of sizes cannot be compared with that of an earlier run: leave out the checkpoint");
  const Comm comm(context.ranks);
  const MadeOf made = made_of(domain, options);
  comm.together("checkpoint", Comm::Telling::kAsIfAlone, [&] {
    if (comm.rank() == 0) where.resume ? require_same(where.folder, made) : begin_folder(where.folder, made);
  });
}

Checkpoint::Checkpoint(const Checkpoints& where, const Prepared& input, const SizeField& sizes, Run& run)
    : where_(where), run_(run) {
  if (where.folder.empty()) return;
  BytesHash hash;
  const SurfaceMesh& s = input.surface.mesh();
  hash.add(hash_of_options(run.options));
  hash.add(s.points), hash.add(s.triangles), hash.add(s.patch), hash.add(s.sides), hash.add(input.bound);
  hash.add(input.surface.features().edges), hash.add(input.surface.features().corners);
  add_text(hash, packed_sizes(sizes));
  key_ = hash.value();
}

std::string Checkpoint::file_of(const char* name, std::uint64_t number) const {
  const std::string file = fmt::format("{:016x}-{:02}-{}{}", key_, number, name, kEnding);
  return (std::filesystem::path(where_.folder) / file).string();
}

std::optional<Bytes> Checkpoint::read(const std::string& file) const {
  if (!where_.resume) return std::nullopt;
  const Comm comm = run_.comm();
  std::optional<Bytes> content;
  comm.together("checkpoint", Comm::Telling::kNamesRank, [&] {
    if (comm.rank() == 0) content = content_of(file, key_);
  });
  std::int64_t found = content.has_value();
  comm.sum(std::span(&found, 1), "checkpoint");
  if (found == 0) return std::nullopt;
  if (comm.alone()) return content;
  return gathered_lists(comm, content ? *content : Bytes(), "checkpoint");  // the others have none
}

void Checkpoint::write(const std::string& file, Bytes content) const {
  const Comm comm = run_.comm();
  comm.together("checkpoint", Comm::Telling::kAsIfAlone, [&] {
    if (comm.rank() == 0) write_whole(file, packed_in(key_, content));
  });
}

}  // namespace octafront
