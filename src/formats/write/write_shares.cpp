#include <octafront/share_files.h>

#include "base/core/thread_limit.h"
#include "base/shared/packing.h"
#include "formats/containers/atomic_file.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/pieces.h"
#include "formats/write/vtk_pieces.h"
#include "formats/write/writers.h"

#include <optional>
#include <string>
#include <utility>

namespace octafront {

std::vector<std::string> write_shares(const std::string& file, const TetMesh& share, const RunContext& context) {
  const Comm comm(context.ranks);
  const ThreadLimit limit(context.threads);
  const auto together = [&](const auto& work) { comm.together("output", Comm::Telling::kAsIfAlone, work); };
  const bool is_first = comm.rank() == 0;
  const io::MeshParts parts(share);
  // The first rank makes the folder, and names everything in the end.
  std::optional<io::MeshOutput> out;
  std::vector<char> folder;
  together([&] {
    if (!is_first) return;
    io::check_pvtu_target(file, static_cast<std::uint32_t>(comm.size()));
    out.emplace(file, context);
    const std::string begun = io::begin_pvtu(*out).string();
    folder.assign(begun.begin(), begun.end());
  });
  folder = gathered_lists(comm, folder, "output");  // the others have none
  const io::VtkWhole whole{io::VtkCells::Shown::of(parts), io::VtkCells::names_of(parts),
                           io::counts_of_shares(share, comm)};
  const io::Piece piece =
      comm.attempt("output", Comm::Telling::kNamesRank, [&] { return io::piece_of_share(share, comm); });
  together(
      [&] { io::write_pvtu_piece(std::string(folder.begin(), folder.end()), file, piece, whole, context, false); });
  together([&] {
    if (!is_first) return;
    io::end_pvtu(*out, parts, {}, whole, piece.parts);
    out->note(parts.note_on_names());
    out->commit();
  });
  return out ? std::move(out->notes()) : std::vector<std::string>();
}

}  // namespace octafront
