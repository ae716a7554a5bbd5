#include "formats/parts/mesh_output.h"

#include <octafront/error.h>

#include <cstdio>
#include <limits>
#include <system_error>

#include <fmt/core.h>
#ifndef _WIN32
#include <fcntl.h>
#endif

namespace octafront::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, std::string_view what, const std::error_code& error) {
  throw OutputError(
      fmt::format("{}: {}: {}; an older one of this name is unchanged", file.string(), what, error.message()));
}

/// Whether two folders could swap their names in one step: who is killed has one of them under its name at any time.
bool exchanged([[maybe_unused]] const fs::path& a, [[maybe_unused]] const fs::path& b) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  return false;
#endif
}

/// A file or folder takes the place of an older one, which goes only then.
void put_in_place(const fs::path& temporary, const fs::path& final) {
  std::error_code error;
  if (!fs::is_directory(temporary, error)) {
    fs::rename(temporary, final, error);
    if (error) fail(final, "cannot be renamed into place", error);
    return;
  }
  if (final.has_parent_path()) fs::create_directories(final.parent_path(), error);
  if (exchanged(temporary, final)) {
    fs::remove_all(temporary, error);
    return;
  }
  const fs::path old = temporary.string() + ".old";
  if (fs::exists(final)) fs::rename(final, old, error);
  if (error) fail(final, "cannot be replaced", error);
  fs::rename(temporary, final, error);
  if (error) {
    std::error_code ignored;
    fs::rename(old, final, ignored);
    fail(final, "cannot be renamed into place", error);
  }
  fs::remove_all(old, error);
}

}  // namespace

MeshOutput::~MeshOutput() {
  std::error_code ignored;
  for (const Pending& p : pending_)
    if (!p.temporary.empty()) fs::remove_all(p.temporary, ignored);
  if (!scratch_.empty()) fs::remove_all(scratch_, ignored);
}

AtomicFile& MeshOutput::file() {
  return *files_.emplace_back(std::make_unique<AtomicFile>(target_, context_));
}

AtomicFile& MeshOutput::sibling(const std::string& ending) {
  return beside(fs::path(target_).replace_extension(ending).filename().string());
}

AtomicFile& MeshOutput::beside(const std::string& name) {
  return *files_.emplace_back(std::make_unique<AtomicFile>(target_.parent_path() / name, context_));
}

fs::path MeshOutput::path_for_library(const std::string& name) {
  return (name.empty() ? file() : beside(name)).path_for_library();
}

fs::path MeshOutput::folder(const fs::path& final) {
  // On the disk where it will be, in a folder that is there.
  fs::path at = final;
  std::error_code error;
  while (at.has_parent_path() && !fs::exists(at.parent_path(), error)) at = at.parent_path();
  const fs::path temporary = temporary_beside(at);
  fs::create_directory(temporary, error);
  if (error) fail(final, "cannot be created", error);
  pending_.push_back({temporary, final});
  return temporary;
}

fs::path MeshOutput::piece_file(const std::string& name) {
  if (scratch_.empty()) {
    const fs::path temporary = temporary_beside(target_);
    std::error_code error;
    fs::create_directory(temporary, error);
    if (error) fail(target_, "cannot be created", error);
    scratch_ = temporary;
  }
  pending_.push_back({scratch_ / name, target_.parent_path() / name});
  return pending_.back().temporary;
}

void MeshOutput::require_32_bits(std::size_t items, std::string_view why) const {
  if (items > std::numeric_limits<std::int32_t>::max()) throw OutputError(fmt::format("{}: {}", target_.string(), why));
}

void MeshOutput::commit() {
  context_.check();
  // All that may fail for lack of room comes before the first name changes.
  for (const auto& file : files_) file->flush_to_disk();
  for (Pending& p : pending_) {
    put_in_place(p.temporary, p.final);
    p.temporary.clear();
  }
  // The file that was asked for comes last: where it is, all are.
  for (std::size_t i = files_.size(); i-- > 0;) files_[i]->commit();
}

}  // namespace octafront::io
