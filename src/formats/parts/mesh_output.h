#pragma once

#include <octafront/io.h>
#include <octafront/mesh_field.h>

#include "formats/containers/atomic_file.h"
#include "formats/parts/legal_names.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace octafront::io {

struct JobPlan;

/// Where a mesh goes: one file, several, or a folder. They get their names when all are complete; whatever fails
/// before, older ones stay as they were. What a writer has to tell the user goes into `notes`.
class MeshOutput {
 public:
  MeshOutput(std::filesystem::path target, RunContext context, WriteOptions options = {},
             std::span<const MeshField> fields = {})
      : target_(std::move(target)), context_(context), options_(std::move(options)), fields_(fields) {}
  ~MeshOutput();
  MeshOutput(const MeshOutput&) = delete;
  MeshOutput& operator=(const MeshOutput&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const RunContext& context() const { return context_; }
  /// Of formats that are binary or text.
  bool as_text() const { return options_.ascii; }
  const WriteOptions& options() const { return options_; }
  /// Fields that go with the mesh, by formats that hold them.
  std::span<const MeshField> fields() const { return fields_; }
  /// The file that was asked for.
  AtomicFile& file();
  /// Another one beside it, with this ending instead.
  AtomicFile& sibling(const std::string& ending);
  /// Another one beside it, of that name.
  AtomicFile& beside(const std::string& name);
  /// A place for a library that writes a file by itself: of the target's name in the end, or of this name beside it.
  std::filesystem::path path_for_library(const std::string& name = {});
  /// A new folder that takes the target's place in the end.
  std::filesystem::path folder() { return folder(target_); }
  /// The same of another name. The folders around it that are not there yet are made in the end, too.
  std::filesystem::path folder(const std::filesystem::path& final);
  /// Where one of many files is written that gets this name beside the target in the end: none of them is kept open.
  std::filesystem::path piece_file(const std::string& name);
  /// The job that the file is; null: it is a mesh alone.
  const JobPlan* job() const { return job_; }
  void set_job(const JobPlan* job) { job_ = job; }
  /// Each text once.
  void note(std::string text) {
    if (!text.empty() && std::find(notes_.begin(), notes_.end(), text) == notes_.end())
      notes_.push_back(std::move(text));
  }

  /// Throws OutputError, "TARGET: " and why, where there are more items than 32 bits count.
  void require_32_bits(std::size_t items, std::string_view why) const;

  /// All files get their names. Throws OutputError.
  void commit();
  std::vector<std::string>& notes() { return notes_; }

 private:
  struct Pending {
    std::filesystem::path temporary, final;
  };

  std::filesystem::path target_;
  RunContext context_;
  WriteOptions options_;
  std::span<const MeshField> fields_;
  std::vector<std::unique_ptr<AtomicFile>> files_;
  std::vector<Pending> pending_;   ///< folders, and files of scratch_
  std::filesystem::path scratch_;  ///< a folder that goes in the end; empty: none
  std::vector<std::string> notes_;
  const JobPlan* job_ = nullptr;
};

}  // namespace octafront::io
