#pragma once

#include "session.h"

namespace octafront::cli {

/// A JSON Schema (draft 2020-12) of what --json writes; among its definitions are the options, by their names in the
/// library and as each command takes them.
Json schema_of(const CLI::App& app);

}  // namespace octafront::cli
