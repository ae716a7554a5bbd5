#pragma once

// Contacts of parts (Domain::contacts): what there are, what is asked of each; those that are split are opened in the
// finished mesh, parts that come apart are meshed one by one.

#include <octafront/generate.h>

#include "base/core/stage.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace octafront {

/// A contact of two regions, the lower one first.
struct PartContact {
  std::string name;  ///< of the patch that the mesh has there
  std::array<std::uint32_t, 2> regions;
  ContactWay way = ContactWay::kShared;
};

/// The contacts of a domain, if anything is asked of them. Throws OptionError, which lists them, for a rule that means
/// none.
std::vector<PartContact> contacts_of(const Domain& domain);

/// Opens those of a finished mesh that are not shared.
void open_contacts(const Domain& domain, TetMesh& mesh, const Stage& stage);

/// Whether parts are meshed one by one.
bool come_apart(const std::vector<PartContact>& contacts);

/// Parts that shared and split contacts hold together are meshed by make(), what lies beyond their separate contacts
/// being outside; the meshes are joined.
using MakePart = std::function<Result(const Domain& part, const Options& options)>;
Result generate_apart(const Domain& domain, const std::vector<PartContact>& contacts, const Options& asked,
                      const RunContext& context, const MakePart& make);

}  // namespace octafront
